"""``umform bend correct``: one measured bend corrects the card of its metal."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from umform.cli.bend_commands import bends
from umform.cli.bend_table import StoreFolder, check_jobs, checked_formats, files_of, issue
from umform.cli.folders import results_folder
from umform.cli.metal import by_name
from umform.cli.options import SHEET, SOLUTION, check_idle, option
from umform.cli.outcome_screen import print_table
from umform.cli.plausible import refuse_implausible
from umform.cli.root import Debug, Overwrite, Verbose, console
from umform.cli.spec_options import Given, given_by
from umform.cli.warnings import print_warnings_once
from umform.errors import InvalidValue
from umform.processes.air_bending.spec import AirBending

_MEASURED, _FILES = "Measured bend", "Files"
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_OMITTED = ("material", "punch_section", "die_section", "on_top", "bottoming")


@bends.command("correct")
@given_by(AirBending, omit=_OMITTED)
def bend_correct(
    context: typer.Context,
    material: Annotated[str, option("Card to correct: a metal of the library, or a file.", SHEET)],
    angle: Annotated[
        str, option("Angle after springback in degrees, such as 91.7+-.1.", _MEASURED, "--measured-angle")
    ],
    given: Given,
    force: Annotated[
        str | None, option("Force at the stroke in kN/m, such as 94.1+-1.", _MEASURED, "--measured-force")
    ] = None,
    radius: Annotated[
        str | None, option("Inside radius in mm, such as 2.5+-.1.", _MEASURED, "--measured-radius")
    ] = None,
    table: Annotated[
        Path | None, option("bends.json of a table to issue again with the corrected card.", _FILES, "--issue-again")
    ] = None,
    formats: Annotated[str, option("Files of this table, as of `umform bend table`.", _FILES, "--format")] = "csv,json",
    out: Annotated[str | None, option("Folder; default: results/bend-corrected.", _FILES, "--out", "-o")] = None,
    store: StoreFolder = None,
    jobs: Annotated[int | None, option("Setups of the table at a time.", SOLUTION)] = None,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Correct the flow curve of a metal by one measured bend: angle, and perhaps force and radius, at a stroke.

    Writes metal.toml, which `--material` takes in all commands, and on request a bend table with it.
    """
    from umform.problem.metal_file import metal_of, write_metal
    from umform.studies.bend_table import Setup, correct
    from umform.studies.bend_table.formats.table_json import issued

    print_warnings_once()
    if given["stroke"] is None:
        raise InvalidValue(
            "a measured bend has a stroke", where="--stroke", cause="it is missing", remedy="such as --stroke 6.1"
        )
    numbers = {
        "angle": measured(angle, "--measured-angle"),
        "force": measured(force, "--measured-force"),
        "radius": measured(radius, "--measured-radius"),
    }
    again = (table is not None, "--issue-again")
    check_idle(context, width_elements=(given["width"] is not None, "--width"), formats=again, store=again, jobs=again)
    names = checked_formats(formats)
    check_jobs(jobs)
    with by_name("--material"):
        metal = metal_of(material, given["thickness"])
    case = AirBending(**given, material=metal.law)
    refuse_implausible(case)
    wanted, before = [], None if table is None else issued(table)
    if before is not None:
        own = [parameters for name, parameters in before.setups if name == metal.name]
        wanted = [Setup(f"{metal.name}-corrected", AirBending(**one, material=metal.law)) for one in own]
        if not wanted:
            raise InvalidValue(
                "the table has no bends of this metal",
                where="--issue-again",
                value=metal.name,
                cause=f"its metals are {', '.join(sorted({name for name, _ in before.setups}))}",
                remedy="the metal of the table, or another table",
            )
    files = ["metal.toml", *files_of(wanted, names)]
    place = results_folder(out, "bend-corrected", files, overwrite=overwrite)
    known: dict[str, Any] = {f"{name}_deviation": one[1] for name, one in numbers.items() if one and one[1] is not None}
    known |= {name: one[0] for name, one in numbers.items() if one}
    done = correct(case, **known, name=metal.name)
    print_table(done.found.table)
    for note in (*done.notes, *done.found.remarks):
        console().print(note, soft_wrap=True, markup=False)
    place.mkdir(parents=True, exist_ok=True)
    write_metal(place / "metal.toml", done.law, [*done.notes, metal.note])
    console().print(f"Written to {place}: metal.toml", soft_wrap=True)
    if before is not None:
        corrected = [Setup(one.metal, replace(one.case, material=done.law)) for one in wanted]
        issue(corrected, before.angles, place, names, before.tolerance, before.checked, store, jobs, done.notes)


def measured(text: str | None, where: str) -> tuple[float, float | None] | None:
    """A number and its standard deviation, if there is one, of a text such as 91.7+-.1."""
    if text is None:
        return None
    found = re.fullmatch(rf"({_NUMBER})(?:\+-({_NUMBER}))?", text.strip())
    numbers = [float(one) for one in found.groups() if one is not None] if found else []
    if not numbers or min(numbers) <= 0.0:
        raise InvalidValue(
            "a measured number is positive, and so is its standard deviation",
            where=where,
            value=text,
            cause="a decimal comma, a unit behind the number, or a sign",
            remedy="such as 91.7+-.1",
        )
    return numbers[0], numbers[1] if len(numbers) > 1 else None
