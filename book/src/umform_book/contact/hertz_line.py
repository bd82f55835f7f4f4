"""Rigid cylinder on an elastic block: half-width and peak pressure of Hertz, over meshes, rules and penalties."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot, rule_name
from umform_book.contact.hertz import Measures, Problem, measure, press, pressed_to
from umform_book.convergence import normalised, show, study
from umform_book.page import Page
from umform_book.variants import GOOD, Variant, with_tying

LINE = Problem("line", radius=200.0, depth=0.0115, end=40.0, growth=1.35, steps=6)
EIGHT, EIGHTEEN = Variant("ANS3DEAS"), Variant("MI9K3DEAS")
ELEMENTS = (Variant("DISP3D"), Variant("DISP9K3D"), *GOOD)

#: Expected of peak pressure and size by elements over the half-width: a hat function of width h averages the ellipse
#: to 1 - (h/a)^2/12 and the edge lies inside of an element; block and penalty add half a per cent.
EXPECTED = {1: 0.15, 2: 0.05, 4: 0.02, 8: 0.01}


def least_rule(variant: Variant) -> int:
    """Contact points that an element needs at least."""
    return 2 if variant.cell == "hex8" else 3


def by_elements(page: Page) -> None:
    """Peak pressure of all elements over the meshes."""
    meshes = page.pick((2, 4, 8), (2, 4))
    measures: dict[tuple[Variant, int], Measures] = {}

    def peak(variant: Variant, divisions: int) -> float:
        found = pressed_to(page, LINE, variant, divisions, least_rule(variant))
        measures[variant, divisions] = found
        return found.peak_nodes

    variants = page.pick(ELEMENTS, (EIGHT, with_tying("ANS3DEAS"), EIGHTEEN))
    found = study(page, variants, meshes, peak)
    show(
        page,
        "elements",
        "peak pressure at the nodes over Hertz",
        normalised(found, 1.0),
        mesh="intervals between nodes over the half-width",
    )
    for (variant, divisions), at in measures.items():
        within = EXPECTED[variant.cells(divisions)]
        if variant in GOOD and within <= 0.05:
            what = f"{variant.label}, {variant.cells(divisions)} elements over the half-width"
            page.check(f"{what}: peak pressure", at.peak_nodes, 1.0, within)
            page.check(f"{what}: half-width by the second moment", at.spread, 1.0, within)
    page.table(
        "Half-width over Hertz",
        ("element", *(f"{n} intervals, 2nd moment" for n in meshes), *(f"{n}, outermost point" for n in meshes)),
        [(v.label, *(measures[v, n].spread for n in meshes), *(measures[v, n].edge for n in meshes)) for v in variants],
    )


def by_rules(page: Page) -> None:
    """All contact rules: pressure at points and at nodes, half-width."""
    meshes = page.pick((2, 4, 8), (4,))
    rules: tuple[int | str, ...] = tuple(page.pick(("nodes", 1, 2, 3, 5, 10), ("nodes", 2, 5)))
    rows: list[tuple[str | float, ...]] = []
    for variant in (EIGHT, EIGHTEEN):
        for points in page.each(rules, rule_name):
            found = [pressed_to(page, LINE, variant, divisions, points) for divisions in meshes]
            numbers = [(m.peak_points, m.peak_nodes, m.spread) for m in found]
            rows.append((f"{variant.label}, {rule_name(points)}", *(n for triple in numbers for n in triple)))
            if points != "nodes" and int(points) < least_rule(variant):
                continue
            last = variant.cells(meshes[-1])
            what = f"{variant.label}, {rule_name(points)}, {last} elements over the half-width: peak pressure at nodes"
            page.check(what, found[-1].peak_nodes, 1.0, EXPECTED[last])
    columns = [f"{n} intervals: {what}" for n in meshes for what in ("peak at points", "at nodes", "half-width")]
    page.table("Contact rules; everything over Hertz", ("element, rule", *columns), rows)
    page.text(
        "The peak at points is the largest penalty times penetration; the peak at nodes is the largest average of "
        "eq. (4.38). On 4-node faces with three or more points the gap between chord and circle varies by h^2/8R, and "
        "the pressure at points by the penalty times this: its largest value has no meaning. The averages are right."
    )


def by_penalty(page: Page) -> None:
    """The peak falls and the contact spreads by E*/(penalty a)."""
    stiffnesses = np.array(page.pick((1, 3, 10, 30, 100, 1000, 10000), (3, 10, 100)), dtype=float)
    divisions = page.pick((8,), (4,))[0]
    rows, curves = [], []
    for points in ("nodes", 2):
        found = [pressed_to(page, LINE, EIGHT, divisions, points, s) for s in stiffnesses]
        rows += [(rule_name(points), float(s), m.peak_nodes, m.spread) for s, m in zip(stiffnesses, found, strict=True)]
        curves += [
            Curve(f"peak, {rule_name(points)}", stiffnesses, [m.peak_nodes for m in found], "o-"),
            Curve(f"half-width, {rule_name(points)}", stiffnesses, [m.spread for m in found], "s--"),
        ]
    page.table(
        f"Penalty: ANS3DEAS, {divisions} elements over the half-width",
        ("rule", "penalty a / E*", "peak at nodes over Hertz", "half-width over Hertz"),
        rows,
    )
    axes = ("penalty times half-width over E*", "over Hertz")
    page.figure("penalty", plot(curves, *axes, log="x", level=1.0), "A soft penalty spreads the contact")


def by_size(page: Page) -> None:
    """Peak pressure while the contact grows over a fixed mesh, and the pressure at the end."""
    steps = 28
    growing = replace(LINE, steps=steps)
    peaks, profiles = [], []
    for variant, points in ((EIGHT, "nodes"), (EIGHT, 1), (EIGHT, 2), (EIGHTEEN, "nodes"), (EIGHTEEN, 3)):
        model, _, result = press(page, growing, variant, 8, points, 100.0, frames=steps)
        label = f"{variant.name}, {rule_name(points)}"
        found = [measure(growing, f.contacts["tool"], f.points["contact_pressure"]) for f in result.frames[2:]]
        peaks.append(Curve(label, [8 * m.size for m in found], [m.peak_nodes for m in found], "-"))
        top, last = model.mesh.nodes("upper"), found[-1]
        x, order = model.mesh.points[top, 0], np.argsort(model.mesh.points[top, 0])
        pressure = result.frames[-1].points["contact_pressure"][top]
        inside = order[x[order] < 1.5 * last.size]
        profiles.append(Curve(label, x[inside] / last.size, pressure[inside] / last.peak, "o-"))
        many = [abs(m.peak_nodes - 1) for m in found if 8 * m.size >= 2.0 * (1 if variant is EIGHT else 2)]
        page.at_most(f"{label}: peak over Hertz - 1, any contact of 2 elements or more over a", max(many), 0.05)
    ellipse = np.linspace(0.0, 1.0, 101)
    profiles.append(Curve("Hertz", ellipse, np.sqrt(1 - ellipse**2), "k-"))
    page.figure(
        "size",
        plot(
            peaks, "intervals between nodes over the half-width", "peak at nodes over Hertz", level=1, limits=(0.7, 1.3)
        ),
        "Peak pressure while the contact grows over the mesh",
    )
    page.figure("pressure", plot(profiles, "x over half-width", "pressure at nodes over peak"), "Pressure, 8 intervals")


def by_block(page: Page) -> None:
    """Larger blocks: the error of a finite one."""
    ends = page.pick((20.0, 40.0, 80.0), (20.0, 40.0))
    # The depth for a contact of the same size grows with the logarithm of the block: a^2/(2 R) ln 2 for a doubling.
    depths = [LINE.depth + np.log(end / LINE.end) / (2 * LINE.radius) for end in ends]
    problems = [replace(LINE, end=end, depth=depth) for end, depth in zip(ends, depths, strict=True)]
    found = [pressed_to(page, problem, EIGHT, 4, 2) for problem in problems]
    page.table(
        "Size of the block: ANS3DEAS, 4 elements over the half-width",
        ("half-width and depth of the block", "half-width of the contact", "peak over Hertz", "half-width over Hertz"),
        [(end, m.size, m.peak_nodes, m.spread) for end, m in zip(ends, found, strict=True)],
    )
    change = abs(found[-1].peak_nodes / found[-2].peak_nodes - 1)
    page.at_most("change of the peak from a block of half the size", change, 0.002)


def run(page: Page) -> None:
    """Fill the page."""
    by_elements(page)
    by_rules(page)
    by_penalty(page)
    if not page.short:
        by_size(page)
    by_block(page)
    if page.images is not None:
        model, *_ = press(page, LINE, EIGHT, 4, 2, 100.0)
        shape = Shape.displaced(model.mesh, 100.0 * model.u.reshape(-1, 3))
        page.shape("shape", shape, "Half of the block, displacements 100 times enlarged", view=(-90.0, 0.0))


CASE = Case(
    name="contact-hertz-line",
    title="Hertz: cylinder on a block",
    problem="""
Half of a block, 40 wide and 40 deep, plane strain (width 1), E = 1000, nu = 0.3, base held in z, x = 0 a symmetry
plane. A rigid cylinder of R = 200 is pressed in by 0.0115: half-width a of the contact about 1, strains below 0.3 %.
Elements are stacked through the depth, of equal size around the contact (2, 4 or 8 intervals over the half-width),
growing by 1.35 away from it. Penalty 100 E*/a unless the table says otherwise. Measured for the force P on the tool:
peak pressure; half-width from the second moment of the pressure (a^2/4 in the closed form); outermost point in contact.
""",
    reference="""
Hertz, after Johnson (1985): a = sqrt(4 P R / (pi E*)), p0 = 2 P / (pi a), E* = E/(1 - nu^2), rigid cylinder on a
half-space. Compared for the force found, since the approach is not defined in line contact. Uncertainty: the finite
block, below 0.5 % (last table); finite strains and circle for parabola, below 0.3 %; the penalty, 1 % of the stiffness
of the block over a length a.
""",
    run=run,
    picture="pressure",
    cost=35.0,
)
