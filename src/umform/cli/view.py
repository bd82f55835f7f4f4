"""``umform view``: the deformed sheet of a file of fields, in a window or as a picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.field_files import file_of_fields
from umform.cli.root import Debug, app

if TYPE_CHECKING:
    from umform.report.part import Part

#: Default fields: the first available one is shown.
_FAVOURITES = ("plastic_strain_max", "thickness_change", "displacement")

#: Elements up to which their edges are drawn.
_MANY = 20_000
#: Field of the rolling direction.
_ROLLING = "rolling"


@app.command()
def view(
    file: Annotated[Path, typer.Argument(metavar="FILE.vtkhdf", help="Fields of a run, or the folder of a run.")],
    field: Annotated[str | None, typer.Option(help="Field to colour by; the length of a vector.")] = None,
    frame: Annotated[int, typer.Option(help="Frame: 0 is the first, -1 the last.")] = -1,
    rolling: Annotated[
        bool, typer.Option("--rolling/--no-rolling", help="Draw the rolling direction, if the file has it.")
    ] = True,
    tools: Annotated[bool, typer.Option("--tools/--no-tools", help="Draw the tools, if the file has them.")] = True,
    whole: Annotated[bool, typer.Option("--whole/--part", help="Complete a modelled half or quarter.")] = True,
    lines: Annotated[bool, typer.Option("--lines/--no-lines", help="Draw the edges of the elements.")] = True,
    unit: Annotated[str, typer.Option(help="Unit of the field, for the scale: a file of fields has none.")] = "",
    png: Annotated[
        Path | None, typer.Option(metavar="OUT.png", help="Write a picture instead of opening a window.")
    ] = None,
    debug: Debug = False,
) -> None:
    """Show the deformed sheet of a run between its tools, coloured by a field.

    Needs PyVista: `pip install "umform[view]"`.
    """
    _check_picture(png)
    file = file_of_fields(file)
    from umform.io.vtkhdf_reader import frames_in
    from umform.report.looks import UNKNOWN, look_of
    from umform.report.rendering import Panel, Rendering, scaled, write_picture
    from umform.report.skin import skin_of
    from umform.report.stored_scene import read_frame

    scene = Rendering("umform view", off_screen=png is not None)
    _check_frame(frame, frames_in(file))
    part, surfaces = read_frame(file, frame, whole=whole)
    name = _chosen(part, field)
    look = look_of(name)
    skin = skin_of(part, name, factor=look.factor)
    scale = scaled(skin, f"{look.words}, {unit}" if unit else look.label(UNKNOWN))
    scene.add_sheet(skin, scale, lines=lines and len(part.cells) < _MANY)
    for surface in surfaces.values() if tools else ():
        scene.add_tool(surface)
    if rolling and _ROLLING in part.cellwise:
        scene.add_rolling(skin, part.cellwise[_ROLLING])
    if png is None:
        scene.show(f"umform: {file.name}")
        return
    write_picture(png, [Panel(scene.image(), scale)])
    typer.echo(f"Written to {png}")


def _check_picture(png: Path | None) -> None:
    """Refuse an invalid picture before slow imports."""
    from umform.errors import InvalidValue

    if png is not None and png.suffix != ".png":
        raise InvalidValue("a picture of the shape is a PNG", where="--png", value=str(png), remedy="end it in .png")


def _check_frame(frame: int, count: int) -> None:
    """Refuse a frame that the file does not have."""
    from umform.errors import InvalidValue

    if not -count <= frame < count:
        raise InvalidValue(
            "the file has no such frame",
            where="--frame",
            value=frame,
            cause="frames count from 0",
            remedy=f"0 to {count - 1}, or -1 for the last",
        )


def _chosen(part: Part, field: str | None) -> str:
    """The field to colour by: the requested one, if it can be drawn."""
    from umform.errors import InvalidValue

    drawable = [*part.nodal, *(name for name, values in part.cellwise.items() if values.ndim == 1)]
    if field is None:
        return next(name for name in (*_FAVOURITES, *drawable) if name in drawable)
    if field not in drawable:
        raise InvalidValue(
            "a tensor has no one value to colour by" if field in part.tensors else "the file has no such field",
            where="--field",
            value=field,
            remedy="one of " + ", ".join(sorted(drawable)),
        )
    return field
