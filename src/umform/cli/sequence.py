"""``umform bend --sequence``: several bends in one part."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from umform.cli.root import console, printing
from umform.cli.warnings import echo_warnings

if TYPE_CHECKING:
    from umform.processes.air_bending.parameters import AirBending
    from umform.processes.bend_sequence import Part

#: Columns of the table of bends.
_COLUMNS = ("stroke", "loaded_angle", "angle", "springback", "largest_force", "radius", "k_factor", "bend_deduction")


def run_sequence(
    file: Path, sheet: AirBending, note: str, out: str | None, *, tolerance: float, overwrite: bool
) -> None:
    """Bend the part of a file, print the results and write them."""
    from umform.io.folders import folder_for
    from umform.io.staging import staging
    from umform.processes.bend_sequence import bend_sequence
    from umform.processes.bend_sequence.files import FILES, RESULTS, write_files
    from umform.processes.bend_sequence.form import read_sequence

    sequence = read_sequence(file).sequence(sheet)
    say = partial(typer.echo, err=True)
    tell = partial(folder_for, out, Path("results/sequence"), RESULTS, overwrite=overwrite)
    place = tell(say=lambda text: say(f"umform: {text}"))
    with staging(place, FILES):
        part = bend_sequence(sequence, tolerance=tolerance)
        try:
            with printing(f"the files of the part are in {place}"):
                _show(part, note)
        finally:  # even if the table cannot be printed
            files = write_files(place, part, note)
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True)


def _show(part: Part, note: str) -> None:
    """Print a row for each bend, and the flanges."""
    from rich import box
    from rich.table import Table

    from umform.processes.air_bending.measures import QUANTITIES

    table = Table(title="Bends", box=box.SIMPLE_HEAD)
    for name in (
        "bend",
        "at",
        "direction",
        *(f"{QUANTITIES[name].label} {QUANTITIES[name].unit}" for name in _COLUMNS),
    ):
        table.add_column(name, justify="right")
    for number, done in enumerate(part.bends, start=1):
        cells = [f"{getattr(done.measures, name):.{QUANTITIES[name].decimals}f}" for name in _COLUMNS]
        table.add_row(str(number), f"{done.bend.position:g}", done.bend.direction, *cells)
    screen = console()
    screen.print(table)
    screen.print("angles in the end: " + ", ".join(f"{angle:.2f}" for angle in part.angles) + " degrees")
    screen.print(
        "outer lengths of the flanges: " + ", ".join(f"{length:.3f}" for length in part.flanges) + " mm", soft_wrap=True
    )
    if note:
        screen.print(note, soft_wrap=True)
    echo_warnings(part.warnings)
