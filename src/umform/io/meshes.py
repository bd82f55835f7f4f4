"""Read and write meshes in the formats of other programs."""

from __future__ import annotations

import contextlib
import io
import logging
import os
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import meshio
import numpy as np
from numpy.typing import ArrayLike

from umform.errors import FileProblem, WrongCellType
from umform.io.abaqus import checked_abaqus
from umform.io.atomic import PendingFile
from umform.io.cells import CELL_TYPES, cell_type, from_vtk, to_vtk
from umform.io.checks import Fields, FloatArray, IntArray, check_ids, check_points, field_arrays
from umform.io.vtkhdf_reader import read_vtkhdf

BY_MESHIO = {kind.meshio_type: kind for kind in CELL_TYPES.values()}
VTKHDF_SUFFIXES = (".vtkhdf", ".hdf")
WRITERS = {".vtu": "vtu", ".vtk": "vtk", ".msh": "gmsh"}

#: What meshio reads of Gmsh: not format 4.0, nor elements without a physical group beside others in 4.1.
_OF_GMSH = "; save it from Gmsh in format 2, or without 'Save all elements'"

_log = logging.getLogger(__name__)


class MeshArrays(NamedTuple):
    """Content of a mesh file, in the terms of umform.

    Attributes
    ----------
    points : ndarray of float, shape (n, 3)
        Positions, in the units of the file.
    cells : dict of str to ndarray of int, shape (m, k)
        For each cell type (``"hex8"``, ``"hex18"``) the points of its cells, in the order of umform.
    point_sets : dict of str to ndarray of int
        Points by the name of their set, sorted.
    cell_sets : dict of str to dict of str to ndarray of int
        Cells by the name of their set and by their cell type, sorted.
    """

    points: FloatArray
    cells: dict[str, IntArray]
    point_sets: dict[str, IntArray]
    cell_sets: dict[str, dict[str, IntArray]]


def read_mesh_arrays(path: str | os.PathLike[str]) -> MeshArrays:
    """Read the hexahedra of a mesh file, with the named sets.

    VTKHDF files are read as `umform.io.VtkHdfSeries` writes them; all other formats (``.msh`` of Gmsh,
    ``.inp`` of Abaqus, ``.bdf`` of Nastran, ``.vtu``, ``.vtk``, ...) are read through meshio.

    Hexahedra with 8 nodes become ``hex8`` as they are. Hexahedra with 27 nodes become ``hex18``, if their edges from
    the lower face (nodes 1-4) to the upper one are straight, so that removing the middle layer loses nothing. Points
    that no hexahedron uses, such as centres of arcs, are removed; the others are renumbered in their order.

    Sets of points (``NSET``) and of hexahedra (``ELSET``, physical volumes of Gmsh) keep their names. Sets of cells of
    lower dimension (physical surfaces, curves and points of Gmsh) become sets of their points. A set that becomes empty
    has no entry.

    Parameters
    ----------
    path : str or os.PathLike
        The file to read.

    Returns
    -------
    MeshArrays
        Points, cells and sets.

    Raises
    ------
    WrongCellType
        There are solid cells that are not such hexahedra, or no hexahedra at all.
    NotFinite
        A coordinate is NaN or infinite.
    FileProblem
        The file cannot be read, or not unambiguously.

    Notes
    -----
    While meshio reads, standard output and standard error of the process are captured; its messages go to the logger
    ``umform.io.meshes``.
    """
    place = Path(path)
    point_sets: dict[str, IntArray] = {}
    cell_sets: dict[str, dict[str, IntArray]] = {}
    if place.suffix.lower() in VTKHDF_SUFFIXES:
        X, cells = read_vtkhdf(place)
    else:
        mesh = read_by_meshio(place)
        X, cells = _hexahedra(mesh, place)
        point_sets, cell_sets = _sets(mesh)

    used = np.unique(np.concatenate([ids.ravel() for ids in cells.values()]))
    number = np.full(len(X), -1)
    number[used] = np.arange(len(used))
    kept = {name: number[np.intersect1d(ids, used)] for name, ids in point_sets.items()}
    return MeshArrays(
        X[used],
        {name: number[ids] for name, ids in cells.items()},
        {name: ids for name, ids in kept.items() if ids.size},
        cell_sets,
    )


