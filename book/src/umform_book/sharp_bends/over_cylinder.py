"""The paper's strip over its cylinder in plane strain, with and without hardening."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.sharp_bends import calculix
from umform_book.sharp_bends.candidates import BEND8, BEND18, of_order, stack
from umform_book.sharp_bends.strips import Bend, Strip, bend

MARKS = (2.0, 5.0, 10.0, 15.0)
HARDENING = (500.0, 0.0)
PAPER = Strip("cylinder", 60.0, 15.0, 500.0, steps=60)
MESHES = {8: (24, 48, 96), 18: (12, 24, 48)}
ORDER_3 = of_order("ANS3DEAS", 3)
#: Elements that are judged, and the mesh that is too coarse for it.
JUDGED = {ORDER_3.label: 24, "BEND8": 24, "BEND18": 12}
#: Run on all meshes, with and without hardening.
CANDIDATES = (of_order("ANS3DEAS", 1), ORDER_3, BEND8, BEND18)
#: Run with hardening on the mesh in the middle: more orders, and two layers.
ONCE = (of_order("ANS3DEAS", 2), *(of_order("MI9K3DEAS", p) for p in (1, 2, 3)))
TWO_LAYERS = (stack("EAS3DEAS", 2, 1), stack("EAS3DEAS", 2, 2))
#: The continuum of our own: elements along the strip, and layers.
STACK = stack("EAS3DEAS", 4, 2)
STACK_CELLS = (48, 96)
#: Deviation from CalculiX that is allowed.
WITHIN = 0.03

Runs = dict[tuple[str, int], Bend]


def _paper(page: Page, hardening: float) -> tuple[Runs, dict[int, Bend]]:
    strip = replace(PAPER, hardening=hardening)
    runs: Runs = {}
    chosen = [(c, n) for c in CANDIDATES for n in MESHES[c.nodes]]
    if hardening:
        chosen += [(c, MESHES[c.nodes][1]) for c in ONCE] + [(c, STACK_CELLS[1]) for c in TWO_LAYERS]
    short = [(BEND8, MESHES[8][1])]
    for candidate, cells in page.each(page.pick(chosen, short), lambda c: f"H = {hardening:g}, {c[0].label}"):
        runs[candidate.label, cells] = bend(page, strip, candidate, cells, frames=2)
    along = page.pick(STACK_CELLS if hardening else (), STACK_CELLS[:1])
    return runs, {n: bend(page, strip, STACK, n) for n in page.each(along, lambda n: f"stack, {n} along")}


def _table(page: Page, hardening: float, runs: Runs, stacks: Mapping[int, Bend]) -> None:
    rows: list[tuple[str | float | None, ...]] = []
    for mesh in calculix.STORED:
        if mesh.over == "cylinder" and mesh.hardening == hardening and not mesh.friction:
            u, force, origin = calculix.forces(mesh)
            label = f"CalculiX, {mesh.layers} layers ({origin})"
            rows.append((label, None, *(float(np.interp(mark, u, force)) for mark in MARKS), None))
    rows += [(STACK.label, n, *map(found.at, MARKS), found.radius) for n, found in stacks.items()]
    rows += [(label, n, *map(found.at, MARKS), found.radius) for (label, n), found in runs.items()]
    columns = ("run", "elements", *(f"F({u:g})" for u in MARKS), "least R/h at the end")
    page.table(f"Force in N on a width of 10 mm, H = {hardening:g} MPa", columns, rows)


def _check_paper(page: Page, runs: Runs, stacks: Mapping[int, Bend]) -> None:
    """With hardening: the elements for bends on every mesh but the coarsest, and the stack, against CalculiX."""
    mesh = next(m for m in calculix.STORED if m.over == "cylinder" and m.layers == 6)
    displacement, force, _ = calculix.forces(mesh)
    reference = {u: float(np.interp(u, displacement, force)) for u in MARKS}
    for (label, cells), found in runs.items():
        if label not in JUDGED or cells == JUDGED[label]:
            continue
        for u in MARKS:
            page.check(f"{label}, {cells} elements, H = 500: F({u:g})", found.at(u), reference[u], WITHIN)
    finest = list(stacks.values())[-1]
    for u in MARKS:
        page.check(f"{STACK.label}, H = 500: F({u:g})", finest.at(u), reference[u], 0.02)
        if len(stacks) > 1:
            what = f"{STACK.label}, H = 500: F({u:g}) with {STACK_CELLS[0]} against {STACK_CELLS[1]} elements"
            page.check(what, stacks[STACK_CELLS[0]].at(u), finest.at(u), 0.02)


def _without_hardening(page: Page, runs: Runs) -> None:
    """Differences between meshes of one element: no check, since the problem has no solution."""
    u = MARKS[2]
    said = []
    sharp = {label: found.radius for (label, _), found in runs.items()}
    for label in dict.fromkeys(name for name, _ in runs):
        row = [found.at(u) for (name, _), found in runs.items() if name == label]
        said.append(f"{label} {', '.join(f'{force:.1f}' for force in row)}")
    page.text(
        f"Without hardening F({u:g}) on the three meshes, coarse to fine: {'; '.join(said)} N. A hinge without "
        "hardening contracts to a length set by the mesh: there is no limit to converge to, and no check. Order 3 "
        "with E_33 tied is within 3 % of a given continuum mesh only with hardening. On the finest mesh the hinge "
        f"ends at R/h = {sharp[ORDER_3.label]:.2g} with order 3 and at {sharp['BEND8']:.2g} with BEND8: probably one "
        "long element is the hinge on a coarse mesh, and on a fine one the hinge is too sharp for order 3."
    )


def _plot_paper(page: Page, hardening: float, runs: Runs, stacks: Mapping[int, Bend]) -> None:
    finest = {label: found for (label, _), found in runs.items()}
    curves = [Curve(k, found.u, found.force, "--" if "18" in k else "-") for k, found in finest.items()]
    curves += [Curve(f"stack of 4, {n} along", found.u, found.force, "k--") for n, found in stacks.items()]
    figure = plot(curves, "displacement u, mm", "force F, N", limits=(15.0, 45.0))
    page.figure(f"H{hardening:g}", figure, f"The paper's strip in plane strain, H = {hardening:g} MPa")
    u = MARKS[-1]
    lines = []
    for label in dict.fromkeys(name for name, _ in runs):
        mine = {cells: found for (name, cells), found in runs.items() if name == label}
        style = "o--" if "18" in label else "o-"
        lines.append(Curve(label, [60.0 / n for n in mine], [found.at(u) for found in mine.values()], style))
    figure = plot(lines, "length of an element / h", f"F({u:g}), N")
    page.figure(f"meshes-H{hardening:g}", figure, f"F({u:g}) over the length of the elements, H = {hardening:g} MPa")


def run(page: Page) -> None:
    """Fill the page."""
    for hardening in page.pick(HARDENING, HARDENING[:1]):
        page.heading(f"The paper's strip, H = {hardening:g} MPa")
        runs, stacks = _paper(page, hardening)
        _table(page, hardening, runs, stacks)
        if hardening:
            _check_paper(page, runs, stacks)
        else:
            _without_hardening(page, runs)
        if page.images is not None:
            _plot_paper(page, hardening, runs, stacks)


CASE = Case(
    name="bend-over-cylinder",
    title="The paper's strip over its cylinder, in plane strain",
    problem="""
The strip of the [paper](bending-reproduction.md) in plane strain, h = 1 mm, kappa = 175000, mu = 80770, y0 = 160,
linear hardening H = 500 and 0; forces on a width of 10 mm. Half length 60 mm, cylinder of R = 20 mm at x = 25 mm, lower
edge of x = 0 pushed down by 15 mm; penalty 100 N/mm^3, 2 x 2 contact points (18 nodes: 3 x 3). Order 1 as in the
literature, higher orders with E_33 tied; 12 points of the split rule.

![The strip over its cylinder, from the page of the paper's example](images/bending-reproduction-shape.png)
""",
    reference="""
CalculiX 2.20, C3D20R, surface contact, six layers, 1/6 mm in the hinge, the same penalty; four layers are 1.3 % away.
Two steps, the first of 0.01 mm, because in its first step CalculiX removes a penetration gradually. Also an own stack
of four layers of EAS3DEAS of order 2.
""",
    own="beside CalculiX, four layers of EAS3DEAS of order 2, umform itself",
    run=run,
    cost=75.0,
)
