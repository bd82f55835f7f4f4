"""Read meshes from files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from umform.errors import WrongCellType
from umform.io.checks import check_points
from umform.mesh.mesh import Floats, Mesh
from umform.mesh.neighbours import Whole, outer_faces
from umform.mesh.orient import orient
from umform.mesh.thicken import thicken
from umform.spec import check_arguments, takes


def read(path: str | Path, through: str | ArrayLike | None = None) -> Mesh:
    """Read a mesh of hexahedra from any file that meshio reads, or from a VTKHDF file written by umform.

    Named groups of nodes and of cells become node sets. The outer lower and upper faces become the sets ``lower`` and
    ``upper``; choose others by a predicate, for instance ``lambda x, y, z: x < 1e-9``.

    Parameters
    ----------
    path : str or Path
        The file.
    through : str or array_like, optional
        Direction through the thickness, to the upper face: ``thinnest``, an axis, a vector, or the name of a set with
        all nodes of the lower face. Without it the first nodes of each cell are those of its lower face.

    Returns
    -------
    Mesh
        With face sets ``lower`` and ``upper``.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    MeshError
        If its cells make no sheet.
    """
    check_arguments(read, path=path)
    from umform.io import meshes  # meshio is slow to import

    if through is None or Path(path).suffix.lower() in meshes.VTKHDF_SUFFIXES:
        points, cells, sets, groups = meshes.read_mesh_arrays(path)
        name, connectivity = next(iter(cells.items()))
        if through is None:
            for group, members in groups.items():
                nodes = np.unique(connectivity[members.get(name, [])])
                sets[group] = np.union1d(sets.get(group, nodes), nodes)
            return Mesh(points, cells, sets, outer_faces(connectivity))
        raise WrongCellType(
            "a file of umform has its cells turned already",
            where=str(path),
            value=name,
            remedy="leave out the direction through the thickness",
        )
    raw = meshes.read_by_meshio(Path(path))
    hexahedra = _cells(raw, path, ("hexahedron", "hexahedron20", "hexahedron27"), 3, "hexahedra with 8, 20 or 27 nodes")
    return orient(_three(raw.points, path), hexahedra, _sets(raw, 3), through=through)


@takes(thicken, "points", "quads", "thickness", "sets")
def read_shell(path: str | Path, thickness: float | ArrayLike, **how: Any) -> Mesh:
    """Read a surface of quadrilaterals from any file that meshio reads, and thicken it along its normals.

    Named groups of nodes, of quadrilaterals and of lines become node sets of both faces.

    Parameters
    ----------
    path : str or Path
        The file.
    thickness : float or array_like, shape (n,)
        As for :func:`thicken`.
    **how
        Surface and kink, as for :func:`thicken`.

    Returns
    -------
    Mesh
        With face sets ``lower`` and ``upper``.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    MeshError
        If its cells make no sheet.
    """
    from umform.io import meshes  # meshio is slow to import

    raw = meshes.read_by_meshio(Path(path))
    quads = _cells(raw, path, ("quad", "quad8", "quad9"), 2, "quadrilaterals with 4, 8 or 9 nodes")
    return thicken(_three(raw.points, path), quads, thickness, _sets(raw, 2), **how)


def _cells(raw: Any, path: str | Path, known: tuple[str, ...], dimension: int, wanted: str) -> Whole:
    """All cells of the highest dimension of a file, which must be of one supported type."""
    found = {block.type: 0 for block in raw.cells if block.dim >= dimension}
    for block in raw.cells:
        if block.type in found:
            found[block.type] += len(block.data)
    if len(found) != 1 or next(iter(found)) not in known:
        raise WrongCellType(
            f"the file must have {wanted}, of one type",
            where=str(path),
            value=", ".join(f"{count} {name}" for name, count in found.items()) or "none of that dimension",
            cause="a mesh with triangles or tetrahedra, or elements of several orders",
            remedy="recombine triangles into quadrilaterals, sweep the sheet, and mesh with one order",
        )
    kind = next(iter(found))
    return np.concatenate([np.asarray(block.data, dtype=np.int64) for block in raw.cells if block.type == kind])


def _sets(raw: Any, dimension: int) -> dict[str, Whole]:
    """Node sets of a file: its sets of nodes, and the nodes of its groups of cells up to a dimension."""
    from umform.io import meshes  # meshio is slow to import

    sets: dict[str, Whole] = {name: np.unique(np.asarray(ids, dtype=np.int64)) for name, ids in raw.point_sets.items()}
    for name, members in meshes.cell_groups(raw).items():
        for block, ids in zip(raw.cells, members):
            if ids is not None and len(ids) and block.dim <= dimension:
                nodes = block.data[np.asarray(ids, dtype=np.int64)]
                sets[name] = np.union1d(sets.get(name, np.empty(0, dtype=np.int64)), nodes)
    return sets


def _three(points: Any, path: str | Path) -> Floats:
    """Positions with three coordinates, all of them numbers: a flat mesh lies at z = 0."""
    X = np.asarray(points, dtype=float)
    X = X if X.shape[1] == 3 else np.column_stack([X, np.zeros((len(X), 3 - X.shape[1]))])
    check_points(X, str(path))
    return X