def write_mesh_arrays(
    path: str | os.PathLike[str],
    points: ArrayLike,
    cells: str,
    connectivity: ArrayLike,
    point_data: Fields | None = None,
    cell_data: Fields | None = None,
) -> None:
    """Write a mesh for other programs, through meshio.

    Cells ``hex18`` are written as hexahedra with 27 nodes; see `umform.io.cells`.

    Parameters
    ----------
    path : str or os.PathLike
        The file to write: ``.vtu``, ``.vtk`` or ``.msh`` (Gmsh 4.1).
    points : array_like of float, shape (n, 3)
        Positions.
    cells : str
        Type of all the cells, ``"hex8"`` or ``"hex18"``.
    connectivity : array_like of int, shape (m, k)
        The points of each cell in the order of umform.
    point_data : mapping of str to array_like of float, shape (n,) or (n, c), optional
        Fields at the points.
    cell_data : mapping of str to array_like of float, shape (m,) or (m, c), optional
        Fields in the cells.

    Raises
    ------
    WrongCellType
        There is no such cell type.
    InvalidValue
        The shapes do not fit, or a cell names a point that does not exist.
    NotFinite
        A coordinate is NaN or infinite.
    FileProblem
        The format is not one of these or cannot hold the fields, or the file cannot be written.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in WRITERS:
        raise FileProblem(
            "umform does not write meshes in this format",
            where=os.fspath(path),
            remedy=f"choose one of {', '.join(WRITERS)}, or VtkHdfSeries for .vtkhdf",
        )
    kind = cell_type(cells)
    grid = to_vtk(kind, points, connectivity)
    point_fields = field_arrays(point_data, len(grid.points) - len(grid.pairs), "point")
    cell_fields = field_arrays(cell_data, len(grid.connectivity), "cell")
    mesh = meshio.Mesh(
        grid.points,
        [(kind.meshio_type, grid.connectivity)],
        point_data={name: grid.complete(field) for name, field in point_fields.items()},
        cell_data={name: [field] for name, field in cell_fields.items()},
    )
    with PendingFile(path) as temporary, quiet():
        try:
            meshio.write(temporary, mesh, file_format=WRITERS[suffix])
        except meshio.WriteError as error:
            raise FileProblem(
                "the mesh cannot be written in this format",
                where=os.fspath(path),
                cause=str(error),
                remedy="write the fields with VtkHdfSeries, which has no such limits",
            ) from error


def read_by_meshio(path: Path) -> Any:
    """Read a file through meshio without console output; the result is a ``meshio.Mesh``.

    Raises
    ------
    FileProblem
        The file cannot be read, or not unambiguously.
    """
    from_gmsh = path.suffix.lower() == ".msh" and path.is_file()
    text = checked_abaqus(path) if path.suffix.lower() == ".inp" else None
    with quiet() as said:
        try:
            mesh = meshio.read(path) if text is None else meshio.read(io.StringIO(text), file_format="abaqus")
        except (Exception, SystemExit) as error:  # meshio raises arbitrary exceptions for a malformed file
            raise FileProblem(
                "the mesh file cannot be read",
                where=str(path),
                cause=" ".join(said.getvalue().split()) or f"{type(error).__name__}: {error}",
                remedy="check the path, the suffix and that another program can open the file" + _OF_GMSH * from_gmsh,
            ) from error
    # meshio keeps the number of the coordinate system of each Nastran point but does not transform the point
    if np.any(mesh.point_data.get("nastran:ref", 0)):
        raise FileProblem(
            "the points of this Nastran file are given in several coordinate systems",
            where=str(path),
            remedy="export the points in the basic coordinate system",
        )
    return mesh


@contextlib.contextmanager
def quiet() -> Iterator[io.StringIO]:
    """Keep meshio off the console: its output is collected and logged."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            yield said
        finally:
            if said.getvalue():
                _log.info(said.getvalue().strip())


