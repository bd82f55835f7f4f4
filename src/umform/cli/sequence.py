"""``umform bend --sequence``: several bends in one part."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from umform.cli.developed import sequence_of
from umform.cli.folders import results_folder, say_written
from umform.cli.outcome_screen import show_outcome
from umform.cli.plausible import refuse_implausible
from umform.cli.root import printing, say
from umform.cli.timing import show_timing
from umform.processes.early_end import what_was_reached

if TYPE_CHECKING:
    from umform.cli.studies import Studies
    from umform.processes.air_bending.spec import AirBending


def run_sequence(
    file: Path,
    sheet: AirBending,
    note: str,
    out: str | None,
    length: float | None,
    studies: Studies,
    *,
    tolerance: float,
    overwrite: bool,
    everything: bool,
    flat_only: bool = False,
    force: bool = False,
    timing: bool = False,
) -> None:
    """Bend the part of a file, print the results and write them; a part that collides ends with exit code 1.

    Of a file with outside dimensions, flat length and bend lines are printed first; ``flat_only``: nothing else.
    """
    from umform.io.staging import staging
    from umform.processes.bend_sequence import bend_sequence
    from umform.processes.bend_sequence.files import FILES, RESULTS, write_files
    from umform.processes.bend_sequence.foreseen_collisions import foreseen_collisions, foreseen_text
    from umform.timing import Timing, timings

    made = sequence_of(file, sheet, flat_only=flat_only)
    if flat_only:
        return
    studies.check(made.some_strokes, made.strokes)
    refuse_implausible(made, force=force)
    place = results_folder(out, "sequence", RESULTS, overwrite=overwrite)
    sequence = studies.compensated(made)
    for number, hits in foreseen_collisions(sequence).items():
        for hit in hits:
            say(foreseen_text(sequence, number, hit))
    with staging(place, FILES):
        with timings() as spent, what_was_reached(place, "part.vtkhdf"):
            part = replace(bend_sequence(sequence, tolerance=tolerance), bend_length=length)
        more: list[Path] = []
        try:
            for one, written in studies.added_to(part, part.with_strokes, place, hold=part.strokes):
                part = one
                more += written
            with printing(f"the files of the part are in {place}"):
                show_outcome(part, note=note, everything=everything, without=part.collisions)
        finally:  # even if the table cannot be printed
            files = [*write_files(place, part, note), *more]
    say_written(place, files)
    if timing:
        show_timing(Timing.sum(spent))
    if part.collisions:
        text = "umform: this part cannot be bent so: " + "; ".join(part.collisions)
        typer.secho(text, fg=typer.colors.RED, err=True)
        raise typer.Exit(1)
    studies.end()
