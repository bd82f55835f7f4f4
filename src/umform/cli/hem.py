"""``umform hem``: an acute bend, closed flat, over an inner sheet or an insert, open, or with a loop."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from umform.cli.drawn_tools import named_tools
from umform.cli.folders import out_option, results_folder, say_written
from umform.cli.metal import SheetMetal, with_metal
from umform.cli.options import All, option
from umform.cli.outcome_screen import show_outcome
from umform.cli.plausible import refuse_implausible
from umform.cli.root import Csv, Debug, Overwrite, Verbose, app, printing
from umform.cli.spec_options import Given, given_by
from umform.cli.studies import Studies, with_studies
from umform.cli.warnings import print_warnings_once
from umform.processes.air_bending.spec import AirBending
from umform.processes.early_end import what_was_reached
from umform.processes.hemming.spec import ACUTE, FOLDED, Hemming, acute, jumps
from umform.spec import parameters

#: Parameters of the sheet that a hem does not have: drawn tools, and what belongs to a single bend.
_NONE_OF_A_HEM = ("punch_section", "die_section", "on_top", "width", "width_elements", "stroke", "bottoming")
_OF_HEM = [name for name in parameters(Hemming) if name != "sheet"]
#: Lengths that follow from the thickness, over the thickness.
_LENGTHS = Hemming.proportions | {
    name: size for name, size in ACUTE.items() if parameters(AirBending)[name].about.unit == "mm"
}


@app.command()
@given_by(
    Hemming,
    AirBending,
    omit=("sheet", "material", *_NONE_OF_A_HEM),
    otherwise={name: f"{times:g} thickness{'' if times == 1.0 else 'es'}" for name, times in _LENGTHS.items()},
    **ACUTE | FOLDED | dict.fromkeys(_LENGTHS) | {"thickness": 1.0, "gap": None},
)
@with_metal
@with_studies(goals=False)
def hem(
    context: typer.Context,
    given: Given,
    *,
    out: Annotated[str | None, out_option("tables, pictures, fields and report", "results/hem")] = None,
    punch: Annotated[str | None, option("Usual punch by name, such as 30/R0.8; see `umform tools`.", "Tools")] = None,
    die: Annotated[str | None, option("Usual die by name, such as V8/30; see `umform tools`.", "Tools")] = None,
    metal: SheetMetal,
    everything: All = False,
    studies: Studies,
    csv: Csv = "plain",
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Hem a sheet: an acute bend in a V-die, then flattened between a plate and a table.

    Each number is defined in docs/bending-operations.md.
    """
    from umform.io.staging import staging
    from umform.processes.hemming import hemming
    from umform.processes.hemming.files import FILES, RESULTS, write_files
    from umform.studies.slopes import slopes
    from umform.studies.slopes.study import planned_runs

    print_warnings_once()
    thickness = given["thickness"]
    given = named_tools(context, given, punch, die)
    law, note = metal.law(thickness)
    of_hem = {name: given.pop(name) for name in _OF_HEM}
    sheet = acute(**{name: value for name, value in given.items() if value is not None}, material=law)
    case = Hemming(**of_hem, sheet=sheet)
    by_slopes = bool(studies.derive) and jumps(case)
    if studies.typed:  # refuse what is wrong before the run
        some = case if by_slopes else replace(case, sheet=replace(sheet, stroke=0.5 * sheet.largest_stroke))
        studies.check(some, {} if by_slopes else case.strokes)
    if by_slopes:
        planned_runs(case, studies.derive or ())
    refuse_implausible(case)
    place = results_folder(out, "hem", RESULTS, overwrite=overwrite)
    with staging(place, FILES):
        with what_was_reached(place, "hem.vtkhdf"):
            done = hemming(case)
        more: list[Path] = []
        try:
            rates = partial(slopes, case, studies.derive or (), process=hemming, base=done) if by_slopes else None
            for one, written in studies.added_to(done, done.with_stroke, place, hold=done.strokes, rates=rates):
                done = one
                more += written
            with printing(f"the files of the hem are in {place}"):
                show_outcome(done, note=note, everything=everything)
        finally:  # even if the table cannot be printed
            files = [*write_files(place, done, note), *more]
    say_written(place, files)
