"""The paper's strip over its cylinder with friction, beside a continuum in CalculiX."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.sharp_bends import calculix
from umform_book.sharp_bends.candidates import BEND8
from umform_book.sharp_bends.over_cylinder import MARKS, PAPER, WITHIN
from umform_book.sharp_bends.strips import Bend, bend

COEFFICIENTS, CELLS, LAYERS = (0.1, 0.3), (24, 48, 96), 4
#: The first of the marks is elastic, and friction adds to the forces from the second on.
COMPARED = MARKS[1:]
#: What friction adds, as a part of the force: both codes against each other.
ADDED = 0.005


def continuum(mu: float) -> calculix.Continuum:
    """The mesh of CalculiX."""
    return next(
        mesh
        for mesh in calculix.STORED
        if mesh.over == "cylinder" and mesh.layers == LAYERS and mesh.friction == mu and mesh.hardening
    )


def run(page: Page) -> None:
    """Fill the page."""
    everywhere, curves = (0.0, *COEFFICIENTS), []
    theirs = {mu: calculix.forces(continuum(mu)) for mu in everywhere}
    cells = page.pick(CELLS, (48,))
    runs: dict[tuple[int, float], Bend] = {
        (count, mu): bend(page, replace(PAPER, friction=mu), BEND8, count)
        for count in page.each(cells, lambda count: f"{count} elements")
        for mu in everywhere
    }
    rows: list[tuple[str | float | None, ...]] = []
    for mu in everywhere:
        u, force, origin = theirs[mu]
        forces = [float(np.interp(mark, u, force)) for mark in MARKS]
        rows.append((f"mu = {mu:g}, CalculiX, {LAYERS} layers ({origin})", None, *forces))
        rows += [(f"mu = {mu:g}, BEND8", count, *map(runs[count, mu].at, MARKS)) for count in cells]
        finest = runs[cells[-1], mu]
        curves += [Curve(f"BEND8, mu = {mu:g}", finest.u, finest.force), Curve(f"CalculiX, mu = {mu:g}", u, force, ":")]
    columns = ("run", "elements", *(f"F({u:g})" for u in MARKS))
    page.table("Force in N on a width of 10 mm", columns, rows)
    page.figure("force", plot(curves, "displacement, mm", "force, N"), "Force of the punch, 96 elements and CalculiX")
    u, smooth, _ = theirs[0.0]
    for mu in COEFFICIENTS:
        rough = np.interp(u, *theirs[mu][:2])
        for count in cells[-2:]:
            for mark in COMPARED:
                reference = float(np.interp(mark, u, rough))
                found = runs[count, mu].at(mark)
                page.check(f"mu = {mu:g}, {count} elements: F({mark:g})", found, reference, WITHIN)
                added = found / runs[count, 0.0].at(mark)
                expected = reference / float(np.interp(mark, u, smooth))
                page.check(f"mu = {mu:g}, {count} elements: F({mark:g}) over that without", added, expected, ADDED)


CASE = Case(
    name="friction-beside-calculix",
    title="The paper's strip with friction, beside CalculiX",
    problem=f"""
The strip of the [paper](bending-reproduction.md) over its cylinder in plane strain, as on [the page without
friction](bend-over-cylinder.md), H = 500, mu = 0, 0.1 and 0.3 on the cylinder, allowed elastic slip 0.005. One layer of
BEND8, {", ".join(map(str, CELLS))} elements. Forces on a width of 10 mm.
""",
    reference=f"""
CalculiX 2.20, C3D20R, surface contact, {LAYERS} layers, 1/4 mm in the hinge, the same penalty, also for stick; without
friction these layers are 1.3 % from six. Limits: {100 * WITHIN:g} % of the force, and {100 * ADDED:g} % of its ratio to
the force without friction of the same code, which cancels the error of the mesh.
""",
    run=run,
    cost=30.0,
)
