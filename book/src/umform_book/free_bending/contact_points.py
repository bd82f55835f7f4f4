"""Jumps and roughness of the curve against number of contact points, mesh and penalty; and how many points to take."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from umform.processes import FreeBending
from umform.processes.bending.spec import RECONSTRUCTION, ContactRule
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.free_bending.runs import (
    LEVER,
    MESHES,
    Discretisation,
    Smoothness,
    bend,
    contact_length,
    smoothness,
)
from umform_book.page import Page

Found = dict[tuple[Discretisation, ContactRule, float], Smoothness]

PAPER, STIFF = 100.0, 1e5
ALL_RULES: tuple[ContactRule, ...] = ("nodes", *range(1, 11))
#: Line force of these runs beyond u = 2, N/mm, for estimates.
LINE_FORCE = 2.8
FEW_RULES: tuple[ContactRule, ...] = ("nodes", 2, 3, 5, 10)
_SHORT_RULES: tuple[ContactRule, ...] = ("nodes", 2, 5, 10)


def sweep(page: Page) -> Found:
    """All rules with the penalty of the paper, some with others."""
    coarse = MESHES[0]
    wanted: list[tuple[Discretisation, ContactRule, float]]
    if page.short:
        wanted = [*((coarse, points, PAPER) for points in _SHORT_RULES), (coarse, 2, STIFF)]
    else:
        wanted = [(mesh, points, PAPER) for mesh in MESHES for points in ALL_RULES]
        wanted += [(mesh, points, STIFF) for mesh in MESHES[:3] for points in FEW_RULES]
        wanted += [(MESHES[3], points, STIFF) for points in FEW_RULES if points != 2]
        wanted += [(coarse, points, penalty) for penalty in (10.0, 1e3, 1e4) for points in FEW_RULES]
    runs = page.each(wanted, lambda item: f"{item[0].label}, {item[1]}, penalty {item[2]:g}")
    return {(mesh, points, penalty): smoothness(page, mesh, points, penalty) for mesh, points, penalty in runs}


def smooth_jump(found: Iterable[Smoothness], mesh: Discretisation) -> float:
    """J from the slope of the curve alone: the least of all runs on a mesh."""
    return min(run.jump for run in found if run.mesh is mesh)


def tables(page: Page, found: Found) -> None:
    """J and roughness, one row per mesh and penalty."""
    rules = [points for points in ALL_RULES if any(key[1] == points for key in found)]
    for what, name in (("J", "jump"), ("roughness", "roughness")):
        rows: list[tuple[str | float | None, ...]] = []
        for mesh in MESHES:
            for penalty in sorted({key[2] for key in found if key[0] is mesh}):
                row = [found.get((mesh, points, penalty)) for points in rules]
                cells = [100 * float(getattr(run, name)) if run else None for run in row]
                rows.append((f"{mesh.label}, penalty {penalty:g}", *cells))
        page.table(f"{what} in %", ("mesh, penalty", *(str(points) for points in rules)), rows)


def check_contact_length(page: Page, found: Found) -> None:
    """Length of the contact against eq. (4.15), and its cube root of the penalty."""
    rows = []
    lengths: dict[float, float] = {}
    for (mesh, points, penalty), run in found.items():
        if points == 10 and run.lines >= 3:
            beyond = run.u > 2.0
            force = float(run.F[beyond].mean()) / FreeBending().width
            length, estimate = run.lines * run.spacing, contact_length(penalty, force)
            rows.append((f"{mesh.label}, penalty {penalty:g}", run.lines, length, estimate))
            # the strip is curved beside the tool, the force not vertical; a point more or less at both ends
            page.check(f"{mesh.label}, penalty {penalty:g}: length of the contact, mm", length, estimate, 0.2)
            if mesh is MESHES[0]:
                lengths[penalty] = length
    page.table("Contact with 10 x 10 points", ("mesh, penalty", "lines", "length mm", "eq. (4.15) mm"), rows)
    if {PAPER, 1e3} <= set(lengths):
        what = "length of the contact, penalty 100 over penalty 1000"
        page.check(what, lengths[PAPER] / lengths[1e3], 10 ** (1 / 3), 0.05)


def check_stairs(page: Page, found: Found) -> None:
    """While the contact is shorter than the distance of the points, the jumps are that distance over the lever arm."""
    for (mesh, _, penalty), run in found.items():
        if penalty < STIFF or run.spacing < 2 * contact_length(penalty, LINE_FORCE):
            continue
        what = f"{mesh.label}, {run.rule}, penalty {penalty:g}: J above the smooth curve against spacing / arm"
        # The arm shrinks from 25 mm by several mm while the contact wanders, J is the largest of all jumps, and the
        # next line of points lies nearer or farther than the mean: Gauss points are not equidistant.
        page.check(what, run.jump - smooth_jump(found.values(), mesh), run.spacing / LEVER, 0.35)


def check_order(page: Page, found: Found) -> None:
    """Check the order of the rules: nodes against points, two against three, a stiff penalty against a soft one."""
    for mesh in MESHES:
        if (mesh, "nodes", PAPER) not in found:
            continue
        nodes, five, ten = (found[mesh, points, PAPER].roughness for points in ("nodes", 5, 10))
        # spacing of nodes over that of 5 points, 5 or 2.5; the polygon of the mesh stays
        page.at_most(f"{mesh.label}: roughness of 5 x 5 points over that of nodes", five / nodes, 0.6)
        page.at_most(f"{mesh.label}: roughness of 10 x 10 points over that of 5 x 5", ten / five, 1.0)
    coarse = MESHES[0]
    soft, stiff = found[coarse, 2, PAPER], found[coarse, 2, STIFF]
    page.at_most("ANS3DEAS 24x1, 2 x 2: J of penalty 100 over that of 1e5", soft.jump / stiff.jump, 0.5)


def figures(page: Page, found: Found) -> None:
    """J over the number of points; all jumps over the lines of points in the contact."""
    curves = []
    for mesh in MESHES:
        for penalty, style in ((PAPER, "o-"), (STIFF, "s--")):
            runs = [run for key, run in found.items() if key[0] is mesh and key[1] != "nodes" and key[2] == penalty]
            label = f"{mesh.label}, penalty {penalty:g}"
            curves.append(Curve(label, [run.points for run in runs], [100 * run.jump for run in runs], style))
    figure = plot(curves, "contact points per direction", "J, %", log="y")
    page.figure("jump", figure, "Jumps against the number of contact points")
    collapsed = []
    for mesh in MESHES:
        least = smooth_jump(found.values(), mesh)
        runs = [run for key, run in found.items() if key[0] is mesh and key[1] != "nodes"]
        x = [contact_length(run.penalty, float(run.F[run.u > 2].mean()) / 10) / run.spacing for run in runs]
        y = [(run.jump - least) * LEVER / run.spacing for run in runs]
        collapsed.append(Curve(mesh.label, x, y, "o"))
    axes = ("length of the contact over distance of the points", "J above the smooth curve over distance / arm")
    figure = plot(collapsed, *axes, log="x", level=1.0)
    page.figure("collapse", figure, "All meshes, rules and penalties: the jump in units of distance over arm")
    nodes = [Curve(f"{m.label}, nodes", found[m, "nodes", PAPER].u, found[m, "nodes", PAPER].F) for m in MESHES]
    points = [Curve(f"{m.label}, 10 x 10", found[m, 10, PAPER].u, found[m, 10, PAPER].F, ":") for m in MESHES]
    page.figure("curves", plot(nodes + points, "displacement u, mm", "force F, N"), "Nodes against 10 x 10 points")


def advice(page: Page, found: Found) -> None:
    """How many points to take, from the numbers of this run."""
    units: dict[str, list[float]] = {"short": [], "two": [], "five": []}
    for run in found.values():
        if run.points == "nodes":
            continue
        over = contact_length(run.penalty, float(run.F[run.u > 2].mean()) / FreeBending().width) / run.spacing
        unit = (run.jump - smooth_jump(found.values(), run.mesh)) * LEVER / run.spacing
        if over <= 0.8:
            units["short"].append(unit)
        elif 1.7 <= over < 4:
            units["two"].append(unit)
        elif over >= 4:
            units["five"].append(unit)
    middle = {key: float(np.median(values)) for key, values in units.items() if values}
    if len(middle) < 3:
        return
    length = contact_length(PAPER, LINE_FORCE)
    factor = (STIFF / PAPER) ** (1 / 3)
    wanted = ", ".join(f"{max(m.least, int(np.ceil(2 * m.size / length)))} for {m.label}" for m in MESHES)
    page.heading("How many points")
    short, two, five = (f"{middle[key]:.2f} L/(n a)" for key in ("short", "two", "five"))
    page.text(
        "Let c = 2 (3 R Q / (2 penalty))^(1/3) be the length of the contact, eq. (4.15), L the element, n the points "
        f"per direction. With less than one point in the contact, n < L/c, the force jumps by {short} above the smooth "
        f"curve (median of these runs); with two to four, by {two}; with four or more, by {five}: the polygon of the "
        "mesh. **Take n = 2 L/c, at least 2 on 4-node and 3 on 9-node faces; more than n = 4 L/c gains nothing.** Here "
        f"c = {length:.1f} mm at a penalty of {PAPER:g}, and n = {wanted}. A penalty {STIFF / PAPER:g} times as stiff "
        f"shortens c by {factor:.0f} and needs {factor:.0f} times the points: reduce the penalty or refine the mesh "
        "before you take more than ten points."
    )


def run(page: Page) -> None:
    """Fill the page."""
    page.text(RECONSTRUCTION)
    found = sweep(page)
    tables(page, found)
    check_contact_length(page, found)
    check_stairs(page, found)
    check_order(page, found)
    if page.short:
        return
    figures(page, found)
    advice(page, found)
    if page.images is not None:
        case = FreeBending(contact="nodes", steps=150, unload=False)
        bending = bend(page, case)
        assert bending.shape is not None
        caption = f"{case.name} at the end of the stroke: a few lines of nodes carry the strip"
        page.shape("shape", bending.shape, caption, values="contact_pressure", view=(-82.0, -20.0))


CASE = Case(
    name="bending-contact-points",
    title="Free bending of the paper: how many contact points",
    problem="""
The example of the [reproduction](bending-reproduction.md) on its four meshes, 150 increments, no release. Contact at
nodes and at 1 x 1 ... 10 x 10 points; penalty 100 N/mm^3 as in the paper, 1e5, and on the coarse mesh 10, 1e3, 1e4.
Measured beyond u = 2 mm: J, the largest change of the force within 0.1 mm over the force (it includes the slope of the
curve); root mean square deviation from a polynomial of degree 4; mean number of lines of points in contact.
""",
    reference="""
Theory 4.5: jumps of the distance of the points over the lever arm, eq. (4.13), while the contact is shorter than this
distance; length of the contact 2 (3 R Q / (2 penalty))^(1/3), eq. (4.15). Both are estimates: the arm changes from 25
mm (20 mm is taken), Gauss points are not equidistant, the strip is not straight. Uncertainty: 35 % for jumps, 20 % for
lengths.
""",
    run=run,
    picture="curves",
    cost=170.0,
)
