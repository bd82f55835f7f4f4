"""The mesh: points, cells, named sets of nodes and faces.

Cells are ``hex8`` (4 nodes on the lower face, then 4 on the upper one) and ``hex18`` (9 and 9: corners, mid-sides,
centre). Their six faces are called lower, upper, r0, r1, s0, s1: the natural coordinate that is constant there.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import EmptySet, InvalidValue, NotFinite, UnknownSet, WrongCellType
from umform.mesh.numbers import unique
from umform.mesh.quality import check_cells
from umform.spec.types import FARTHEST

Floats = NDArray[np.float64]
Ids = NDArray[np.int32]

#: Names of the faces of a cell, in the order of their numbers.
FACES = ("lower", "upper", "r0", "r1", "s0", "s1")

#: Natural coordinates (r, s) of the nodes of a face, corners first.
FACE_NODES = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)], dtype=float)

_LOOK = "look at the coordinates: comparisons of reals need a tolerance"
_OUTWARD_LOWER = {"hex8": [0, 3, 2, 1], "hex18": [0, 3, 2, 1, 7, 6, 5, 4, 8]}

#: Selection of nodes or faces: a name, a predicate of the coordinates x, y, z, or ids.
Selector = str | Callable[[Floats, Floats, Floats], ArrayLike] | ArrayLike


def nodes_of_faces(cell: str) -> list[list[int]]:
    """Local nodes of the six faces (unordered, except lower and upper)."""
    half = 4 if cell == "hex8" else 9
    plane = FACE_NODES[:half]
    sides = [np.flatnonzero(plane[:, axis] == value) for axis in (0, 1) for value in (-1.0, 1.0)]
    lateral = [[*side, *(side + half)] for side in sides]
    return [list(range(half)), list(range(half, 2 * half)), *[[int(n) for n in nodes] for nodes in lateral]]


@dataclass(frozen=True)
class Mesh:
    """Points and cells with named sets.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Reference positions.
    cells : mapping of str to array_like, shape (m, 8) or (m, 18)
        Exactly one cell type, ``hex8`` or ``hex18``: node ids of each cell.
    sets : mapping of str to array_like, optional
        Named sets of node ids.
    faces : mapping of str to array_like, shape (k, 2), optional
        Named sets of faces, each row (cell, number of the face in :data:`umform.mesh.FACES`).

    Raises
    ------
    NotFinite, WrongCellType, InvalidValue
        If the arrays are no valid mesh.
    InvertedElement, FoldedElement, WrongNodeOrder
        If the volume of a cell is not positive everywhere.

    Examples
    --------
    >>> import umform as uf
    >>> strip = uf.mesh.strip(length=10.0, width=1.0, thickness=0.2, cells=(8, 1))
    >>> len(strip.points), sorted(strip.faces)
    (36, ['lower', 'upper', 'x0', 'x1', 'y0', 'y1'])
    """

    points: Floats
    cells: Mapping[str, NDArray[np.integer]]
    sets: Mapping[str, NDArray[np.integer]] = field(default_factory=dict)
    faces: Mapping[str, NDArray[np.integer]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        points = np.ascontiguousarray(self.points, dtype=float)
        if points.ndim != 2 or points.shape[1] != 3:
            raise InvalidValue(
                "points must have shape (n, 3)",
                where="Mesh",
                value=points.shape,
                cause="points of a plane, or coordinates as rows",
                remedy="a row x, y, z for each node: np.column_stack([x, y, z])",
            )
        near = (np.abs(points) <= FARTHEST).all(axis=1)
        if not near.all():
            node = int(np.flatnonzero(~near)[0])
            raise NotFinite(
                f"a node has no finite position, or one beyond {FARTHEST:g}",
                where=f"node {node}",
                value=points[node],
                cause="a division by zero, a file that was cut, or a size with a wrong exponent",
                remedy="look at what wrote the mesh, or at the sizes that it was made with",
            )
        named = isinstance(self.cells, Mapping)
        if not named or len(self.cells) != 1 or next(iter(self.cells)) not in ("hex8", "hex18"):
            raise WrongCellType(
                "a mesh has cells of one type, hex8 or hex18",
                where="Mesh",
                value=(", ".join(self.cells) or "none") if named else type(self.cells).__name__,
                cause="an array in place of a mapping, cells of several types, or of another one",
                remedy="give cells={'hex8': ids} or cells={'hex18': ids}",
            )
        name, raw = next(iter(self.cells.items()))
        if not np.issubdtype(np.asarray(raw).dtype, np.integer):
            raise InvalidValue(
                "node ids of cells must be integers",
                where="Mesh",
                value=np.asarray(raw).dtype,
                cause="coordinates in place of ids, or ids that were read as real numbers",
                remedy="ids.astype(int), counted from 0",
            )
        cells = np.ascontiguousarray(raw, dtype=np.int32)
        nodes = 8 if name == "hex8" else 18
        if cells.ndim != 2 or cells.shape[1] != nodes or len(cells) == 0:
            raise WrongCellType(
                f"{name} cells must have shape (m, {nodes}) with m > 0",
                where="Mesh",
                value=np.shape(raw),
                cause="cells of another type",
                remedy="an 8-node hexahedron is hex8, a solid-shell with 9 nodes a face is hex18",
            )
        if cells.min() < 0 or cells.max() >= len(points):
            cell = int(np.flatnonzero(((cells < 0) | (cells >= len(points))).any(axis=1))[0])
            raise InvalidValue(
                "a cell names a node that does not exist",
                where=f"cell {cell}",
                value=cells[cell],
                cause="node numbers that start at 1, or a cut file",
                remedy=f"0 to {len(points) - 1}",
            )
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "cells", {name: cells})
        object.__setattr__(
            self, "sets", {key: unique(_as_ids(ids, len(points), f"set {key}")) for key, ids in self.sets.items()}
        )
        object.__setattr__(self, "faces", {key: _as_rows(rows, f"set {key}") for key, rows in self.faces.items()})
        _refuse_twice(cells)
        check_cells(points, cells)

    @property
    def cell(self) -> str:
        """Type of the cells: hex8 or hex18."""
        return next(iter(self.cells))

    @property
    def connectivity(self) -> Ids:
        """Node ids of the cells, shape (m, 8) or (m, 18)."""
        return np.asarray(self.cells[self.cell], dtype=np.int32)

    def __repr__(self) -> str:
        sets = ", ".join(self.sets) or "none"
        return f"Mesh({len(self.points)} points, {len(self.connectivity)} {self.cell}, sets: {sets})"

    def nodes(self, selector: Selector) -> Ids:
        """Node ids of a set.

        Parameters
        ----------
        selector : str, callable or array_like
            Name of a node or face set; predicate of the coordinates x, y, z (arrays of shape (n,)); node ids; or a mask
            over all nodes.

        Returns
        -------
        ndarray of int32
            Sorted ids.

        Raises
        ------
        UnknownSet, EmptySet
            If there is no such set, or it is empty.
        """
        if isinstance(selector, str):
            if selector in self.sets:
                ids = np.asarray(self.sets[selector], dtype=np.int32)
            elif selector in self.faces:
                ids = self.nodes_on(np.asarray(self.faces[selector], dtype=np.int32))
            else:
                raise _unknown("node", selector, [*self.sets, *self.faces])
        elif callable(selector):
            ids = np.flatnonzero(self._chosen(selector)).astype(np.int32)
        else:
            ids = unique(_as_ids(selector, len(self.points)))
        if len(ids) == 0:
            raise EmptySet(
                "a set selects no node",
                where="nodes",
                value=selector if isinstance(selector, str) else "predicate or list",
                cause="it is empty, or its metal was cut off" if isinstance(selector, str) else "",
                remedy="another set" if isinstance(selector, str) else _LOOK,
            )
        if ids.min() < 0 or ids.max() >= len(self.points):
            raise InvalidValue(
                "a node id does not exist",
                where=f"mesh of {len(self.points)} points",
                value=int(ids.min() if ids.min() < 0 else ids.max()),
                cause="node numbers that start at 1, or those of another mesh",
                remedy=f"0 to {len(self.points) - 1}",
            )
        return ids

    def face_set(self, selector: Selector) -> Ids:
        """Faces of a set as rows (cell, number of the face in :data:`umform.mesh.FACES`).

        Parameters
        ----------
        selector : str, callable or array_like
            Name of a face set; predicate of the coordinates x, y, z that all nodes of a face must meet, without faces
            between two cells; or rows.

        Returns
        -------
        ndarray of int32, shape (k, 2)
            Rows (cell, face).

        Raises
        ------
        UnknownSet, EmptySet, InvalidValue
            If there is no such set, it is empty, or a row names no face.
        """
        if isinstance(selector, str):
            if selector not in self.faces:
                raise _unknown("face", selector, list(self.faces))
            rows = np.asarray(self.faces[selector], dtype=np.int32)
        elif callable(selector):
            inside = self._chosen(selector)
            rows = np.concatenate(
                [
                    np.stack([hit, np.full(len(hit), number)], axis=1)
                    for number, local in enumerate(nodes_of_faces(self.cell))
                    for hit in [np.flatnonzero(inside[self.connectivity[:, local]].all(axis=1))]
                ]
            ).astype(np.int32)
            rows = rows[self._lie_outside(rows)]
        else:
            rows = _as_rows(selector)
        if len(rows) == 0:
            raise EmptySet(
                "a set selects no face",
                where="faces",
                value=selector if isinstance(selector, str) else "predicate or list",
                cause="it is empty, or its metal was cut off"
                if isinstance(selector, str)
                else "no face lies in it, or only faces between two cells",
                remedy="another set" if isinstance(selector, str) else _LOOK,
            )
        bad = (rows < 0).any(axis=1) | (rows[:, 0] >= len(self.connectivity)) | (rows[:, 1] >= len(FACES))
        if bad.any():
            raise InvalidValue(
                "a face is a pair (cell, number of the face)",
                value=rows[bad][0].tolist(),
                where=f"mesh of {len(self.connectivity)} cells",
                cause="cells that are counted from 1, or those of another mesh",
                remedy="faces are numbered " + ", ".join(f"{k} {name}" for k, name in enumerate(FACES)),
            )
        return rows

    def _chosen(self, predicate: Callable[[Floats, Floats, Floats], ArrayLike]) -> NDArray[np.bool_]:
        """Whether a predicate holds at each node, shape (n,)."""
        try:
            found = np.asarray(predicate(*self.points.T))
        except Exception as error:
            error.add_note("in a predicate of x, y, z, arrays over all nodes: lambda x, y, z: (x > 9.99) & (z < 0)")
            raise
        if found.dtype != bool or found.shape not in ((), (len(self.points),)):
            raise InvalidValue(
                "a predicate of x, y, z returns True or False for each node",
                where="a set by a predicate",
                value=f"{found.dtype} of shape {found.shape}",
                cause="a coordinate, or ids, in place of a comparison",
                remedy="lambda x, y, z: x > 9.99",
            )
        return np.broadcast_to(found, len(self.points))

    def facets(self, selector: Selector) -> Ids:
        """Nodes of lower and upper faces, ordered so that x,r x x,s points out of the body; shape (k, 4) or (k, 9).

        Raises
        ------
        InvalidValue
            If the set has lateral faces.
        """
        return self.facets_of(self.face_set(selector))

    def facets_of(self, rows: Ids) -> Ids:
        """The same for rows (cell, face); may be empty."""
        if (rows[:, 1] > 1).any():
            raise InvalidValue(
                "contact and pressure act on lower and upper faces only",
                where="faces",
                value=FACES[int(rows[:, 1].max())],
                cause="a set of lateral faces",
                remedy="choose a set of lower or upper faces",
            )
        half = self.connectivity.shape[1] // 2
        lower = self.connectivity[:, :half][:, _OUTWARD_LOWER[self.cell]]
        upper = self.connectivity[:, half:]
        return np.ascontiguousarray(np.where(rows[:, 1:] == 0, lower[rows[:, 0]], upper[rows[:, 0]]))

    def corners_of(self, rows: Ids) -> Ids:
        """Nodes at the corners of faces (cell, face), of lateral ones the lower two first; shape (k, 4)."""
        corners, half = np.array(nodes_of_faces("hex8")), self.connectivity.shape[1] // 2
        local = corners % 4 + half * (corners // 4)
        found: Ids = self.connectivity[rows[:, :1], local[rows[:, 1]]]
        return found

    def face_centres(self, rows: Ids) -> Floats:
        """Mean of the corners of faces (cell, face), shape (k, 3)."""
        centres: Floats = self.points[self.corners_of(rows)].mean(axis=1)
        return centres

    def _lie_outside(self, rows: Ids) -> NDArray[np.bool_]:
        """Whether each of some faces occurs once, among them those of all cells at their nodes."""
        corners = np.sort(self.corners_of(rows), axis=1)
        _, number, counts = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
        return np.asarray(counts[number.ravel()] == 1)

    def displaced(self, u: Floats) -> Floats:
        """The points (n, 3) after a displacement, three components of each node in one row."""
        if np.size(u) != self.points.size:
            raise InvalidValue(
                "a displacement has three components for each node",
                where="Mesh.displaced",
                value=f"{np.size(u)} numbers, {len(self.points)} nodes",
                cause="a translation, or the displacement of another mesh",
                remedy="model.u; mesh.moved(translation) shifts all points",
            )
        points: Floats = self.points + np.reshape(u, self.points.shape)
        return points

    def moved(self, translation: ArrayLike) -> Mesh:
        """The same mesh with all points shifted by three numbers."""
        try:
            shift = np.asarray(translation, dtype=float)
        except (TypeError, ValueError):  # a letter, for instance
            shift = np.empty(0)
        if shift.shape != (3,):
            raise InvalidValue(
                "a translation has three components",
                where="Mesh.moved",
                value=translation,
                cause="one number, or a vector of a plane",
                remedy="mesh.moved((0.0, 0.0, 1.0))",
            )
        return self.transformed(lambda X: X + shift)

    def transformed(self, function: Callable[[Floats], Floats]) -> Mesh:
        """The same mesh with its points (n, 3) mapped by ``function``."""
        return Mesh(function(self.points), self.cells, self.sets, self.faces)

    def nodes_on(self, rows: NDArray[np.integer]) -> Ids:
        """Sorted ids of the nodes of faces, given as cell and number of the face."""
        kinds = enumerate(nodes_of_faces(self.cell))
        parts = [self.connectivity[np.ix_(rows[rows[:, 1] == number, 0], local)].ravel() for number, local in kinds]
        return unique(np.concatenate(parts))


def _as_ids(selector: ArrayLike, count: int, where: str = "") -> Ids:
    """Ids from integers or from a mask over all `count` items; anything else is refused."""
    array = np.asarray(selector)
    if array.dtype == bool and array.shape == (count,):
        return np.flatnonzero(array).astype(np.int32)
    if array.size and not np.issubdtype(array.dtype, np.integer):
        raise InvalidValue(
            "a set is a name, a predicate of x, y, z, integer ids, or a mask over all nodes",
            where=where,
            value=f"{array.dtype} of shape {array.shape}",
            cause="coordinates in place of ids, or a mask of another mesh",
            remedy='"x0", lambda x, y, z: x < 1e-6, or [0, 7]',
        )
    return array.astype(np.int32)


def _as_rows(faces: ArrayLike, where: str = "") -> Ids:
    """Rows (cell, face) from integers, each once; anything else is refused."""
    array = np.asarray(faces)
    if array.size and (not np.issubdtype(array.dtype, np.integer) or array.shape[-1:] != (2,)):
        raise InvalidValue(
            "faces are a set by its name, a predicate of x, y, z, or pairs (cell, number of the face)",
            where=where,
            value=f"{array.dtype} of shape {array.shape}",
            cause="ids of nodes or cells in place of pairs",
            remedy='"lower", lambda x, y, z: z > 0.49, or [(0, 1)]',
        )
    rows = array.astype(np.int32).reshape(-1, 2)
    _, first = np.unique(rows, axis=0, return_index=True)
    return rows[np.sort(first)]


def _refuse_twice(cells: Ids) -> None:
    """Refuse cells of the same nodes, which would be twice as stiff and as strong."""
    nodes = np.sort(cells, axis=1)
    powers = np.cumprod(np.full(nodes.shape[1], 0x9E3779B97F4A7C15, dtype=np.uint64))  # a hash: few cells share one
    order = np.argsort(nodes.astype(np.uint64) @ powers, kind="stable")
    same = (nodes[order[1:]] == nodes[order[:-1]]).all(axis=1)
    if same.any():
        first = int(np.flatnonzero(same)[0])
        one, other = sorted((int(order[first]), int(order[first + 1])))
        raise InvalidValue(
            "two cells have the same nodes",
            where=f"cells {one} and {other}",
            value=f"{int(same.sum())} cells stand twice",
            cause="a mesh file that lists the cells of each of its groups",
            remedy="each cell once",
        )


def _unknown(kind: str, name: str, known: Sequence[str]) -> UnknownSet:
    return UnknownSet(
        f"the mesh has no {kind} set of that name",
        value=name,
        cause="a typing error, or a set lost in the mesh file",
        remedy="known sets: " + (", ".join(sorted(set(known))) or "none"),
    )
