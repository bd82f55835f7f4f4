"""Rigid sphere on an elastic block: force, radius and peak pressure of Hertz."""

from __future__ import annotations

from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot, rule_name
from umform_book.contact.hertz import Measures, Problem, press, pressed_to
from umform_book.contact.hertz_line import EIGHT, EIGHTEEN, EXPECTED, least_rule
from umform_book.convergence import show, study
from umform_book.page import Page
from umform_book.variants import Variant, with_tying

POINT = Problem("point", radius=100.0, depth=0.0105, end=12.0, growth=1.6, steps=3)
ELEMENTS = (EIGHT, with_tying("ANS3DEAS"), Variant("EAS3DEAS"), EIGHTEEN, with_tying("MI9K3DEAS"))


def expected(elements: float) -> float:
    """Limits of peak and radius: those of a line contact, in two directions."""
    return 2 * EXPECTED[max(n for n in EXPECTED if n <= elements)]


def by_elements(page: Page) -> None:
    """Peak pressure and radius over the meshes."""
    meshes = page.pick((2, 4, 6), (2, 4))
    measures: dict[tuple[Variant, int], Measures] = {}

    def peak(variant: Variant, divisions: int) -> float | None:
        if divisions == 6 and variant.options:
            return None
        found = pressed_to(page, POINT, variant, divisions, least_rule(variant))
        measures[variant, divisions] = found
        return found.peak_nodes

    found = study(page, page.pick(ELEMENTS, (EIGHT,)), meshes, peak)
    title, mesh = "peak pressure at the nodes over Hertz", "intervals between nodes over the radius"
    show(page, "elements", title, found, mesh=mesh)
    rows = []
    for (variant, divisions), at in measures.items():
        elements = variant.cells(divisions)
        rows.append((variant.label, divisions, at.force, at.size, at.peak, at.peak_points, at.peak_nodes, at.spread))
        if elements >= 2:
            what = f"{variant.label}, {elements} elements over the radius"
            page.check(f"{what}: peak pressure", at.peak_nodes, 1.0, expected(elements))
            page.check(f"{what}: radius by the second moment", at.spread, 1.0, expected(elements))
    columns = ("element", "intervals", "force", "radius", "peak", "peak at points over Hertz", "at nodes", "radius")
    page.table("2 x 2 (3 x 3) contact points; radius and peak are Hertz's for the force", columns, rows)


def by_rules(page: Page) -> None:
    """Contact rules on the middle mesh."""
    rules: tuple[int | str, ...] = ("nodes", 1, 2, 3, 5)
    rows, curves = [], []
    for variant in (EIGHT, EIGHTEEN):
        found = [pressed_to(page, POINT, variant, 4, points) for points in page.each(rules, rule_name)]
        rows += [
            (f"{variant.label}, {rule_name(points)}", m.peak_points, m.peak_nodes, m.spread)
            for points, m in zip(rules, found, strict=True)
        ]
        names = [rule_name(points) for points in rules]
        curves += [
            Curve(f"{variant.name}, at points", names, [m.peak_points for m in found], "o--"),
            Curve(f"{variant.name}, at nodes", names, [m.peak_nodes for m in found], "s-"),
        ]
    page.table("Contact rules, 4 intervals; over Hertz", ("rule", "peak at points", "peak at nodes", "radius"), rows)
    figure = plot(curves, "contact rule", "peak pressure over Hertz", level=1.0)
    page.figure("rules", figure, "Peak pressure by contact rule, 4 intervals over the radius")


def run(page: Page) -> None:
    """Fill the page."""
    by_elements(page)
    if not page.short:
        by_rules(page)
    page.text(
        "As in line contact, the averages at the nodes are right with any rule. The pressure at single points of "
        "4-node faces is wrong with three points or more: a face with straight edges cannot follow the sphere."
    )
    if page.images is not None:
        model, *_ = press(page, POINT, EIGHT, 4, 2, 100.0)
        shape = Shape.displaced(model.mesh, 50.0 * model.u.reshape(-1, 3))
        page.shape("shape", shape, "Quarter of the block, displacements 50 times enlarged", view=(30.0, 25.0))


CASE = Case(
    name="contact-hertz-point",
    title="Hertz: sphere on a block",
    problem="""
Quarter of a block, 12 x 12 wide and 12 deep, E = 1000, nu = 0.3, base held in z, two symmetry planes. A rigid sphere of
R = 100 is pressed in by 0.0105: radius a of the contact about 1. Elements are stacked through the depth, of equal size
around the contact (2, 4 or 6 intervals over the radius), growing by 1.6 away from it. Penalty 100 E*/a. Measured for
the force F on the tool: peak pressure; radius from the second moment of the pressure (2 a^2/5 in the closed form).
""",
    reference="""
Hertz, after Johnson (1985): a = (3 F R / (4 E*))^(1/3), p0 = 3 F / (2 pi a^2), E* = E/(1 - nu^2), rigid sphere on a
half-space. Block and penalty: about 1 %.
""",
    run=run,
    cost=30.0,
)