def _hexahedra(mesh: Any, path: Path) -> tuple[FloatArray, dict[str, IntArray]]:
    """Return all the points of a mesh and its hexahedra, in the order of umform."""
    _check_types(mesh, path)
    X = np.ascontiguousarray(mesh.points, dtype=np.float64)
    check_points(X, str(path))
    cells: dict[str, IntArray] = {}
    for block in mesh.cells:
        ids = np.asarray(block.data, dtype=np.int64)
        check_ids(ids, len(X), str(path))
        if block.type in BY_MESHIO:
            name = BY_MESHIO[block.type].name
            cells[name] = np.vstack([cells[name], ids]) if name in cells else ids
    return X, {name: from_vtk(CELL_TYPES[name], X, ids) for name, ids in cells.items()}


def _check_types(mesh: Any, path: Path) -> None:
    """Reject a mesh without hexahedra or with other solids."""
    counts: dict[str, int] = {}
    for block in mesh.cells:
        counts[block.type] = counts.get(block.type, 0) + len(block.data)
    solids = {block.type for block in mesh.cells if block.dim == 3}
    if solids and solids <= BY_MESHIO.keys():
        return
    if not counts:
        raise WrongCellType(
            "the mesh file has no cells",
            where=str(path),
            cause="an empty file, another format than its ending says, or nodes without elements",
            remedy="write the elements too where the mesh is made",
        )
    raise WrongCellType(
        "umform needs hexahedra with 8 or 27 nodes and no other solids",
        where=str(path),
        value=", ".join(f"{count} {name}" for name, count in sorted(counts.items())),
        cause="" if solids else "the file holds a surface, no solids",
        remedy="umform.mesh.read_shell(path, thickness) thickens a mesh of quadrilaterals"
        if not solids
        else "mesh the mid-surface with quadrilaterals and thicken them: umform.mesh.read_shell(path, thickness)",
    )


def _sets(mesh: Any) -> tuple[dict[str, IntArray], dict[str, dict[str, IntArray]]]:
    """Collect the named sets: those of points and lower cells as points, those of hexahedra as cells."""
    point_sets = {name: np.unique(np.asarray(ids, dtype=np.int64)) for name, ids in mesh.point_sets.items()}
    cell_sets: dict[str, dict[str, IntArray]] = {}
    none = np.empty(0, dtype=np.int64)
    for name, members in cell_groups(mesh).items():
        before = dict.fromkeys(CELL_TYPES, 0)
        for block, ids in zip(mesh.cells, members):
            chosen = none if ids is None else np.asarray(ids, dtype=np.int64)
            if block.type in BY_MESHIO:
                cells = BY_MESHIO[block.type].name
                chosen = chosen + before[cells]
                before[cells] += len(block.data)
                if chosen.size:
                    of_name = cell_sets.setdefault(name, {})
                    of_name[cells] = np.union1d(of_name.get(cells, none), chosen)
            elif chosen.size:
                point_sets[name] = np.union1d(point_sets.get(name, none), block.data[chosen])
    return point_sets, cell_sets


def cell_groups(mesh: Any) -> dict[str, list[Any]]:
    """Members in each block of cells, or None, of each named group of cells of a ``meshio.Mesh``."""
    groups: dict[str, list[Any]] = {}
    tags = mesh.cell_data.get("gmsh:physical")
    if tags is not None:
        for name, (tag, dim) in mesh.field_data.items():
            groups[name] = [
                np.flatnonzero(block_tags == tag) if block.dim == dim else None
                for block, block_tags in zip(mesh.cells, tags)
            ]
    return groups | {name: ids for name, ids in mesh.cell_sets.items() if not name.startswith("gmsh:")}
