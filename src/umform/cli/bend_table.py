"""``umform bend table``: bend tables for CAD systems."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.bend_commands import bends
from umform.cli.folders import results_folder, say_written
from umform.cli.metal import by_name
from umform.cli.options import SHEET, SOLUTION, check_idle, option
from umform.cli.outcome_screen import print_table
from umform.cli.plausible import refuse_implausible
from umform.cli.root import Debug, Overwrite, Verbose, say
from umform.cli.spec_options import Given, given_by
from umform.cli.warnings import print_warnings_once
from umform.errors import InvalidValue
from umform.processes.air_bending.spec import AirBending

if TYPE_CHECKING:
    from umform.studies.bend_table import BendTable, Setup

_TABLE, _TOOLS = "Table", "Tools"
_FORMATS = ("csv", "json", "freecad", "inventor", "creo", "solidworks")
StoreFolder = Annotated[Path | None, option("Folder of the store of bends; see `umform store`.", _TABLE, "--store")]
#: Parameters of a bend that are lists here, or that a table does not have.
_OTHERS = ("thickness", "opening", "punch_radius", "die_radius", "material", "punch_section", "die_section", "on_top")
_NONE = ("stroke", "bottoming")


@bends.command("table")
@given_by(AirBending, omit=(*_OTHERS, *_NONE))
def bend_table(
    context: typer.Context,
    material: Annotated[str, option("Metals of the library: DC04,1.4301.", SHEET)],
    thickness: Annotated[str, option("Thicknesses in mm: 1,1.5,2, or first:last:step.", SHEET)],
    opening: Annotated[str, option("Openings of dies in mm: 8,12.", _TOOLS)],
    angle: Annotated[str, option("Angles in degrees between the legs after springback: 90:150:15, or 90,120.", _TABLE)],
    given: Given,
    punch_radius: Annotated[str, option("Radii of the tip of the punch in mm.", _TOOLS)] = "1.5",
    die_radius: Annotated[str, option("Radii of the shoulders of the die in mm.", _TOOLS)] = "2",
    tolerance: Annotated[float, option("Tolerance of the angles in degrees.", _TABLE)] = 0.005,
    check: Annotated[
        bool, option("Measure the error between each two angles by a run in their middle.", _TABLE, "--check")
    ] = False,
    formats: Annotated[
        str, option(f"Files to write: {', '.join(_FORMATS)}; with commas between them.", _TABLE, "--format")
    ] = "csv,json",
    out: Annotated[
        str | None, option("Folder for the files; default: results/bend-table.", _TABLE, "--out", "-o")
    ] = None,
    store: StoreFolder = None,
    jobs: Annotated[int | None, option("Setups at a time; default: as many as processors.", SOLUTION)] = None,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Bend tables for CAD systems: radius, K-factor, allowance, deduction, force, stroke; every number from a run.

    Bends in the store are not computed again: the same command continues a stopped table. See docs/bend-tables.md.
    """
    from umform.studies.bend_table import setups

    print_warnings_once()
    check_idle(context, width_elements=(given["width"] is not None, "--width"))
    names = checked_formats(formats)
    check_jobs(jobs)
    lists = {
        "thicknesses": values_of(thickness, "--thickness"),
        "openings": values_of(opening, "--opening"),
        "punch_radii": values_of(punch_radius, "--punch-radius"),
        "die_radii": values_of(die_radius, "--die-radius"),
    }
    case = AirBending(**{**given, **{name: lists[many][0] for name, many in _ONE.items()}})
    with by_name("--material"):
        wanted = setups([name.strip() for name in material.split(",")], case, **lists)
    angles = values_of(angle, "--angle")
    place = results_folder(out, "bend-table", files_of(wanted, names), overwrite=overwrite)
    issue(wanted, angles, place, names, tolerance, check, store, jobs)


def checked_formats(text: str) -> list[str]:
    """Names of formats from a list with commas."""
    from umform.studies.bend_table.formats import check_formats

    names = [name.strip() for name in text.split(",")]
    try:
        check_formats(names)
    except InvalidValue as error:
        error.where = "--format"
        raise
    return names


def check_jobs(jobs: int | None) -> None:
    """Refuse an invalid number of setups at a time."""
    from umform.pool import check_processes

    try:
        check_processes(jobs)
    except InvalidValue as error:
        error.where = "--jobs"
        raise


def files_of(wanted: Sequence[Setup], formats: Sequence[str]) -> list[str]:
    """Names of the files of a table."""
    from umform.studies.bend_table.formats import file_names

    return file_names(wanted, formats)


def issue(
    wanted: Sequence[Setup],
    angles: Sequence[float],
    place: Path,
    formats: Sequence[str],
    tolerance: float,
    check: bool,
    store: Path | None,
    jobs: int | None,
    notes: Sequence[str] = (),
) -> None:
    """Compute a table, write and show it; what could not be computed ends the command with exit code 1."""
    from umform.io.store import Store
    from umform.studies.bend_table import bend_table as run
    from umform.studies.bend_table import write_table

    refuse_implausible(*(setup.case for setup in wanted))
    try:
        table = run(wanted, angles, tolerance=tolerance, check=check, notes=notes, store=Store(store), processes=jobs)
    except KeyboardInterrupt as stop:
        stop.add_note("  the bends so far are in the store: the same command continues")
        raise
    files = write_table(table, place, formats)
    print_table(_rows(table))
    count = sum(len(part.bends) + len(part.checks) for part in table.parts)
    bends = "1 bend" if count == 1 else f"{count} bends"
    typer.echo(f"{bends}, {table.computed} computed now, {count - table.computed} from the store")
    for text in dict.fromkeys(remark for part in table.parts for remark in part.remarks):
        say(f"warning: {text}")
    say_written(place, files)
    for which, why in table.failed.items():
        say(f"not computed: {which}: {why}")
    if table.failed:
        raise typer.Exit(1)


def _rows(table: BendTable) -> list[list[str]]:
    """The table as it is printed."""
    header = ["bends", "angle", "R, mm", "K", "BA, mm", "BD, mm", "force, kN/m", "springback", "stroke, mm"]
    rows = [header]
    for part in table.parts:
        for one in part.bends:
            m = one.measures
            numbers = [one.wanted, m.radius, m.k_factor, m.bend_allowance, m.bend_deduction, m.largest_force]
            texts = [f"{value:.{n}f}" for value, n in zip(numbers, (1, 3, 3, 3, 3, 1), strict=True)]
            rows.append([part.setup.name, *texts, f"{m.springback:.2f}", f"{m.stroke:.3f}"])
    return rows


_ONE = {"thickness": "thicknesses", "opening": "openings", "punch_radius": "punch_radii", "die_radius": "die_radii"}


def values_of(text: str, where: str) -> list[float]:
    """Numbers of a list with commas, or of first:last:step with both ends."""
    from umform.studies.sweep.values import read_values

    values = read_values(text, where)
    try:
        return [float(one.text) for one in values]
    except ValueError:
        raise InvalidValue(
            "this is no list of numbers",
            where=where,
            value=text,
            cause="a letter, or another sign between the numbers",
            remedy="1,1.5,2 or first:last:step such as 30:150:15",
        ) from None
