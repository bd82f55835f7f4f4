"""``umform bend table``: bend tables for CAD systems."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from umform.cli.bends import bends
from umform.cli.given import Given, given_by
from umform.cli.options import SHEET, SOLUTION, option
from umform.cli.root import Debug, Overwrite, Verbose, console
from umform.cli.warnings import print_warnings_once
from umform.errors import InvalidValue
from umform.processes.air_bending.spec import AirBending

_TABLE, _TOOLS = "Table", "Tools"
#: Parameters of a bend that are lists here, or that a table does not have.
_OTHERS = ("thickness", "opening", "punch_radius", "die_radius", "material", "punch_section", "die_section")
_NONE = ("stroke", "bottoming", "rolling")


@bends.command("table")
@given_by(AirBending, omit=(*_OTHERS, *_NONE))
def bend_table(
    material: Annotated[str, option("Metals of the library: DC04,1.4301.", SHEET)],
    thickness: Annotated[str, option("Thicknesses: 1,1.5,2, or first:last:step.", SHEET)],
    opening: Annotated[str, option("Openings of dies: 8,12.", _TOOLS)],
    angle: Annotated[str, option("Angles between the legs after springback: 90:150:15, or 90,120.", _TABLE)],
    given: Given,
    punch_radius: Annotated[str, option("Radii of the tip of the punch.", _TOOLS)] = "1.5",
    die_radius: Annotated[str, option("Radii of the shoulders of the die.", _TOOLS)] = "2",
    out: Annotated[str | None, option("Folder for the files; default: results/bend-table.", _TABLE)] = None,
    store: Annotated[Path | None, option("Folder of the store of results; see `umform store`.", _TABLE)] = None,
    jobs: Annotated[int | None, option("Setups at a time; default: as many as processors.", SOLUTION)] = None,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Bend tables for CAD systems: radius, K-factor, allowance, deduction, force, stroke; every number from a run.

    Bends of the store are not computed again: the same command continues a stopped table. See docs/bend-tables.md.
    """
    from umform.io.folders import folder_for
    from umform.io.store import Store
    from umform.studies.bend_table import bend_table as run
    from umform.studies.bend_table import setups
    from umform.studies.bend_table.formats import table_csv

    print_warnings_once()
    lists = {
        "thicknesses": values_of(thickness, "--thickness"),
        "openings": values_of(opening, "--opening"),
        "punch_radii": values_of(punch_radius, "--punch-radius"),
        "die_radii": values_of(die_radius, "--die-radius"),
    }
    case = AirBending(**{**given, **{name: lists[many][0] for name, many in _ONE.items()}})
    wanted = setups([name.strip() for name in material.split(",")], case, **lists)
    place = folder_for(
        out,
        Path("results/bend-table"),
        ["bends.csv"],
        overwrite=overwrite,
        say=lambda text: typer.echo(f"umform: {text}", err=True),
    )
    table = run(wanted, values_of(angle, "--angle"), store=Store(store), processes=jobs)
    place.mkdir(parents=True, exist_ok=True)
    files = table_csv.write(table, place)
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True)


_ONE = {"thickness": "thicknesses", "opening": "openings", "punch_radius": "punch_radii", "die_radius": "die_radii"}


def values_of(text: str, where: str) -> list[float]:
    """Numbers of a list with commas, or of first:last:step with both ends."""
    try:
        if ":" not in text:
            return [float(one) for one in text.split(",")]
        first, last, step = (float(one) for one in text.split(":"))
        if step <= 0.0 or last < first or last - first > 1000.0 * step:
            raise ValueError
        return [first + number * step for number in range(int((last - first) / step + 1e-9) + 1)]
    except ValueError:
        raise InvalidValue(
            "this is no list of numbers",
            where=where,
            value=text,
            cause="a letter, a decimal comma, or a step of the wrong sign",
            remedy="1,1.5,2 or first:last:step such as 30:150:15",
        ) from None
