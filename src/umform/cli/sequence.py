"""``umform bend --sequence``: several bends in one part."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from umform.cli.root import console, printing
from umform.cli.run_checks import show_checks
from umform.cli.warnings import echo_warnings

if TYPE_CHECKING:
    from umform.processes.air_bending.spec import AirBending
    from umform.processes.bend_sequence import Part


def run_sequence(
    file: Path,
    sheet: AirBending,
    note: str,
    out: str | None,
    length: float | None,
    *,
    tolerance: float,
    overwrite: bool,
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
        part = bend_sequence(sequence, tolerance=tolerance)
        try:
            with printing(f"the files of the part are in {place}"):
                _show(part, note, length)
        finally:  # even if the table cannot be printed
            files = write_files(place, part, note)
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True)
    if part.collisions:
        text = "umform: this part cannot be bent so: " + "; ".join(part.collisions)
        typer.secho(text, fg=typer.colors.RED, err=True)
        raise typer.Exit(1)


def _show(part: Part, note: str, length: float | None) -> None:
    """Print a column for each bend, and the flanges."""
    from rich import box
    from rich.table import Table

    from umform.processes.air_bending.remarks import total_force
    from umform.processes.bend_sequence.words import bend_rows, flanges, remarks

    header, *rows = bend_rows(part)
    table = Table(header[0], title="Bends", box=box.SIMPLE_HEAD)
    for name in header[1:-1]:
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column(header[-1])
    for row in rows:
        table.add_row(*row)
    screen = console()
    screen.print(table)
    said = [flanges(part)]
    if length is not None:
        said.append(total_force(max(done.measures.largest_force for done in part.bends), length))
    for text in (*said, *remarks(part), *([note] if note else [])):
        screen.print(text, soft_wrap=True)
    show_checks(screen, part.stages)
    echo_warnings(text for text in part.warnings if text not in part.collisions)
