"""``umform view``: the deformed sheet of a file of fields, in a window or as a picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.root import Debug, app

if TYPE_CHECKING:
    from umform.report.skin import Part

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
    file = _file_of(file)
    _check_names(file, png)
    from umform.report.rendering import Panel, Rendering, scaled, write_picture
    from umform.report.skin import skin_of
    from umform.report.stored_scene import frames_in, read_frame

    scene = Rendering("umform view", off_screen=png is not None)
    _check_frame(frame, frames_in(file))
    part, surfaces = read_frame(file, frame, whole=whole)
    name = _chosen(part, field)
    skin = skin_of(part, name)
    scale = scaled(skin, name.replace("_", " ") + (unit and f", {unit}"))
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


def _file_of(path: Path) -> Path:
    """The file, or the file of fields in a folder that was written last."""
    from umform.errors import FileProblem

    if not path.is_dir():
        return path
    files = sorted(path.glob("*.vtkhdf"), key=lambda file: (file.stat().st_mtime_ns, file.name))
    if not files:
        raise FileProblem(
            "this is a folder without a file of fields",
            where=str(path),
            cause="no name in it ends in .vtkhdf",
            remedy="`umform run` writes fields.vtkhdf, unless [output] says no; bends and draws write theirs",
        )
    *others, last = files
    if others:
        names = ", ".join(file.name for file in others)
        typer.echo(f"umform: {last.name}, the last one in {path}; it also has {names}", err=True)
    return last


def _check_names(file: Path, png: Path | None) -> None:
    """Refuse invalid files before slow imports."""
    from umform.errors import FileProblem, InvalidValue

    if png is not None and png.suffix != ".png":
        raise InvalidValue("a picture of the shape is a PNG", where="--png", value=str(png), remedy="end it in .png")
    if not file.is_file():
        raise FileProblem(
            "there is no such file", where=str(file), remedy="result.write('run.vtkhdf') and `umform run` write one"
        )
    import h5py

    if not h5py.is_hdf5(file):
        raise FileProblem("this is no file of fields", where=str(file), remedy="give a file that ends in .vtkhdf")
    with h5py.File(file) as content:
        if "VTKHDF" not in content:
            raise FileProblem(
                "this HDF5 file holds no VTKHDF", where=str(file), remedy="give a file that ends in .vtkhdf"
            )


def _check_frame(frame: int, count: int) -> None:
    """Refuse a frame that the file does not have."""
    from umform.errors import InvalidValue

    if not -count <= frame < count:
        raise InvalidValue(
            "the file has no such frame", where="--frame", value=frame, remedy=f"0 to {count - 1}, or -1 for the last"
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
