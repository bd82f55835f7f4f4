"""``umform bend --sequence``: several bends in one part."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from umform.cli.outcome_screen import show_outcome
from umform.cli.root import console, printing

if TYPE_CHECKING:
    from umform.processes.air_bending.spec import AirBending


def run_sequence(
    file: Path,
    sheet: AirBending,
    note: str,
    out: str | None,
    length: float | None,
    *,
    tolerance: float,
    overwrite: bool,
    everything: bool,
) -> None:
    """Bend the part of a file, print the results and write them; a part that collides ends with exit code 1."""
    from umform.io.folders import folder_for
    from umform.io.staging import staging
    from umform.processes.bend_sequence import bend_sequence
    from umform.processes.bend_sequence.files import FILES, RESULTS, write_files
    from umform.processes.bend_sequence.foreseen import foreseen_collisions, foreseen_text
    from umform.processes.bend_sequence.form import read_sequence

    sequence = read_sequence(file).sequence(sheet)
    say = partial(typer.echo, err=True)
    tell = partial(folder_for, out, Path("results/sequence"), RESULTS, overwrite=overwrite)
    place = tell(say=lambda text: say(f"umform: {text}"))
    for number, hits in foreseen_collisions(sequence).items():
        for hit in hits:
            say(f"umform: {foreseen_text(sequence, number, hit)}")
    with staging(place, FILES):
        part = replace(bend_sequence(sequence, tolerance=tolerance), bend_length=length)
        try:
            with printing(f"the files of the part are in {place}"):
                show_outcome(part, note=note, everything=everything, without=part.collisions)
        finally:  # even if the table cannot be printed
            files = write_files(place, part, note)
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True)
    if part.collisions:
        text = "umform: this part cannot be bent so: " + "; ".join(part.collisions)
        typer.secho(text, fg=typer.colors.RED, err=True)
        raise typer.Exit(1)
