"""``umform flat``: the flat pattern of a part of a STEP file."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.options import option
from umform.cli.root import Debug, Overwrite, Verbose, app, console
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.processes.flat_pattern import AllowanceProvider, FlatPattern

_LENGTHS = "Flat length of bends"


@app.command()
def flat(
    part: Annotated[Path, typer.Argument(metavar="PART.step", help="STEP file of one bent part.")],
    k_factor: Annotated[
        float | None, option("K by ANSI: the neutral line at K t from the inner face.", _LENGTHS)
    ] = None,
    table: Annotated[
        Path | None, option("CSV file with the columns angle, radius, thickness, allowance.", _LENGTHS)
    ] = None,
    out: Annotated[
        str | None, typer.Option(metavar="FOLDER", help="Folder for drawing, picture, numbers; default: results/flat.")
    ] = None,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Unfold a part: the flat pattern of a STEP file as DXF, SVG and JSON.

    Thickness, bends and radii are found. See docs/flat-pattern.md.
    """
    from umform.io.folders import folder_for
    from umform.processes.flat_pattern import flat as flattened
    from umform.processes.flat_pattern.files import FILES, RESULTS, write_files

    del FILES
    pattern = flattened(part, _provider(k_factor, table))
    say = partial(typer.echo, err=True)
    place = folder_for(out, Path("results/flat"), RESULTS, overwrite=overwrite, say=lambda text: say(f"umform: {text}"))
    files = write_files(place, pattern)
    _show(pattern)
    for warning in pattern.warnings:
        typer.echo(f"umform: warning: {warning}", err=True)
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True)


def _provider(k_factor: float | None, table: Path | None) -> AllowanceProvider:
    from umform.processes.flat_pattern import AllowanceTable, KFactor

    if (k_factor is None) == (table is None):
        raise InvalidValue(
            "give one source of the flat length of bends",
            where="--k-factor",
            cause="none is given" if k_factor is None else "two are given",
            remedy="--k-factor .44, or --table bends.csv",
        )
    return KFactor(k_factor) if k_factor is not None else AllowanceTable.read(table or Path())


def _show(pattern: FlatPattern) -> None:
    from rich import box
    from rich.table import Table

    length, width = pattern.size.tolist()
    console().print(
        f"{pattern.path.name} (in {pattern.unit}): {pattern.thickness:.4g} mm sheet, flat {length:.3f} x {width:.3f} mm"
        f", {pattern.area:.1f} mm², {len(pattern.holes)} holes",
        soft_wrap=True,
    )
    table = Table("bend", "faces", "direction", box=box.SIMPLE_HEAD)
    for name in ("angle", "R, mm", "length, mm", "allowance, mm"):
        table.add_column(name, justify="right")
    table.add_column("from")
    for bend in pattern.bends:
        table.add_row(
            str(bend.number),
            ", ".join(map(str, bend.faces)),
            bend.direction,
            f"{bend.angle:.2f}",
            f"{bend.allowance.radius:.3f}",
            f"{bend.length:.2f}",
            f"{bend.allowance.length:.3f}",
            bend.allowance.source,
        )
    console().print(table)
