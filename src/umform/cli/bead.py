"""``umform bead``: a sheet drawn through a modelled draw bead."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from umform.cli.folders import out_option, results_folder, say_written
from umform.cli.metal import SheetMetal, with_metal
from umform.cli.options import (
    SOLUTION,
    All,
    PrintDeck,
    option,
    print_deck,
)
from umform.cli.outcome_screen import show_outcome
from umform.cli.plausible import refuse_implausible
from umform.cli.root import Csv, Debug, Overwrite, Verbose, app, printing
from umform.cli.spec_options import Given, given_by
from umform.cli.studies import Studies, with_studies
from umform.cli.timing import Timed, show_timing
from umform.cli.warnings import print_warnings_once
from umform.processes.draw_bead.spec import DrawBead
from umform.processes.early_end import what_was_reached


@app.command()
@given_by(DrawBead, omit=("material", "newton", "pace"))
@with_metal
@with_studies()
def bead(
    given: Given,
    *,
    out: Annotated[str | None, out_option("tables, pictures, fields and report", "results/bead")] = None,
    metal: SheetMetal,
    extrapolate: Annotated[
        bool | None,
        option(
            "Also run two coarser meshes: extrapolated forces and their error; default, but not with --want, --derive "
            "or --scatter.",
            SOLUTION,
            "--extrapolate/--no-extrapolate",
        ),
    ] = None,
    studies: Studies,
    deck: PrintDeck = False,
    everything: All = False,
    csv: Csv = "plain",
    overwrite: Overwrite = False,
    timing: Timed = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Draw a sheet through a draw bead: restraining force, uplift, thinning, and the equivalent bead.

    Each number is defined in docs/draw-beads.md.
    """
    from umform.io.staging import staging
    from umform.processes.draw_bead.case import drawn_through, extrapolated
    from umform.processes.draw_bead.equivalent import in_python
    from umform.processes.draw_bead.files import FILES, RESULTS, write_files

    print_warnings_once()
    law, note = metal.law(given["thickness"])
    case = DrawBead(**given, material=law)
    if deck:
        print_deck(studies.in_deck(case))
        return
    several = studies.extrapolates(extrapolate)
    studies.check(case)
    refuse_implausible(case)
    place = results_folder(out, "bead", RESULTS, overwrite=overwrite)
    case = studies.compensated(case)
    with staging(place, FILES):
        with what_was_reached(place, "bead.vtkhdf"):
            drawn = extrapolated(case) if several else drawn_through(case)
        more: list[Path] = []
        try:
            for one, written in studies.added_to(drawn, case, place):
                drawn = one
                more += written
            with printing(f"the files of the bead are in {place}"):
                show_outcome(drawn, f"equivalent: {in_python(drawn)}", note=note, everything=everything)
        finally:  # even if the table cannot be printed
            with drawn.result.timing.files:
                files = [*write_files(place, drawn, note), *more]
    say_written(place, files)
    if timing:
        show_timing(drawn.result.timing)
    studies.end()
