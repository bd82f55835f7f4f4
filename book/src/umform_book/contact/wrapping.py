"""Sheet wrapped around a cylinder and pulled: the pressure of its tension, T in = T out, the ripple within faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.materials import SVK
from umform.mesh import Mesh
from umform.model import Model
from umform.surfaces import Cylinder
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot, rule_name
from umform_book.contact.hertz_line import EIGHT, EIGHTEEN, least_rule
from umform_book.contact.strip_on_cylinder import RADIUS, THICKNESS, WIDTH, E
from umform_book.convergence import show, study
from umform_book.page import Page
from umform_book.variants import GOOD, Variant

Floats = NDArray[np.float64]

TENSION, SOFT, STIFF = 1.0, 10.0, 100.0
#: Pressure of the tension on the lower face, T / (R b).
PRESSURE = TENSION / (RADIUS * WIDTH)
#: Root mean square of 1 - r^2 - 2/3 on [-1, 1]: how a parabola differs from its mean.
PARABOLA = np.sqrt(4 / 45)


@dataclass(frozen=True)
class Found:
    """Tension held over that pulled with; mean, ripple (root mean square) and extremes of the pressure over T/(R b)."""

    held: float
    turning: float
    mean: float
    ripple: float
    largest: float
    nodes: tuple[float, float]


def half_ring(divisions: int, variant: Variant) -> Mesh:
    """Half of a ring whose lower nodes lie on the cylinder, unstressed."""

    def around(X: Floats) -> Floats:
        angle, r = np.pi * (X[:, 0] - 0.5), RADIUS + 0.5 * THICKNESS + X[:, 2]
        return np.column_stack([r * np.sin(angle), X[:, 1], r * np.cos(angle)])

    flat = mesh.strip(1.0, WIDTH, THICKNESS, (variant.cells(divisions), 1), cell=variant.cell)
    return flat.transformed(around)


def sagitta(divisions: int) -> float:
    """Depth of a chord between neighbouring nodes in the cylinder, L^2 / (8 R)."""
    return float(RADIUS * (np.pi / divisions) ** 2 / 8)


def pull(page: Page, variant: Variant, divisions: int, points: int | str, penalty: float, frames: int = 0) -> Result:
    """Pull at one end and hold the other."""
    model = Model(half_ring(divisions, variant), variant.element, material=SVK(E=E, nu=0.0))
    model.fix(np.arange(len(model.mesh.points)), "y")
    model.prescribe("x0", "z", "hold")
    model.contact("lower", Cylinder((0, 0, 0), "y", RADIUS), penalty=penalty, points=points, name="tool")
    load = model.traction("x1", (0, 0, -1 / (WIDTH * THICKNESS)), "tension")
    label = f"{variant.label}, {divisions} intervals, {rule_name(points)}, penalty {penalty:g}"
    return page.solve(label, model, Move(load, TENSION, steps=5), frames=frames)


def measure(result: Result) -> Found:
    """Tension and pressure at the end, the latter away from the ends of the sheet."""
    model, contact = result.model, result.model.contacts[0]
    at, (nodal, _) = contact.at_points(), contact.at_nodes(model.u, model.mesh)
    count = len(contact.facets)
    angle = np.arctan2(at.x[:, 0], at.x[:, 2])
    middle = np.repeat(np.abs(angle.reshape(count, -1).mean(axis=1)) < 1.0, len(angle) // count)
    pressure, area = at.pressure[middle] / PRESSURE, at.area[middle]
    mean = float(pressure @ area / area.sum())
    x = model.positions
    lower = model.mesh.nodes("lower")
    lower = lower[np.abs(np.arctan2(x[lower, 0], x[lower, 2])) < 1.0]
    return Found(
        held=float(result["hold_force"][-1]) / -TENSION,
        turning=abs(float(contact.resultant()[1][1])) / (TENSION * RADIUS),
        mean=mean,
        ripple=float(np.sqrt((pressure - mean) ** 2 @ area / area.sum())),
        largest=float(pressure.max()),
        nodes=(float(nodal[lower].min() / PRESSURE), float(nodal[lower].max() / PRESSURE)),
    )


def by_elements(page: Page) -> None:
    """All elements over the meshes, stiff penalty."""
    meshes = page.pick((16, 32, 64), (32, 64))
    found: dict[tuple[Variant, int], Found] = {}

    def mean(variant: Variant, divisions: int) -> float:
        found[variant, divisions] = measure(pull(page, variant, divisions, least_rule(variant), SOFT))
        return found[variant, divisions].mean

    variants = page.pick((Variant("DISP3D"), Variant("DISP9K3D"), *GOOD), (EIGHT, EIGHTEEN))
    show(
        page,
        "elements",
        "mean pressure over T/(R b)",
        study(page, variants, meshes, mean),
        mesh="intervals between nodes over half of the ring",
    )
    # A penetration p/penalty makes the arc smaller, and the sheet is stretched: both raise the force per area.
    exact = (1 + PRESSURE / (SOFT * RADIUS)) * (1 + TENSION / (E * THICKNESS * WIDTH))
    for (variant, divisions), f in found.items():
        if variant in GOOD and divisions == max(meshes):
            what = f"{variant.label}, {divisions} intervals"
            page.check(f"{what}: mean pressure over T/(R b)", f.mean, exact, 0.001)
            page.check(f"{what}: tension held over tension pulled", f.held, 1.0, 1e-4)
            page.at_most(f"{what}: moment about the axis over T R", f.turning, 1e-10)


def by_rules(page: Page) -> None:
    """Contact rules: mean, ripple, extremes; two penalties."""
    meshes = page.pick((16, 32, 64, 128), (64,))
    rules: tuple[int | str, ...] = tuple(page.pick(("nodes", 2, 3, 5, 10), ("nodes", 2, 5)))
    rows: list[tuple[str | float | int, ...]] = []
    ripples: dict[tuple[Variant, int | str], tuple[list[float], list[float]]] = {}
    for variant in (EIGHT, EIGHTEEN):
        allowed = [points for points in rules if variant is EIGHT or points != 2]
        for points in page.each(allowed, rule_name):
            label = f"{variant.label}, {rule_name(points)}"
            for divisions in meshes:
                for penalty in (SOFT, STIFF):
                    ratio = penalty * sagitta(divisions) / PRESSURE
                    if ratio > 15:  # so coarse that neighbouring nodes leave the tool
                        continue
                    f = measure(pull(page, variant, divisions, points, penalty))
                    rows.append((label, divisions, penalty, ratio, f.mean, f.ripple, f.largest, *f.nodes))
                    drawn = ripples.setdefault((variant, points), ([], []))
                    drawn[0].append(ratio)
                    drawn[1].append(max(f.ripple, 1e-6))
                    if points not in ("nodes", 2) and variant is EIGHT and ratio < 0.5:
                        what = f"{label}, {divisions} intervals, penalty {penalty:g}: ripple of the pressure"
                        page.check(what, f.ripple, PARABOLA * ratio, 0.03)
                    if penalty == SOFT and divisions == 64:
                        what = f"{label}, {divisions} intervals, penalty {penalty:g}: pressure at nodes, "
                        page.check(what + "smallest over T/(R b)", f.nodes[0], 1.0, 0.005)
                        page.check(what + "largest over T/(R b)", f.nodes[1], 1.0, 0.005)
    columns = (
        "rule",
        "intervals",
        "penalty",
        "chord",
        "mean",
        "ripple",
        "largest at points",
        "smallest at nodes",
        "largest",
    )
    page.table("Pressure over T/(R b); chord: penalty L^2/(8 R) over T/(R b)", columns, rows)
    curves = [
        Curve(f"{variant.name}, {rule_name(points)}", *_sorted(*data), "o-")
        for (variant, points), data in ripples.items()
        if (variant, points) != (EIGHT, "nodes")
    ]
    line = np.array([0.05, 1.5])
    curves.append(Curve("0.298 chord", line, PARABOLA * line, "k:"))
    figure = plot(curves, "chord: penalty L^2/(8 R) over T/(R b)", "ripple of the pressure at points", log="xy")
    page.figure("ripple", figure, "Root mean square of the pressure at points about its mean")


def _sorted(x: list[float], y: list[float]) -> tuple[list[float], list[float]]:
    order = np.argsort(x)
    return [x[k] for k in order], [y[k] for k in order]


def run(page: Page) -> None:
    """Fill the page."""
    by_elements(page)
    by_rules(page)
    page.text(
        "Tension and pressure are right on average for any rule. With three or more points the pressure at the points "
        "of a 4-node face ripples by the parabola between chord and circle: 0.298 penalty L^2/(8 R) in the root mean "
        "square while all points are in contact. Nodes and 2 x 2 points lie at one depth and show no ripple; 9-node "
        "faces ripple far less. Read pressures from the averages at the nodes, smooth with every rule. A penalty much "
        "larger than p 8 R / L^2 resolves chords, not pressure."
    )
    if page.images is not None:
        result = pull(page, EIGHT, 32, 2, SOFT, frames=1)
        page.shape("shape", result, "The half ring under tension", values="contact_pressure", view=(-80.0, 15.0))


CASE = Case(
    name="contact-wrapping",
    title="Sheet wrapped around a cylinder under tension",
    problem=f"""
Half of a ring, unstressed, {THICKNESS:g} thick and {WIDTH:g} wide, lower nodes on a rigid frictionless cylinder of R =
{RADIUS:g}; E = {E:g}, nu = 0, u_y = 0. One end is held along its tangent, T = {TENSION:g} pulls the other. Penalty
{SOFT:g} (penetration R/1000) and {STIFF:g}. Measured within 1 rad of the top: mean pressure, its root mean square
deviation, extremes at points and of the averages at nodes; also the tension at the held end and the moment on the tool.
""",
    reference="""
Closed form: the tension is constant, the pressure on the lower face T/(R b). Penetration and stretching raise it by
p/(penalty R) + T/(E h b), which the checks include. Ripple: between two nodes on the circle the chord lies up to L^2/(8
R) inside the tool; with all points in contact the pressure is penalty times this parabola plus a constant, with root
mean square sqrt(4/45) of its height (exact with three points or more).
""",
    run=run,
    picture="ripple",
    cost=15.0,
)
