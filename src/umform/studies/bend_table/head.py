"""What stands on top of each file of a table: what was computed, and the definitions."""

from __future__ import annotations

import umform
from umform.processes.air_bending.spec import AirBending
from umform.studies.bend_table.table import BendTable, Tabled

#: Definitions that all files share; docs/bend-tables.md has them with a picture.
DEFINITIONS = (
    "lengths in mm, angles in degrees; T thickness, R inside radius after springback",
    "angle: between the legs of the part, 180 is flat; bend angle = 180 - angle",
    "K (ANSI): the neutral line is K T from the inner face; DIN 6935: k T / 2 from it, so k = 2 K",
    "allowance BA = bend angle in radians (R + K T) = flat length - straight legs",
    "deduction BD = 2 (R + T) tan(bend angle / 2) - BA: sides up to where the outer faces meet, at all angles",
    "R is the radius that the bend gets in these tools, not that of the punch",
)


def head(table: BendTable, *parts: Tabled) -> list[str]:
    """Lines of text without marks of comments."""
    found = [f"Bend table of umform {umform.__version__}; every number is from a run of air bending"]
    found += [*table.notes, *DEFINITIONS]
    for part in parts:
        case = part.setup.case
        found.append(
            f"{part.setup.metal}, T {case.thickness:g}; V {case.opening:g}, {case.die_angle:g} degrees, shoulders "
            f"{case.die_radius:g}; punch {case.punch_radius:g}, {case.punch_angle:g} degrees; {_sheet(case)}"
        )
        found += [f"not computed: {angle:g} degrees: {why}" for angle, why in part.failed.items()]
        found += part.remarks
        found.append(f"angles are within {table.tolerance:g} degrees; {_interpolation(part)}")
    return found


def _sheet(case: AirBending) -> str:
    """How the sheet lies, and what holds it beside the tools."""
    wide = "plane strain" if case.width is None else f"{case.width:g} wide with free ends"
    rolling = "" if case.rolling is None else f"rolling direction at {case.rolling:g} degrees from the bend line"
    friction = f"friction {case.friction:g}" if case.friction else ""
    return ", ".join(filter(None, (wide, rolling, friction)))


def _interpolation(part: Tabled) -> str:
    linear, cubic = part.linear_error, part.cubic_error
    if linear is None or cubic is None:
        return "between them nothing was checked: use these angles only"
    return (
        f"between them BD errs by up to {linear:.2g} if it is interpolated linearly, by {cubic:.2g} with cubics of R "
        "and K (a run in the middle of each interval)"
    )
