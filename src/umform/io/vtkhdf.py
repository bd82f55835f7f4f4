"""Results over time as one VTKHDF file, for ParaView, PyVista and every other reader of VTK (9.3 and later).

The mesh is stored once; a step adds its time and its fields. The layout is that of a temporal
``UnstructuredGrid`` in version 2.0 of the VTKHDF specification: the fields of all steps lie one after the
other, and ``Steps`` says where those of each step begin, which for the mesh is always 0. The degrees of
Lagrange cells belong to the mesh; that they are the active attribute of this name is version 2.6.
"""

from __future__ import annotations

import io
import math
import os
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import Any, Self

import h5py
import numpy as np
from numpy.typing import ArrayLike

from umform.errors import FileProblem, InvalidValue
from umform.io.atomic import PendingFile, UntilDiskFull, write_problem
from umform.io.cells import cell_type, to_vtk
from umform.io.checks import Fields, FloatArray, IntArray, field_arrays

VERSION = (2, 0)
VERSION_OF_ATTRIBUTES = (2, 6)
DEGREES = "HigherOrderDegrees"
SMALL_CHUNK = 256
#: Bytes of steps per write for which its cost is small relative to that of compression.
BUFFER = 4_000_000
COMPRESSION = {"compression": "gzip", "compression_opts": 4, "shuffle": True}
#: Bytes of a chunk up to which compression takes more time than the space is worth.
SMALL = 2048
MESH_OFFSETS = ("PartOffsets", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets")


class VtkHdfSeries:
    """A VTKHDF file with one mesh and any number of steps, to be used in a ``with`` block.

    The steps go to a temporary file beside `path`, which takes the name `path` at the end of the block. This
    also happens when the block ends with an exception: the file then holds the steps appended before it, so
    that the last converged state survives. A block without any step leaves no new file, and an existing one
    as it was. The temporary file is flushed after each write: should the process be killed, it can still be
    read. Should the disk be full, the series ends with the last write that fitted.

    Each write has a fixed cost, since each field and its offsets are separate data sets. With `buffer` steps are
    collected up to that number of bytes: suitable for steps that are all in memory anyway.

    Points are in the reference position. A point field ``displacement`` of shape (n, 3) is what ParaView's
    *Warp By Vector* and PyVista's ``warp_by_vector`` take. A symmetric tensor is a field with six components
    in the order 11 22 33 12 23 13, which is also VTK's.

    Cells ``hex18`` are stored as VTK cells with 27 nodes, and their point fields with the means in the middle
    layer; both are exact, see `umform.io.cells`. The points of the mesh keep their numbers. With `lagrange`
    the cells keep their 18 nodes and the file has no points but those of the mesh: two thirds of the points
    for one layer of cells. VTK before 9.7 misreads such cells, and may crash over them.

    Parameters
    ----------
    path : str or os.PathLike
        The file to write; readers recognise it by the suffix ``.vtkhdf``.
    points : array_like of float, shape (n, 3)
        Reference positions of the points.
    cells : str
        Type of all the cells, ``"hex8"`` or ``"hex18"``.
    connectivity : array_like of int, shape (m, k)
        The points of each cell in the order of umform.
    lagrange : bool, optional
        Whether to store ``hex18`` as ``VTK_LAGRANGE_HEXAHEDRON`` of the degrees (2, 2, 1), for VTK 9.7 and
        later; cells ``hex8`` are the same either way.
    buffer : int, optional
        Bytes of steps that are written at a time; by default each step is written when it is appended. Arrays that are
        buffered are not copied: do not change them until the end of the block.

    Raises
    ------
    WrongCellType
        There is no such cell type.
    InvalidValue
        The shapes do not fit, or a cell names a point that does not exist.
    NotFinite
        A coordinate is NaN or infinite.
    FileProblem
        On entering or leaving the block: the file cannot be written.

    Notes
    -----
    In PyVista, step k is ``reader = pyvista.get_reader(path); reader.reader.SetStep(k); reader.read()``.

    Examples
    --------
    >>> with VtkHdfSeries("bending.vtkhdf", X, "hex8", cells) as series:  # doctest: +SKIP
    ...     series.append(0.0, {"displacement": u}, {"eqps": eqps})
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        points: ArrayLike,
        cells: str,
        connectivity: ArrayLike,
        *,
        lagrange: bool = False,
        buffer: int = 0,
    ) -> None:
        self._grid = to_vtk(cell_type(cells, lagrange=lagrange), points, connectivity)
        self._target = PendingFile(path)
        self._raw: io.FileIO
        self._file: Any = None
        self._times: list[float] = []
        self._written = 0  # steps in the file
        self._waiting: list[dict[str, FloatArray]] = []  # their fields, buffered
        self._buffer = buffer
        self._shapes: dict[str, tuple[int, ...]] = {}
        self._mesh_offsets: tuple[str, ...] = MESH_OFFSETS

    def __enter__(self) -> Self:
        self._raw = UntilDiskFull(self._target.__enter__(), "wb+")
        try:
            self._file = h5py.File(self._raw, "w", rdcc_nbytes=0)  # no cache: a failed write is detected immediately
            self._write_mesh()
        except OSError as error:
            self._close()
            self._target.discard()
            raise write_problem(self._target.path, error) from error
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            self._write_waiting()
        finally:
            self._end()

    def _end(self) -> None:
        """Close the temporary file and give it its name, or remove it if there is no step in it."""
        try:
            self._close()
            if self._written:
                self._target.commit()
            else:
                self._target.discard()
        except (OSError, RuntimeError) as problem:
            raise FileProblem(
                "the results could not be given their name",
                where=str(self._target.path),
                cause=str(problem),
                remedy=f"what was written is in {self._target.temporary}; rename it",
            ) from problem

    @property
    def times(self) -> tuple[float, ...]:
        """Times of the steps appended so far."""
        return tuple(self._times)

    def append(self, time: float, point_data: Fields | None = None, cell_data: Fields | None = None) -> None:
        """Add a step.

        The first step fixes the names and the numbers of components of the fields. A step that is refused
        leaves the file as it was.

        Parameters
        ----------
        time : float
            Time (load parameter), greater than that of the step before.
        point_data : mapping of str to array_like of float, shape (n,) or (n, c), optional
            Fields at the points, such as ``displacement``.
        cell_data : mapping of str to array_like of float, shape (m,) or (m, c), optional
            Fields in the cells. NaN stands for "no value", here and at the points.

        Raises
        ------
        InvalidValue
            The time does not increase, a field has a wrong shape or name, the fields differ from those of the
            first step, or the series is not open. In the cells the name ``HigherOrderDegrees`` is VTK's own.
        FileProblem
            The step cannot be written, or a buffered one.
        """
        if self._file is None:
            raise InvalidValue(
                "this series is not open",
                where=str(self._target.path),
                cause="the block has ended, or a step could not be written",
                remedy="append within `with VtkHdfSeries(...) as series:`",
            )
        time = float(time)
        if not math.isfinite(time) or (self._times and time <= self._times[-1]):
            raise InvalidValue(
                "times must be finite and increase from step to step",
                where=f"step {len(self._times)}",
                value=time,
                cause=f"the step before has the time {self._times[-1]!r}" if self._times else "",
                remedy="number the steps if the load parameter goes up and down",
            )
        grid = self._grid
        n, m = len(grid.points) - len(grid.pairs), len(grid.connectivity)
        fields = {f"PointData/{name}": grid.complete(a) for name, a in field_arrays(point_data, n, "point").items()}
        fields |= {f"CellData/{name}": a for name, a in field_arrays(cell_data, m, "cell").items()}
        if f"CellData/{DEGREES}" in fields:
            raise InvalidValue(
                "VTK takes a field of this name for the degrees of the cells",
                where="fields",
                value=DEGREES,
                cause="a name that VTK reserves",
                remedy="another name",
            )
        self._check_fields({name: array.shape for name, array in fields.items()})
        self._times.append(time)
        self._waiting.append(fields)
        if len(self._waiting) * sum(array.nbytes for array in fields.values()) >= self._buffer:
            self._write_waiting()

    def attach(self, name: str, arrays: Mapping[str, ArrayLike]) -> None:
        """Add arrays that are no fields, as a group beside that of VTK, which its readers skip.

        Parameters
        ----------
        name : str
            Path of the group in the file.
        arrays : mapping of str to array_like
            The arrays by their names.

        Raises
        ------
        FileProblem
            They cannot be written.
        """
        try:
            group = self._file.create_group(name)
            for key, values in arrays.items():
                array = np.asarray(values)
                group.create_dataset(key, data=array, **(COMPRESSION if array.nbytes > SMALL else {}))
        except OSError as error:
            raise write_problem(self._target.path, error) from error

    def _close(self) -> None:
        """Close the temporary file; the series takes no more steps."""
        file, self._file = self._file, None
        if file is not None:
            file.close()
        self._raw.close()

    def _check_fields(self, shapes: dict[str, tuple[int, ...]]) -> None:
        """Let the first step fix the fields and refuse later ones that differ."""
        if not self._times:
            self._shapes = shapes
        elif shapes != self._shapes:
            differing = {name for name, _ in shapes.items() ^ self._shapes.items()}
            raise InvalidValue(
                "the fields of a step differ from those of the first step",
                where=f"step {len(self._times)}",
                value=", ".join(sorted(differing)),
                remedy="append the same names and numbers of components in every step",
            )

    def _write_mesh(self) -> None:
        """Write all that does not change from step to step."""
        grid = self._grid
        m, k = grid.connectivity.shape
        root = self._file.create_group("VTKHDF")
        degrees = grid.kind.degrees
        root.attrs["Version"] = np.array(VERSION_OF_ATTRIBUTES if degrees else VERSION, dtype=np.int64)
        root.attrs["Type"] = np.bytes_("UnstructuredGrid")
        for name, count in (
            ("NumberOfPoints", len(grid.points)),
            ("NumberOfCells", m),
            ("NumberOfConnectivityIds", m * k),
        ):
            root[name] = np.array([count], dtype=np.int64)
        for name, array in (
            ("Points", grid.points),
            ("Connectivity", grid.connectivity.ravel()),
            ("Offsets", k * np.arange(m + 1, dtype=np.int64)),
            ("Types", np.full(m, grid.kind.vtk_type, dtype=np.uint8)),
        ):
            root.create_dataset(name, data=array, **COMPRESSION)
        for name in ("PointData", "CellData", "Steps/PointDataOffsets", "Steps/CellDataOffsets"):
            root.create_group(name)
        root["Steps"].attrs["NSteps"] = np.int64(0)
        if degrees:
            rows = np.tile(np.array(degrees, dtype=np.float64), (m, 1))
            root.create_dataset(f"CellData/{DEGREES}", data=rows, **COMPRESSION).attrs["Attribute"] = np.bytes_(DEGREES)
            self._mesh_offsets = (*MESH_OFFSETS, f"CellDataOffsets/{DEGREES}")

    def _write_waiting(self) -> None:
        """Write the buffered steps; they are lost if the write fails."""
        steps, self._waiting = self._waiting, []
        if not steps:
            return
        try:
            self._write_steps(steps)
        except OSError as error:
            del self._times[self._written :]
            self._close()
            raise write_problem(self._target.path, error) from error
        self._written += len(steps)

    def _write_steps(self, steps: Sequence[dict[str, FloatArray]]) -> None:
        """Write the data of steps, each field at once, and then, last of all, count them."""
        before, count, root = self._written, len(steps), self._file["VTKHDF"]
        for name, (rows, *_) in self._shapes.items():
            kind, field = name.split("/")
            values = steps[0][name] if count == 1 else np.concatenate([step[name] for step in steps])
            _put(root, name, before * rows, values, rows if rows > 1 else SMALL_CHUNK)
            _put(root, f"Steps/{kind}Offsets/{field}", before, rows * np.arange(before, before + count))
        for name in self._mesh_offsets:
            _put(root, f"Steps/{name}", before, np.zeros(count, dtype=np.int64))
        _put(root, "Steps/NumberOfParts", before, np.ones(count, dtype=np.int64))
        _put(root, "Steps/Values", before, np.array(self._times[before:]))
        root["Steps"].attrs["NSteps"] = np.int64(before + count)
        self._file.flush()


def _put(root: Any, name: str, start: int, rows: FloatArray | IntArray, chunk: int = SMALL_CHUNK) -> None:
    """Write rows from `start` on, in a dataset created at need.

    The step of a field is one chunk, so that it is compressed and read as a whole; a small one is not compressed.
    """
    if name in root:
        data = root[name]
        data.resize(start + len(rows), axis=0)
        data[start:] = rows
    else:
        chunks = (chunk, *rows.shape[1:])
        packed = COMPRESSION if math.prod(chunks) * rows.itemsize > SMALL else {}
        root.create_dataset(name, data=rows, maxshape=(None, *rows.shape[1:]), chunks=chunks, **packed)
