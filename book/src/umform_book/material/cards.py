"""Each card of the library in one element: pulled at angles to the rolling direction, sheared, cycled."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import umform as uf
from umform.analysis.steps import Move
from umform.materials import Metal
from umform.materials.paths import point_path, tension
from umform.model import Model
from umform.model.terms.control import Prescribed
from umform.plotting import COLOURS
from umform.results.fields import body_fields
from umform.sheet_metals import SheetMetal, cards, get, uniaxial
from umform_book.case import Case
from umform_book.page import Page
from umform_book.variants import Variant

Floats = NDArray[np.float64]

KINDS = ("ANS3DEAS", "BEND8", "MI9K3DEAS", "BEND18")
ANGLES = (0, 15, 30, 45, 60, 75, 90)
#: Length, width and thickness of the element.
LENGTH, WIDTH, THICKNESS = 2.0, 1.0, 0.5
#: Elongation of the pull, shear, and ends of the cycle with the increments to each.
PULL, SHEAR = 0.01, 0.04
CYCLE = ((0.02, 10), (-0.02, 20), (0.02, 20))
#: Measured values hold to so much: a stress, and an r-value over no less than 0.2.
_MEASURED_STRESS, _MEASURED_R = 0.02, 0.18


def bar(kind: str, law: Metal, angle: float = 0.0) -> tuple[Model, Prescribed]:
    """One element that is pulled along x, cut at an angle to the rolling direction, and the control of its end."""
    cell = Variant(kind).cell
    sheet = uf.mesh.strip(LENGTH, WIDTH, THICKNESS, (1, 1), cell=cell)
    turn = math.radians(angle)
    model = Model(sheet, kind, material=law, rolling=(math.cos(turn), -math.sin(turn), 0.0))
    for plane, normal in (("x0", "x"), ("lower", "z")):
        model.symmetry(plane, normal)
    model.fix(np.intersect1d(sheet.nodes("x0"), sheet.nodes("y0")), "y")
    return model, model.prescribe("x1", "x", "end")


def pulled(kind: str, law: Metal, angle: float) -> tuple[float, float]:
    """Stress over that of the hardening curve, and r-value, of the element pulled at an angle."""
    model, end = bar(kind, law, angle)
    uf.solve(model, Move(end, PULL * LENGTH, steps=4), progress=False)
    at = body_fields(model.bodies.only, model.u)
    plastic = at.cell_average(at.history["plastic_strain"])[0]
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    across = s * s * plastic[0] + c * c * plastic[1] - c * s * plastic[3]
    J = float(np.linalg.det(at.F).mean())
    eqps = at.eqps
    assert eqps is not None
    tau = J * float(at.cell_average(at.stress())[0, 0])
    return tau / law.hardening.curve()(float(eqps.mean()))[0], float(across / plastic[2])


def sheared(kind: str, law: Metal) -> float:
    """Largest difference of plastic strains to those of the material point, over the largest, in simple shear."""
    sheet = uf.mesh.strip(LENGTH, WIDTH, THICKNESS, (1, 1), cell=Variant(kind).cell)
    model = Model(sheet, kind, material=law, rolling=(1.0, 0.0, 0.0))
    model.symmetry("lower", "z")
    everywhere = np.arange(len(sheet.points))
    model.fix(everywhere, "y")
    model.fix("y0", "x")
    slides, ends = [model.prescribe("y1", "x", "slide")], [SHEAR * WIDTH]
    middle = np.setdiff1d(everywhere, np.union1d(sheet.nodes("y0"), sheet.nodes("y1")))
    if len(middle):  # of 18 nodes
        slides.append(model.prescribe(middle, "x", "half"))
        ends.append(0.5 * SHEAR * WIDTH)
    uf.solve(model, Move(slides, ends, steps=8), progress=False)
    at = body_fields(model.bodies.only, model.u)
    found = at.history["plastic_strain"].reshape(-1, 6)
    path = np.full((8, 6), np.nan)
    for row, gamma in enumerate(np.linspace(0.0, SHEAR, 9)[1:]):
        F = np.array([[1.0, gamma], [0.0, 1.0]])
        values, vectors = np.linalg.eigh(F.T @ F)
        h = vectors @ np.diag(0.5 * np.log(values)) @ vectors.T
        path[row, [0, 1, 3]] = h[0, 0], h[1, 1], 2.0 * h[0, 1]
        path[row, [4, 5]] = 0.0
    expected = point_path(law, path, np.zeros_like(path)).history["plastic_strain"][-1]
    return float(np.abs(found - expected).max() / np.abs(expected).max())


def cycled(page: Page, kind: str, name: str, law: Metal) -> tuple[Floats, Floats, float]:
    """Strain and stress of the element along its cycle, and the largest difference to the material point."""
    model, end = bar(kind, law)
    steps = [Move(end, to=to * LENGTH, steps=count) for to, count in CYCLE]
    result = page.solve(f"{name}, {kind}, cycle", model, steps)
    stretch = 1.0 + result["end"] / LENGTH
    stress = result["end_force"] / (WIDTH * THICKNESS) * stretch  # Kirchhoff stress, conjugate to ln(stretch)
    strain = np.log(stretch)
    _, expected, _ = tension(law, strain[1:])
    return strain, stress, float(np.abs(stress[1:] - expected).max() / np.abs(expected).max())


def run(page: Page) -> None:
    """Fill the page."""
    names = page.pick(cards(), ("AA6016-T4", "SPCC"))
    kinds = page.pick(KINDS, KINDS[:1])
    for name in page.each(names):
        card = get(name)
        page.heading(name)
        page.text(f"{card.basis}. Source: {card.source}. {card.caveat[0].upper()}{card.caveat[1:]}.")
        law = card.law
        assert isinstance(law, Metal)
        if law.directional:
            _over_the_angle(page, card, law, kinds)
        _shear_and_cycle(page, card, law, kinds)


def _over_the_angle(page: Page, card: SheetMetal, law: Metal, kinds: Sequence[str]) -> None:
    """Stress and r over the angle: measured, the yield function in closed form, one element of each kind."""
    angles = page.pick(ANGLES, (0, 45, 90))
    exact = {angle: uniaxial(law.yield_function, angle) for angle in angles}
    found = {kind: {angle: pulled(kind, law, angle) for angle in angles} for kind in kinds}
    for column, what in enumerate(("yield stress over that of the curve", "r-value")):
        measured = (card.measured.stress, card.measured.r)[column] if card.measured else {}
        rows = [
            (f"{angle}", measured.get(angle), exact[angle][column], *(found[kind][angle][column] for kind in kinds))
            for angle in angles
        ]
        page.table(what, ("angle", "measured", "yield function", *kinds), rows)
    for column, (what, within) in enumerate((("stress", 1e-3), ("r", 5e-3))):
        error = max(
            abs(found[kind][angle][column] - exact[angle][column]) / max(exact[angle][column], 0.2)
            for kind in kinds
            for angle in angles
        )
        page.at_most(f"{card.name}: {what} of one element over the angle, from the yield function", error, within)
        measured = (card.measured.stress, card.measured.r)[column] if card.measured else {}
        seen = [angle for angle in angles if angle in measured]
        if seen and "Hill48" not in card.name:
            limit = (_MEASURED_STRESS, _MEASURED_R)[column]
            first = found[kinds[0]]
            error = max(abs(first[angle][column] - measured[angle]) / max(measured[angle], 0.2) for angle in seen)
            page.at_most(f"{card.name}: {what} of one element over the angle, against measurements", error, limit)
    if page.images is not None:
        page.figure(_key(card.name), _figure(card, law, found[kinds[0]]), f"{card.name}: over the angle, {kinds[0]}")


def _shear_and_cycle(page: Page, card: SheetMetal, law: Metal, kinds: Sequence[str]) -> None:
    shear = {kind: sheared(kind, law) for kind in kinds}
    cycle = {kind: cycled(page, kind, card.name, law) for kind in kinds}
    strain, stress, _ = cycle[kinds[0]]
    ends = np.cumsum([count for _, count in CYCLE])
    page.table(
        "one element cycled along the rolling direction, stress in MPa",
        ("", *(f"at a strain of {strain[end]:.4f}" for end in ends)),
        [(kind, *(float(cycle[kind][1][end]) for end in ends)) for kind in kinds],
    )
    page.at_most(f"{card.name}: plastic strains in simple shear, from the material point", max(shear.values()), 1e-9)
    error = max(found[2] for found in cycle.values())
    page.at_most(f"{card.name}: stress of the cycle, from the material point", error, 1e-8)
    if page.images is not None:
        figure = Figure(figsize=(5.0, 3.2), layout="constrained")
        axes = figure.subplots()
        axes.plot(strain, stress, color=COLOURS[0])
        axes.set(xlabel="logarithmic strain", ylabel="stress, MPa")
        page.figure(f"{_key(card.name)}-cycle", figure, f"{card.name}: cycle along the rolling direction, {kinds[0]}")


def _figure(card: SheetMetal, law: Metal, found: dict[int, tuple[float, float]]) -> Figure:
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    angles = np.linspace(0.0, 90.0, 91)
    values = np.array([uniaxial(law.yield_function, angle) for angle in angles])
    for axes, column in zip(figure.subplots(1, 2), (0, 1), strict=True):
        measured = (card.measured.stress, card.measured.r)[column] if card.measured else {}
        axes.plot(angles, values[:, column], color=COLOURS[0], label="yield function")
        axes.plot(list(found), [pair[column] for pair in found.values()], "s", color=COLOURS[2], label="one element")
        if measured:
            axes.plot(list(measured), list(measured.values()), "o", color=COLOURS[1], label="measured")
        axes.set(xlabel="angle to the rolling direction, degrees", xticks=range(0, 91, 15))
        axes.set(ylabel="stress over that of the curve" if column == 0 else "r-value")
        axes.legend()
    return figure


def _key(name: str) -> str:
    return name.lower().replace(" ", "-")


CASE = Case(
    name="material-cards",
    title="Each card of the library in one element",
    problem=f"""
One element of {LENGTH:g} x {WIDTH:g} x {THICKNESS:g} mm of each card of `umform metal list` that has a yield
function or a back stress: pulled by {PULL:g} of its length at angles to the rolling direction, sheared by {SHEAR:g},
and cycled along the rolling direction between elongations of 0.02 and -0.02. Each state is homogeneous.
""",
    reference="""
Stress and r-value: the yield function of the card in closed form, and the measurements of its source. Shear and cycle:
the material point on the same strain path. Pulled at an angle, the element shears and turns slightly, which the closed
form neglects.
""",
    own="the material point is umform's own",
    run=run,
    cost=15.0,
)
