"""``umform view``: the deformed sheet of a file of fields, in a window or as a picture."""

from __future__ import annotations

import importlib
import os
import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from umform.cli.root import Debug, app

#: Default fields: the first available one is shown.
_FAVOURITES = ("plastic_strain_max", "thickness_change", "displacement")

#: Field of the rolling direction; its lines are drawn on faces parallel to it, with this length relative to the face.
_ROLLING = "rolling"
_LYING, _LINE = 0.9, 0.3

_BAR = {
    "vertical": True,
    "position_x": 0.86,
    "position_y": 0.5,
    "width": 0.05,
    "height": 0.4,
    "color": "#222222",
    "title_font_size": 20,
    "label_font_size": 18,
    "fmt": "%.3g",
}


@app.command()
def view(
    file: Annotated[Path, typer.Argument(metavar="FILE.vtkhdf", help="Fields of a run, or the folder of a run.")],
    field: Annotated[str | None, typer.Option(help="Field to colour by; the length of a vector.")] = None,
    frame: Annotated[int, typer.Option(help="Frame: 0 is the first, -1 the last.")] = -1,
    rolling: Annotated[
        bool, typer.Option("--rolling/--no-rolling", help="Draw the rolling direction, if the file has it.")
    ] = True,
    png: Annotated[
        Path | None, typer.Option(metavar="OUT.png", help="Write a picture instead of opening a window.")
    ] = None,
    debug: Debug = False,
) -> None:
    """Show the deformed sheet of a run, coloured by a field.

    Needs PyVista: `pip install "umform[view]"`.
    """
    file = _file_of(file)
    _check_names(file, png)
    pv = _pyvista(off_screen=png is not None)
    grid = _read(pv, file, frame)
    name = _chosen(grid, field)
    plotter = pv.Plotter(off_screen=png is not None, window_size=(1200, 800))
    plotter.set_background("white")
    shape = grid.warp_by_vector("displacement") if "displacement" in grid.point_data else grid
    plotter.add_mesh(
        shape,
        scalars=name,
        cmap="viridis",
        show_edges=grid.n_cells < 20000,
        edge_color="#606a74",
        ambient=0.2,
        scalar_bar_args=_BAR | {"title": name.replace("_", " ") + "\n"},
    )
    if rolling and _ROLLING in grid.cell_data:
        _add_rolling(pv, plotter, shape, switch=png is None)
    plotter.view_vector((-0.55, -1.0, 0.5), viewup=(0.0, 0.0, 1.0))
    if png is None:
        plotter.show(title=f"umform: {file.name}")
        return
    from umform.io.atomic import PendingFile

    with PendingFile(png) as temporary:
        plotter.screenshot(temporary)
    plotter.close()
    typer.echo(f"Written to {png}")


def _add_rolling(pv: Any, plotter: Any, shape: Any, *, switch: bool) -> None:
    """Add a line along the rolling direction on each outer face; a button in the window switches them."""
    import warnings

    import numpy as np

    with warnings.catch_warnings():  # newer versions require an argument that older ones do not have
        warnings.simplefilter("ignore")
        faces = shape.extract_surface().compute_cell_sizes(length=False, volume=False)
    faces = faces.compute_normals(point_normals=False, auto_orient_normals=True)
    along, normal = faces.cell_data[_ROLLING], faces.cell_data["Normals"]
    flat = along - (along * normal).sum(axis=1, keepdims=True) * normal
    length = np.linalg.norm(flat, axis=1)
    seen = length > _LYING
    arm = _LINE * np.sqrt(faces.cell_data["Area"])[seen, None] * flat[seen] / length[seen, None]
    middle = faces.cell_centers().points[seen] + 0.02 * np.sqrt(faces.cell_data["Area"])[seen, None] * normal[seen]
    ends = np.stack([middle - arm, middle + arm], axis=1).reshape(-1, 3)
    lines = plotter.add_mesh(pv.line_segments_from_points(ends), color="#b3261e", line_width=2)
    if switch:
        plotter.add_checkbox_button_widget(lines.SetVisibility, value=True, size=24, color_on="#b3261e")
        plotter.add_text("rolling direction", position=(42, 10), font_size=9, color="#222222")


def _file_of(path: Path) -> Path:
    """The file, or the only file of fields in a folder."""
    from umform.errors import FileProblem

    if not path.is_dir():
        return path
    files = sorted(path.glob("*.vtkhdf"))
    if len(files) == 1:
        return files[0]
    raise FileProblem(
        "this is a folder with several files of fields" if files else "this is a folder without a file of fields",
        where=str(path),
        cause="it has " + ", ".join(file.name for file in files) if files else "no name in it ends in .vtkhdf",
        remedy=f"umform view {files[0]}" if files else "`umform run` writes fields.vtkhdf, unless [output] says no",
    )


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


def _pyvista(*, off_screen: bool) -> Any:
    """PyVista, or an error with the cause why it cannot be used."""
    from umform.errors import UmformError

    screen = sys.platform != "linux" or "DISPLAY" in os.environ or "WAYLAND_DISPLAY" in os.environ
    if not screen and not off_screen:
        raise UmformError(
            "there is no screen to open a window on",
            where="umform view",
            cause="neither DISPLAY nor WAYLAND_DISPLAY is set",
            remedy="--png picture.png writes a picture",
        )
    try:
        pv = importlib.import_module("pyvista")
        log = importlib.import_module("vtkmodules.vtkCommonCore").vtkLogger
    except ImportError as error:
        raise UmformError(
            "umform view needs PyVista",
            where="umform view",
            cause=str(error),
            remedy='pip install "umform[view]"; the page of result.report() needs a browser only',
        ) from error
    if not screen:  # VTK tries an X server first, and complains without one
        log.SetStderrVerbosity(log.VERBOSITY_ERROR)
    return pv


def _read(pv: Any, file: Path, frame: int) -> Any:
    """The cells of a frame with their fields."""
    from umform.errors import InvalidValue

    reader = pv.get_reader(file)
    reader.reader.UpdateInformation()
    count = reader.reader.GetNumberOfSteps() or 1
    if not -count <= frame < count:
        raise InvalidValue(
            "the file has no such frame", where="--frame", value=frame, remedy=f"0 to {count - 1}, or -1 for the last"
        )
    reader.reader.SetStep(frame % count)
    return reader.read()


def _chosen(grid: Any, field: str | None) -> str:
    """The field to colour by: the requested one, if it can be drawn."""
    from umform.errors import InvalidValue

    arrays = {**dict(grid.point_data), **dict(grid.cell_data)}
    drawable: list[str] = [name for name, values in arrays.items() if values.ndim == 1 or values.shape[1] == 3]
    if field is None:
        return next(name for name in (*_FAVOURITES, *drawable) if name in drawable)
    if field not in drawable:
        raise InvalidValue(
            "a tensor has no one value to colour by" if field in arrays else "the file has no such field",
            where="--field",
            value=field,
            remedy="one of " + ", ".join(sorted(drawable)),
        )
    return field
