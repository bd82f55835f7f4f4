"""A thick-walled tube under inner pressure, from the first flow to its limit: solid-shells stacked along the radius."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.materials import J2, Perfect
from umform.model import Model
from umform.model.terms.control import Prescribed
from umform_book.case import Case
from umform_book.convergence import show, study
from umform_book.page import Page
from umform_book.plastic.curves import lines_figure
from umform_book.plastic.tube_reference import (
    Tube,
    expanded_tube,
    hill_expansion,
    hill_pressure,
    yield_difference,
)
from umform_book.variants import VARIANTS, Variant, with_tying

Floats = NDArray[np.float64]

INNER, OUTER, WIDTH = 1.0, 2.0, 0.5
LAW = J2(E=1e5, nu=0.3, hardening=Perfect(1.0))
EXPANSION = 8e-5  # of the inner face; the tube is plastic throughout at about 5e-5
STEPS = 20
LIMIT = yield_difference(LAW) * float(np.log(OUTER / INNER))
JUDGED = tuple(with_tying(name) for name in ("ANS3DEAS", "EAS3DEAS", "MI9K3DEAS"))


def quarter(variant: Variant, divisions: int) -> Model:
    """A quarter of the tube, so many intervals along the arc and as many layers; x0 at x = 0, x1 at z = 0."""

    def onto_tube(X: Floats) -> Floats:
        angle, r = 0.5 * np.pi * X[:, 0], INNER + X[:, 2]
        return np.column_stack([r * np.sin(angle), X[:, 1], r * np.cos(angle)])

    flat = mesh.grid(
        np.linspace(0.0, 1.0, variant.cells(divisions) + 1),
        [0.0, WIDTH],
        np.linspace(0.0, OUTER - INNER, divisions + 1),
        variant.cell,
    )
    model = Model(flat.transformed(onto_tube), variant.element, material=LAW, thickness_points=2)
    model.fix(np.arange(len(flat.points)), "y")
    model.symmetry("x0", "x")
    model.symmetry("x1", "z")
    return model


@dataclass(frozen=True)
class Expanded:
    """Results of a run: arrays over the increments."""

    inner_displacement: Floats
    pressure: Floats
    plastic_radius: Floats
    outer_displacement: float
    result: Result


def expand(page: Page, variant: Variant, divisions: int) -> Expanded:
    """Move the inner face outward; the pressure is the radial resultant over the true arc."""
    model = quarter(variant, divisions)
    X = model.mesh.points
    controls: list[Prescribed] = []
    cosines: list[float] = []
    stations: dict[float, list[int]] = {}
    for node in model.mesh.nodes("lower"):
        stations.setdefault(round(float(np.arctan2(X[node, 0], X[node, 2])), 9), []).append(int(node))
    for number, (angle, nodes) in enumerate(stations.items()):
        for direction, cosine in (("x", np.sin(angle)), ("z", np.cos(angle))):
            if cosine > 1e-9:
                controls.append(model.prescribe(np.array(nodes), direction, f"{direction}{number}"))
                cosines.append(float(cosine))
    move = Move(controls, [EXPANSION * cosine for cosine in cosines], steps=STEPS)
    result = page.solve(f"{variant.label}, {divisions} layers", model, move, frames=STEPS)
    forces = sum(c * result[f"{control.name}_force"] for control, c in zip(controls, cosines, strict=True))
    u = model.u.reshape(-1, 3)[model.mesh.nodes("upper")]
    return Expanded(
        EXPANSION * result["time"],
        np.asarray(forces) / (0.5 * np.pi * INNER * WIDTH),
        _plastic_radii(result),
        float(np.hypot(u[:, 0], u[:, 2]).mean()),
        result,
    )


def _plastic_radii(result: Result) -> Floats:
    """Outer radius of the outermost layer in which a point flows, of each frame."""
    cells = result.model.mesh.points[result.model.mesh.connectivity]
    outside = np.hypot(cells[..., 0], cells[..., 2]).max(axis=1)
    flowing = [frame.cells["plastic_strain_max"] > 0.0 for frame in result.frames]
    return np.array([outside[hit].max(initial=INNER) for hit in flowing])


def run(page: Page) -> None:
    """Fill the page."""
    reference = expanded_tube(LAW, INNER, OUTER, np.linspace(0.0, EXPANSION, 161))
    _references(page, reference)
    variants = page.pick(VARIANTS, (Variant("DISP3D"), *JUDGED))
    runs: dict[tuple[Variant, int], Expanded] = {}

    def limit(variant: Variant, divisions: int) -> float:
        runs[variant, divisions] = found = expand(page, variant, divisions)
        return float(found.pressure[-1] / LIMIT)

    found = study(page, variants, page.pick((2, 4, 8, 16), (4, 8)), limit)
    mesh_label = "layers, and intervals along the quarter"
    show(page, "limit", "pressure of the plastic tube over its limit", found, mesh=mesh_label)
    half = {v: {n: _pressure_at_mid_radius(runs[v, n], reference) for n in row} for v, row in found.items()}
    show(page, "half", "pressure over the reference, plastic radius 1.5", half, mesh=mesh_label)
    finest = max(found[variants[0]])
    error = 0.01 * (8.0 / finest) ** 2
    for variant in JUDGED:
        what = f"{variant.label}, {finest} layers"
        page.check(f"limit pressure, {what}", runs[variant, finest].pressure[-1], LIMIT, within=error)
        page.check(f"pressure at the plastic radius 1.5, {what}", half[variant][finest], 1.0, within=error)
        ratio = runs[variant, finest].outer_displacement / reference.outer_displacement[-1]
        page.check(f"displacement of the outer face at the end, {what}", ratio, 1.0, within=2.0 * error)
        page.at_most(f"plastic radius, {what}", _radius_error(runs[variant, finest], reference), 1.01 / finest)
    coarsest = min(found[variants[0]])
    errors = ", ".join(f"{v.label} {100 * (found[v][coarsest] - 1):+.1f} %" for v in (Variant("DISP3D"), *JUDGED))
    page.text(
        "No element locks here: each layer has its own radial strain, and errors fall with the square of the mesh "
        f"size. With {coarsest} layers the limit pressure is off by {errors}."
    )
    _pictures(page, runs, reference, finest)
    _under_pressure(page, reference, finest)


def _references(page: Page, reference: Tube) -> None:
    rows = []
    for c in (1.0, 1.25, 1.5, 1.75, 2.0):
        at = min(int(np.searchsorted(reference.plastic_radius, c)), len(reference.pressure) - 1)
        radius = np.array(reference.plastic_radius[at])
        found, closed = reference.pressure[at], float(hill_pressure(LAW, INNER, OUTER, radius))
        outside = float(hill_expansion(LAW, OUTER, radius))
        rows.append((f"{radius:.3f}", found, closed, reference.outer_displacement[at], outside))
    page.table(
        "The law along a radius, and Hill's closed form",
        ("plastic radius", "pressure", "pressure, Hill", "displacement of the outer face", "the same, Hill"),
        rows,
    )
    page.check(
        "limit pressure of the reference against 2/sqrt(3) y ln(b/a)", reference.pressure[-1], LIMIT, within=0.001
    )


def _pressure_at_mid_radius(found: Expanded, reference: Tube) -> float:
    """Pressure over that of the reference where the plastic radius of the reference is 1.5."""
    at = int(np.searchsorted(reference.plastic_radius, 1.5))
    u = reference.inner_displacement[at]
    return float(np.interp(u, found.inner_displacement, found.pressure) / reference.pressure[at])


def _radius_error(found: Expanded, reference: Tube) -> float:
    radii = np.interp(found.inner_displacement, reference.inner_displacement, reference.plastic_radius)
    return float(np.abs(found.plastic_radius - radii).max())


def _pictures(page: Page, runs: dict[tuple[Variant, int], Expanded], reference: Tube, finest: int) -> None:
    lines = {
        v.label: (runs[v, finest].plastic_radius[1:], runs[v, finest].pressure[1:])
        for v in (Variant("DISP3D"), *JUDGED)
    }
    c = np.linspace(INNER, OUTER, 100)
    y = "pressure"
    figure = lines_figure(
        "plastic radius (outer border of the layer that flows)",
        {y: lines},
        references={y: {"Hill": (c, hill_pressure(LAW, INNER, OUTER, c))}},
    )
    page.figure("radius", figure, f"Pressure over the plastic radius, {finest} layers")
    caption = f"Plastic strain of the expanded tube, {JUDGED[0].label}, {finest} layers"
    page.shape("shape", runs[JUDGED[0], finest].result, caption, values="plastic_strain_max", view=(-90.0, 0.0))


def _under_pressure(page: Page, reference: Tube, finest: int) -> None:
    """The same tube under a follower pressure up to 0.99 of its limit."""
    model = quarter(JUDGED[0], finest)
    pressure = model.pressure("lower")
    top = 0.99 * LIMIT
    page.solve(f"{JUDGED[0].label}, {finest} layers, pressure", model, Move(pressure, top, steps=12))
    u = model.u.reshape(-1, 3)[model.mesh.nodes("lower")]
    expansion = float(np.hypot(u[:, 0], u[:, 2]).mean())
    implied = float(np.interp(expansion, reference.inner_displacement, reference.pressure))
    page.check("pressure of the reference at the expansion under 0.99 of the limit pressure", implied, top, within=0.01)
    page.text(
        f"Under a follower pressure of 0.99 of the limit the inner face has moved by {expansion:.3g}. Near the limit "
        "this displacement is ill-conditioned, so the check is on the pressure of the reference at it."
    )


CASE = Case(
    name="plastic-tube",
    title="Thick-walled tube under inner pressure",
    problem=f"""
Quarter of a tube, inner radius {INNER:g}, outer radius {OUTER:g}, plane strain, E = {LAW.E:g}, nu = {LAW.nu:g}, perfect
plasticity with yield stress 1. The thickness direction of the elements is the radius; one element along the axis, axial
displacements held. The inner face moves outward by {EXPANSION:g} in {STEPS} increments, far beyond full flow; a second
run applies a follower pressure. Measured: pressure (radial resultant over the arc), plastic radius, displacement of the
outer face. Strains are below 1e-4.
""",
    reference="""
The limit pressure 2/sqrt(3) y ln(b/a) is exact. Hill's closed form over the plastic radius (The Mathematical Theory of
Plasticity, 1950) is exact for nu = 1/2; for nu = 0.3 it is up to 0.5 % off in the pressure and 2.5 % in the
displacement. So elements are compared with the law itself, integrated by 400 linear elements along the radius in numpy
(200 change the limit pressure by 2e-6). Limit: 1 % on 8 layers (a chord over a sixteenth of the circle is 0.6 % shorter
than its arc), falling with the square of the mesh size.
""",
    run=run,
    cost=20.0,
)
