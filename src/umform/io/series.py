"""Results over time for programs that do not read VTKHDF: ``.vtu``, ``.pvd`` and ``.xdmf``, through meshio.

Points are in the reference position and carry the field ``displacement``, as in VTKHDF. Cells ``hex18`` are
hexahedra with 27 nodes; see `umform.io.cells`.
"""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple
from xml.sax.saxutils import quoteattr

import h5py
import numpy as np
from meshio.xdmf import TimeSeriesWriter
from numpy.typing import NDArray

from umform.errors import FileProblem, InvalidValue
from umform.io.atomic import PendingFile, write_problem
from umform.io.cells import cell_type, to_vtk
from umform.io.checks import Fields, FloatArray, field_arrays
from umform.io.meshes import write_mesh_arrays
from umform.io.vtkhdf import COMPRESSION, SMALL
from umform.io.vtkhdf_reader import read_fields, read_vtkhdf

#: Suffixes, and what is written.
SERIES = {
    ".vtu": "the last state, for VTK, ParaView and meshio",
    ".pvd": "all states for ParaView: a list of .vtu files in a folder",
    ".xdmf": "all states for meshio, ParaView and others: XML, with numbers in HDF5",
}
#: Order of XDMF, 11 12 13 22 23 33, in components of a symmetric tensor of umform, 11 22 33 12 23 13.
_XDMF_ORDER = [0, 3, 5, 1, 4, 2]
_FRAME = re.compile(r"\d{4,}\.vtu")


class Step(NamedTuple):
    """Fields of a state.

    Attributes
    ----------
    time : float
        Time.
    points, cells : mapping of str to array_like of float
        Fields at points, shape (n,) or (n, c), and in cells, (m,) or (m, c).
    """

    time: float
    points: Fields
    cells: Fields


class Grid(NamedTuple):
    """A mesh with one cell type.

    Attributes
    ----------
    points : ndarray of float, shape (n, 3)
        Reference positions.
    cells : str
        ``"hex8"`` or ``"hex18"``.
    connectivity : ndarray of int, shape (m, k)
        The points of each cell in the order of umform.
    """

    points: FloatArray
    cells: str
    connectivity: NDArray[np.integer[Any]]


def write_series(path: str | os.PathLike[str], grid: Grid, steps: Sequence[Step]) -> Path:
    """Write states of a mesh, in the format of the suffix.

    Files are complete before they get their names. Beside ``NAME.pvd`` there is the folder ``NAME-frames`` with a file
    for each state; other files in it stay. Beside ``NAME.xdmf`` there is ``NAME.xdmf.h5``.

    Parameters
    ----------
    path : str or os.PathLike
        The file, ending in one of `SERIES`.
    grid : Grid
        The mesh.
    steps : sequence of Step
        The states in the order of their times; ``.vtu`` has the last one.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValue
        The suffix is another one, there is no state, or a field does not fit.
    FileProblem
        A file cannot be written.
    """
    place = Path(path)
    if place.suffix not in SERIES:
        raise InvalidValue(
            "states are not written in this format", where=str(place), value=place.suffix, remedy=" or ".join(SERIES)
        )
    if not steps:
        raise InvalidValue(
            "there is no state to write",
            where=str(place),
            cause="a run that kept no frames",
            remedy="solve(..., frames=60)",
        )
    if place.suffix == ".vtu":
        _write_state(place, grid, steps[-1])
    elif place.suffix == ".pvd":
        _write_pvd(place, grid, steps)
    else:
        _write_xdmf(place, grid, steps)
    return place


