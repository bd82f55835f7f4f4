"""Flat hems: closed, without penetration; what converges with the mesh and the increments; what moves the roll-in."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from umform import sheet_metals
from umform.errors import NoConvergence
from umform.materials import J2, Metal
from umform.processes.hemming import Hem, Hemming, hemming
from umform.processes.hemming.spec import acute
from umform_book.balance import balance_row
from umform_book.case import Case
from umform_book.page import Page
from umform_book.reality.measured_loop import law_of_sheet

#: Length of the base, in thicknesses: the flange, and one more.
BASE = 13.0
#: Layers, elements of a thickness along the sheet, and increments of the plate.
RUNS = {
    "DC04": ((3, 3.0, 120), (3, 4.0, 120), (3, 6.0, 120), (3, 4.0, 240), (4, 4.0, 120), (2, 4.0, 120)),
    "AA6xxx-T4": ((3, 4.0, 120), (3, 6.0, 120), (3, 8.0, 120), (4, 4.0, 120), (2, 4.0, 120)),
}
#: Mesh of the short version, and its tolerance of the angle in degrees.
COARSE, ROUGH = 3.0, 5.0
#: Gap of a closed hem and allowed penetration in thicknesses; largest change of the roll-in to the finer mesh, mm.
CLOSED, DEEPEST, SAME = 0.01, 0.005, 0.02
#: Measures in the table, and how they are called there.
MEASURES = {
    "roll_in": "roll-in",
    "creep": "creep",
    "springback": "springback",
    "loop_gap": "largest gap",
    "largest_force": "force, kN/m",
    "outer_strain": "outer strain",
    "inner_strain": "inner strain",
}
#: Below the default mesh: no bound is asked of these changes. Relative change of a measure that has not settled.
COARSER, UNSETTLED = ("3 to 4 elements", "2 to 3 layers"), 0.1
#: Hems that are compared: metal, what changes, the one before and the one after.
PAIRS = (
    ("DC04", COARSER[0], (3, 3.0, 120), (3, 4.0, 120)),
    ("DC04", COARSER[1], (2, 4.0, 120), (3, 4.0, 120)),
    ("DC04", "4 to 6 elements", (3, 4.0, 120), (3, 6.0, 120)),
    ("DC04", "3 to 4 layers", (3, 4.0, 120), (4, 4.0, 120)),
    ("DC04", "120 to 240 increments", (3, 4.0, 120), (3, 4.0, 240)),
    ("AA6xxx-T4", COARSER[1], (2, 4.0, 120), (3, 4.0, 120)),
    ("AA6xxx-T4", "4 to 6 elements", (3, 4.0, 120), (3, 6.0, 120)),
    ("AA6xxx-T4", "6 to 8 elements", (3, 6.0, 120), (3, 8.0, 120)),
    ("AA6xxx-T4", "3 to 4 layers", (3, 4.0, 120), (4, 4.0, 120)),
)
#: Relative change of a parameter whose effect is asked for.
CHANGE = 0.25


def laws() -> dict[str, J2 | Metal]:
    """The metals by their names."""
    return {"DC04": sheet_metals.get("DC04", 1.0).law, "AA6xxx-T4": law_of_sheet()}


def cases(page: Page) -> Iterator[tuple[str, str, Hemming]]:
    """Metal, label and parameters of each hem."""
    known = laws()
    if page.short:
        sheet = acute(material=known["DC04"], elements_per_thickness=COARSE, increment=0.025)
        yield "DC04", "short: over an insert", Hemming(form="insert", base=BASE, sheet=sheet)
        return
    for metal, meshes in RUNS.items():
        for layers, fine, count in meshes:
            sheet = acute(material=known[metal], elements_per_thickness=fine, layers=layers)
            label = f"{metal}, {layers} layers, {fine:g} elements, {count} increments"
            yield metal, label, Hemming(base=BASE, increments=count, sheet=sheet)


def made(page: Page, label: str, case: Hemming) -> Hem | None:
    """Hem, its checks, and its balance; None if its run ends early, which is a check that fails."""
    try:
        hem = hemming(case, frames=1, progress=False, **({"tolerance": ROUGH} if page.short else {}))
    except NoConvergence as error:
        page.text(f"{label}: the run ends early. {error.cause}")
        page.at_most(f"{label}: runs that end early", 1.0, 0.0)
        return None
    page.balances.append(balance_row(page.case.name, label, hem.result))
    page.at_most(f"{label}: gap left under load, mm", abs(hem.measures.left), CLOSED)
    page.at_most(f"{label}: penetration in thicknesses", deepest(hem), DEEPEST)
    return hem


def deepest(hem: Hem) -> float:
    """Largest penetration of all contacts, in thicknesses."""
    contacts = hem.result.model.system.penalised
    return max(float(hem.result[f"{one.name}_penetration"].max()) for one in contacts) / hem.case.sheet.thickness


def run(page: Page) -> None:
    """Both metals on their meshes, then one parameter after the other."""
    hems: dict[tuple[Any, ...], Hem] = {}
    rows: list[tuple[str | float, ...]] = []
    for metal, label, case in page.each(list(cases(page)), lambda one: one[1]):
        hem = made(page, label, case)
        if hem is not None:
            hems[metal, case.sheet.layers, case.sheet.elements_per_thickness, case.increments] = hem
            measures = (getattr(hem.measures, name) for name in MEASURES)
            rows.append((label, *measures, hem.measures.left, deepest(hem)))
    page.table("Flat hems; mm", ("hem", *MEASURES.values(), "gap left", "penetration"), rows)
    page.shape("closed", next(iter(hems.values())).result, "The hem of DC04", view=(-90.0, 0.0))
    if page.short:
        return
    converge(page, {f"{name}: {what}": (hems.get((name, *a)), hems.get((name, *b))) for name, what, a, b in PAIRS})
    steel, fine = hems.get(("DC04", 3, 4.0, 120)), hems.get(("DC04", 3, 6.0, 120))
    if steel is not None and fine is not None:
        vary(page, steel, abs(fine.measures.roll_in - steel.measures.roll_in))


def converge(page: Page, pairs: dict[str, tuple[Hem | None, Hem | None]]) -> None:
    """What changes with the mesh and with the increments."""
    rows = []
    for what, (before, after) in pairs.items():
        if before is None or after is None:
            continue
        changes = [getattr(after.measures, name) - getattr(before.measures, name) for name in MEASURES]
        rows.append((what, *changes))
        if not what.endswith(COARSER):
            page.at_most(f"{what}: change of the roll-in, mm", abs(changes[0]), SAME)
            ends = [getattr(after.measures, name) for name in MEASURES]
            parts = {text: d / end for text, d, end in zip(MEASURES.values(), changes, ends, strict=True)}
            moved = [f"{text} ({abs(part):.0%})" for text, part in parts.items() if abs(part) > UNSETTLED]
            page.text(f"{what}: changed by more than {UNSETTLED:.0%}: {', '.join(moved) or 'nothing'}.")
    page.table("Changes with elements of a thickness, layers and increments", ("", *MEASURES.values()), rows)


def vary(page: Page, first: Hem, by_mesh: float) -> None:
    """Roll-in where one parameter after the other changes; its change with the mesh, mm."""
    case, sheet, more = first.case, first.case.sheet, 1.0 + CHANGE
    base = first.measures
    changed: dict[str, dict[str, Any]] = {
        "angle before the plate": {"angle": case.angle * more},
        "length of the flange": {"flange": case.flange * more, "base": case.base * more},
        "radius of the punch": {"sheet": replace(sheet, punch_radius=sheet.punch_radius * more)},
    }
    rows = []
    for name, change in changed.items():
        hem = made(page, f"{CHANGE:.0%} more: {name}", replace(case, **change))
        if hem is None:
            continue
        found = hem.measures
        rows.append((name, found.roll_in, found.roll_in - base.roll_in, found.creep - base.creep, found.outer_strain))
    columns = (f"{100.0 * CHANGE:g} % more", "roll-in", "its change", "change of the creep", "outer strain")
    page.table(f"One parameter after the other; DC04, {sheet.elements_per_thickness:g} elements; mm", columns, rows)
    unsure = [name for name, _, effect, *_ in rows if abs(effect) <= by_mesh]
    if unsure:
        page.text(f"Below the change with the mesh, {by_mesh:.3f} mm, and of no certain sign: {', '.join(unsure)}.")


CASE = Case(
    name="touch-flat-hem",
    title="Flat hems: closed, what converges, what moves the roll-in",
    problem="A sheet of 1 mm is bent to 40 degrees in a V of 30 degrees and pressed flat to two thicknesses between a "
    "plate and a table, as `umform hem` does, in plane strain and without friction; flange 12 and base 13 mm. DC04 of "
    "the library, and AA6xxx-T4 with the law of the [measured loop](material-measured-loop.md). Both laws are "
    "extrapolated to the strains of the fold.",
    reference="Bounds: at most 1 % of the thickness is left between flange and base in the outer half of the flange "
    "under load; no penetration, of the sheet in the tools or in itself, exceeds the allowed 0.5 % of it; and the "
    "roll-in changes by at most 0.02 mm from 3 layers of 4 elements on a thickness to 6 elements, to 4 layers, and "
    "with twice the increments. Two layers are the default. No measured hem is at hand: the table of the parameters is "
    "our own. A study of parameters of hems, whose numbers are not at hand: "
    "[Proc. IMechE B 2005](https://doi.org/10.1243/095440505X32661).",
    run=run,
    cost=320.0,
    own="the effect of the parameters on the roll-in",
    picture="closed",
)
