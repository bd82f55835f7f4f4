"""``umform bend --sequence``: several bends in one part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from umform.cli.compensate import compensated
from umform.cli.developed import sequence_of
from umform.cli.outcome_screen import show_outcome
from umform.cli.plausible import refuse_implausible
from umform.cli.root import console, printing
from umform.cli.timing import show_timing

if TYPE_CHECKING:
    from umform.cli.scattering import ScatterOptions
    from umform.processes.air_bending.spec import AirBending


def run_sequence(
    file: Path,
    sheet: AirBending,
    note: str,
    out: str | None,
    length: float | None,
    want: Sequence[str] | None = None,
    by: Sequence[str] | None = None,
    *,
    tolerance: float,
    overwrite: bool,
    everything: bool,
    flat_only: bool = False,
    derive: Sequence[str] | None = None,
    scatter_options: ScatterOptions | None = None,
    force: bool = False,
    timing: bool = False,
) -> None:
    """Bend the part of a file, print the results and write them; a part that collides ends with exit code 1.

    Of a file with outside dimensions, flat length and bend lines are printed first; ``flat_only``: nothing else.
    """
    from umform.cli.derive import check_derived, derived
    from umform.io.folders import folder_for
    from umform.io.staging import staging
    from umform.processes.bend_sequence import bend_sequence
    from umform.processes.bend_sequence.files import FILES, RESULTS, write_files
    from umform.processes.bend_sequence.foreseen import foreseen_collisions, foreseen_text
    from umform.timing import Timing, timings

    made = sequence_of(file, sheet, flat_only=flat_only)
    if flat_only:
        return
    some = made.some_strokes  # refuse what is wrong before the run
    check_derived(some, derive, made.strokes)
    if scatter_options:
        scatter_options.check(some)
    refuse_implausible(made, force=force)
    say = partial(typer.echo, err=True)
    tell = partial(folder_for, out, Path("results/sequence"), RESULTS, overwrite=overwrite)
    place = tell(say=lambda text: say(f"umform: {text}"))
    goals = compensated(made, want, by)
    sequence = goals.case
    for number, hits in foreseen_collisions(sequence).items():
        for hit in hits:
            say(f"umform: {foreseen_text(sequence, number, hit)}")
    with staging(place, FILES):
        with timings() as spent:
            part = replace(bend_sequence(sequence, tolerance=tolerance), bend_length=length)
        more: list[Path] = []
        try:
            part, wanted = goals.added_to(part, place)
            more += wanted
            part, found = derived(part, part.with_strokes, derive, place, part.strokes)
            more += found
            if scatter_options:
                part, spread = scatter_options.added_to(part, part.with_strokes, place)
                more += spread
            with printing(f"the files of the part are in {place}"):
                show_outcome(part, note=note, everything=everything, without=part.collisions)
        finally:  # even if the table cannot be printed
            files = [*write_files(place, part, note), *more]
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True)
    if timing:
        show_timing(Timing.sum(spent))
    if part.collisions:
        text = "umform: this part cannot be bent so: " + "; ".join(part.collisions)
        typer.secho(text, fg=typer.colors.RED, err=True)
        raise typer.Exit(1)
    goals.end()