def convert(fields: str | os.PathLike[str], path: str | os.PathLike[str]) -> int:
    """Write the states of a VTKHDF file of umform in another format.

    Parameters
    ----------
    fields : str or os.PathLike
        The file, with cells of one type.
    path : str or os.PathLike
        The new file, ending in one of `SERIES`.

    Returns
    -------
    int
        Number of states written.
    """
    X, found = read_vtkhdf(fields)
    (name, cells), *others = found.items()
    if others:
        raise InvalidValue(
            "only files with one cell type are converted",
            where=os.fspath(fields),
            value=list(found),
            cause="a file of another program",
            remedy="the file of a run",
        )
    n = int(cells.max()) + 1  # without the middle layers, which are behind all other points
    steps = []
    with h5py.File(fields, "r") as file:
        root = file["VTKHDF"]
        count = len(root["Steps/Values"])
        for frame in range(count - 1 if Path(path).suffix == ".vtu" else 0, count):
            at_points, in_cells = read_fields(root, frame)
            at_points = {field: values[:n] for field, values in at_points.items()}
            steps.append(Step(float(root["Steps/Values"][frame]), at_points, in_cells))
    write_series(path, Grid(X[:n], name, cells), steps)
    return len(steps)


def _write_state(path: Path, grid: Grid, step: Step) -> None:
    write_mesh_arrays(path, grid.points, grid.cells, grid.connectivity, step.points, step.cells)


def _write_pvd(path: Path, grid: Grid, steps: Sequence[Step]) -> None:
    """The files of all states first, then the list."""
    folder = path.with_name(f"{path.stem}-frames")
    names = [f"{number:04d}.vtu" for number in range(len(steps))]
    with PendingFile(path) as temporary:  # a folder that does not exist is reported with the name of the list
        try:
            with tempfile.TemporaryDirectory(prefix=f".{path.stem}.", dir=path.parent) as waiting:
                for name, step in zip(names, steps, strict=True):
                    _write_state(Path(waiting, name), grid, step)
                folder.mkdir(exist_ok=True)
                for name in names:
                    Path(waiting, name).replace(folder / name)
            for old in folder.iterdir():
                if _FRAME.fullmatch(old.name) and old.name not in names:
                    old.unlink()
        except FileProblem:
            raise
        except OSError as error:
            raise write_problem(folder, error) from error
        rows = (
            f'    <DataSet timestep={quoteattr(repr(float(step.time)))} part="0" '
            f"file={quoteattr(f'{folder.name}/{name}')}/>\n"
            for name, step in zip(names, steps, strict=True)
        )
        temporary.write_text(
            '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n'
            f"  <Collection>\n{''.join(rows)}  </Collection>\n</VTKFile>\n",
            encoding="utf-8",
        )


class _Xdmf(TimeSeriesWriter):  # type: ignore[misc]
    """The writer of meshio, whose HDF5 file is always in the working directory and without compression."""

    def __init__(self, path: Path, numbers: Path, name: str) -> None:
        super().__init__(path)
        self.h5_filename = name
        self.h5_file = h5py.File(numbers, "w")

    def numpy_to_xml_string(self, data: Any) -> str:
        """Store an array; return where it is."""
        name = f"data{self.data_counter}"
        self.data_counter += 1
        self.h5_file.create_dataset(name, data=data, **(COMPRESSION if data.nbytes > SMALL else {}))
        return f"{self.h5_filename}:/{name}"


def _write_xdmf(path: Path, grid: Grid, steps: Sequence[Step]) -> None:
    """The numbers first, then the XML."""
    vtk = to_vtk(cell_type(grid.cells), grid.points, grid.connectivity)
    numbers = path.with_name(f"{path.name}.h5")
    with PendingFile(path) as xml, PendingFile(numbers) as waiting:
        writer = _Xdmf(xml, waiting, numbers.name)
        try:
            writer.write_points_cells(vtk.points, [(vtk.kind.meshio_type, vtk.connectivity)])
            for step in steps:
                at_points = field_arrays(step.points, len(grid.points), "point").items()
                in_cells = field_arrays(step.cells, len(grid.connectivity), "cell").items()
                writer.write_data(
                    float(step.time),
                    {name: _in_order(vtk.complete(values)) for name, values in at_points},
                    {name: [_in_order(values)] for name, values in in_cells},
                )
        finally:
            writer.__exit__()


def _in_order(values: FloatArray) -> FloatArray:
    """Components of a field in the order of XDMF."""
    return np.ascontiguousarray(values[:, _XDMF_ORDER]) if values.ndim == 2 and values.shape[1] == 6 else values
