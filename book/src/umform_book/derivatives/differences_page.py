"""Page: derivatives by shadows beside whole runs with changed parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import umform as uf
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.derivatives.chains import CHAINS, compared_chain
from umform_book.derivatives.differences import SHADOW, TIGHT, Example, compared
from umform_book.derivatives.laws import LAWS, example
from umform_book.derivatives.sheets import SHEETS
from umform_book.derivatives.steps import BEND, EXAMPLES, bent
from umform_book.page import Page


def _table(page: Page, title: str, what: str, examples: Mapping[str, Example], short: tuple[str, ...]) -> None:
    rows = []
    for name, one in page.each(
        [(name, examples[name]) for name in page.pick(tuple(examples), short)], lambda it: it[0]
    ):
        found = list(compared(one))
        shadow = None if one.ends else max(each.shadow for each in found)
        derivative = max(each.derivative for each in found)
        rows.append((name, ", ".join(one.columns), len(found), shadow, derivative, one.limit))
        page.at_most(f"{name}: derivative", derivative, one.limit)
        if shadow is not None:
            page.at_most(f"{name}: shadow", shadow, SHADOW)
    columns = (what, "columns", "parameters", "shadow", "derivative", "limit")
    page.table(title, columns, rows)


def _chains(page: Page) -> None:
    rows = []
    for name, chain in page.each(
        [(name, CHAINS[name]) for name in page.pick(tuple(CHAINS), ("part of two bends",))], lambda it: it[0]
    ):
        for one in compared_chain(replace(chain, by=tuple(page.pick(chain.by, chain.by[-1:])))):
            rows.append((name, one.parameter, one.derivative, chain.limit))
            page.at_most(f"{name}, {one.parameter}", one.derivative, chain.limit)
    page.table("Operations one after the other", ("case", "parameter", "derivative", "limit"), rows)


def _waves(page: Page) -> None:
    """Central differences of whole runs over the change, with contact cells and with single points."""
    curves = []
    for label, points in (("cells", False), ("Gauss points", True)):
        found = _sizes("R", page.pick((3e-3, 1e-3, 3e-4, 1e-4, 3e-5), (1e-3, 1e-4)), points=points)
        curves.append(Curve(label, [size for size, _ in found], [error for _, error in found], "o-"))
    figure = plot(curves, "change of the radius, relative", "difference from the derivative, relative", log="xy")
    page.figure("waves", figure, "Central differences of whole runs less the derivative, for the radius of a cylinder")


def _sizes(name: str, changes: Sequence[float], *, points: bool) -> list[tuple[float, float]]:
    """Relative differences of central differences from the derivative of the punch force at the end, by the change."""

    def build(**changed: float) -> tuple[uf.Model, Any]:
        return bent(**{**BEND, **changed}, points=float(points))

    value = BEND[name]
    exact = uf.derivatives(build, by={name: value}, of=["punch_force:last"], options=TIGHT, progress=False)
    wanted = exact["punch_force:last", name].value
    assert wanted is not None
    found = []
    for change in changes:
        ends = [
            uf.solve(*build(**{name: value * (1.0 + sign * change)}), options=TIGHT, frames=0, progress=False)
            for sign in (1.0, -1.0)
        ]
        forces = [float(end["punch_force"][-1]) for end in ends]
        found.append((change, abs((forces[0] - forces[1]) / (2.0 * change * value) / wanted - 1.0)))
    return found


def run(page: Page) -> None:
    """Fill the page."""
    _table(page, "Steps, tools, controls and loads", "model", EXAMPLES, ("Close", "Arc"))
    _table(page, "Sheets that touch", "model", SHEETS, ())
    laws = {name: example(law) for name, law in LAWS.items()}
    _table(page, "Laws, with all their constants", "law", laws, ("J2, Linear", "Metal, Mises"))
    _chains(page)
    _waves(page)


CASE = Case(
    name="derivatives-differences",
    title="Derivatives of runs beside whole runs",
    problem="""
* Laws: one element across its rolling direction, pulled into plastic flow, unloaded and pressed; with respect to all
  constants but whole numbers.
* Operations one after the other: angles of the bends of a part and the shape of a hem, each with respect to strokes of
  the bends before, sizes and strength.
* Steps, tools, controls and loads: small models of each kind, with respect to constants of the metal, thickness,
  radii, friction, forces, gaps, springs, stops, beads, strokes and times.
* Sheets that touch: two strips bent on each other, and a strip folded onto itself, at Gauss points and over cells.
""",
    reference="""
Whole runs with a residual of 1e-12. "shadow": the change in the shadow beside that of a whole run with the same change
of the parameter, 3e-5 of its value. "derivative": beside central differences over 1e-4 (1e-3 where the whole run ends
at a force that is hardly defined; 2e-2 for a pressed tool that is released, and for an open hem, whose results have
small jumps). Both are the largest over all parameters, columns and rows, relative to the largest derivative of the
column. The derivative has the curvature over the change of the parameter, about 3e-5, as its error.
Whole runs at a pace or with a growing penalty repeat the increments and the growth of the run. Releases end where the
force is zero to a part of it, or where contact is lost to 1e-6 of the way: whole runs with slightly different
parameters know their ends no better, and only the last rows are compared.
""",
    run=run,
    cost=230.0,
)
