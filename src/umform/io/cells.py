"""The cell types of umform and their nodes in VTK and meshio.

umform numbers the lower face first and then the upper one, each counter-clockwise seen from above::

    hex8                    hex18: the lower face; add 9 for the upper one

      7-------6               3----6----2
     /|      /|               |         |
    4-------5 |     s         7    8    5
    | 3-----|-2     |         |         |
    |/      |/      +-- r     0----4----1
    0-------1

VTK has no cell with 18 nodes that all its readers understand: a ``VTK_LAGRANGE_HEXAHEDRON`` of the degrees
(2, 2, 1) needs an active cell attribute ``HigherOrderDegrees``, which VTKHDF files pass on since VTK 9.7
only; older readers warn, build a wrong cell and may crash over it. An ``hex18`` cell is therefore written as a
``VTK_TRIQUADRATIC_HEXAHEDRON`` with 27 nodes, of which the nodes 18 to 26, the middle layer, are the means of
the lower and upper ones. Since ``hex18`` interpolates linearly through the thickness, the cell with 27 nodes
is the same function, of position and of every field. The points of the middle layer come after all the
others; reading leaves them out again.

For readers that are new enough there is the Lagrange cell too: with the option ``lagrange`` VTKHDF files hold
the 18 nodes alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from umform.errors import InvalidValue, WrongCellType
from umform.io.checks import FloatArray, IntArray, check_ids, check_points

MIDDLE_TOLERANCE = 1e-3
"""Tolerated distance of a middle node from the mean of its two outer nodes, relative to their distance."""


@dataclass(frozen=True)
class CellType:
    """A cell type and its counterparts in VTK and meshio.

    Parameters
    ----------
    name : str
        Name in umform.
    nodes : int
        Number of nodes in umform.
    vtk_type : int
        Number of the type in VTK.
    vtk_nodes : tuple of int
        For each node of the VTK cell its number in umform; numbers from `nodes` on are the middle layer.
    meshio_type : str
        Name in meshio, which has the node order of VTK.
    degrees : tuple of int, optional
        Degrees along r, s and t, which VTK needs for its Lagrange cells; empty for all others.
    """

    name: str
    nodes: int
    vtk_type: int
    vtk_nodes: tuple[int, ...]
    meshio_type: str
    degrees: tuple[int, ...] = ()


HEX8 = CellType("hex8", 8, 12, tuple(range(8)), "hexahedron")

HEX18 = CellType(
    "hex18",
    18,
    29,
    (
        *(0, 1, 2, 3, 9, 10, 11, 12),  # corners, lower and upper
        *(4, 5, 6, 7, 13, 14, 15, 16),  # mid-sides, lower and upper
        *(18, 19, 20, 21),  # middle layer: below and above are corners
        *(25, 23, 22, 24),  # middle layer: faces r = -1, r = 1, s = -1, s = 1
        *(8, 17, 26),  # centres: lower, upper, middle
    ),
    "hexahedron27",
)

HEX18_LAGRANGE = CellType(
    "hex18",
    18,
    72,
    (
        *(0, 1, 2, 3, 9, 10, 11, 12),  # corners, lower and upper
        *(4, 5, 6, 7, 13, 14, 15, 16),  # mid-sides, lower and upper
        *(8, 17),  # centres, lower and upper
    ),
    "VTK_LAGRANGE_HEXAHEDRON",
    (2, 2, 1),
)

CELL_TYPES = {cell.name: cell for cell in (HEX8, HEX18)}
LAGRANGE_TYPES = {cell.name: cell for cell in (HEX18_LAGRANGE,)}


def cell_type(name: str, *, lagrange: bool = False) -> CellType:
    """Look up a cell type by its name.

    Parameters
    ----------
    name : str
        ``"hex8"`` or ``"hex18"``.
    lagrange : bool, optional
        Whether to use the Lagrange cell of VTK, if this type has one.

    Returns
    -------
    CellType
        The cell type.

    Raises
    ------
    WrongCellType
        There is no such cell type.
    """
    if name not in CELL_TYPES:
        raise WrongCellType("unknown cell type", value=name, remedy=f"choose one of {', '.join(sorted(CELL_TYPES))}")
    return LAGRANGE_TYPES.get(name, CELL_TYPES[name]) if lagrange else CELL_TYPES[name]


@dataclass(frozen=True)
class VtkGrid:
    """Points and cells in the form of VTK.

    Parameters
    ----------
    kind : CellType
        The type of all the cells.
    points : ndarray of float, shape (n + p, 3)
        The n points of the mesh, followed by p points of the middle layers.
    connectivity : ndarray of int, shape (m, k)
        The points of each cell in the order of VTK.
    pairs : ndarray of int, shape (p, 2)
        For each point of the middle layers the lower and the upper point of which it is the mean.
    """

    kind: CellType
    points: FloatArray
    connectivity: IntArray
    pairs: IntArray

    def complete(self, values: FloatArray) -> FloatArray:
        """Extend values at the points of the mesh to the points of the middle layers.

        Parameters
        ----------
        values : ndarray of float, shape (n, ...)
            Values at the points of the mesh.

        Returns
        -------
        ndarray of float, shape (n + p, ...)
            Values at all points of the grid.
        """
        return _with_means(values, self.pairs)


def to_vtk(kind: CellType, points: ArrayLike, connectivity: ArrayLike) -> VtkGrid:
    """Put points and cells into the form of VTK.

    Parameters
    ----------
    kind : CellType
        The type of all the cells.
    points : array_like of float, shape (n, 3)
        Positions.
    connectivity : array_like of int, shape (m, kind.nodes)
        The points of each cell in the order of umform.

    Returns
    -------
    VtkGrid
        The same cells in the order of VTK.

    Raises
    ------
    InvalidValue
        The shapes do not fit, or a cell names a point that does not exist.
    NotFinite
        A coordinate is NaN or infinite.
    """
    X = np.ascontiguousarray(points, dtype=np.float64)
    cells = np.ascontiguousarray(connectivity, dtype=np.int64)
    if X.ndim != 2 or X.shape[1] != 3:
        raise InvalidValue(
            "points must have the shape (n, 3)",
            where="points",
            value=X.shape,
            cause="two coordinates, or a flat array",
            remedy="a row of x, y, z for each point",
        )
    if cells.ndim != 2 or cells.shape[1] != kind.nodes or len(cells) == 0:
        raise InvalidValue(
            f"{kind.name} cells must have the shape (m, {kind.nodes})",
            where="cells",
            value=cells.shape,
            cause="cells of another type, or a flat array",
            remedy="a row of point numbers for each cell, or the type that they have",
        )
    check_points(X, where="")
    check_ids(cells, len(X), where="")

    pairs = np.empty((0, 2), dtype=np.int64)
    if len(kind.vtk_nodes) > kind.nodes:
        lower, upper = np.hsplit(cells, 2)
        pairs, number = np.unique(np.stack([lower, upper], -1).reshape(-1, 2), axis=0, return_inverse=True)
        cells = np.hstack([cells, len(X) + number.reshape(lower.shape)])
    return VtkGrid(kind, _with_means(X, pairs), cells[:, list(kind.vtk_nodes)], pairs)


def from_vtk(kind: CellType, points: FloatArray, connectivity: IntArray) -> IntArray:
    """Convert cells from the node order of VTK to that of umform, without the middle layer.

    Parameters
    ----------
    kind : CellType
        The type of all the cells.
    points : ndarray of float, shape (n, 3)
        Positions.
    connectivity : ndarray of int, shape (m, k)
        The points of each cell in the order of VTK.

    Returns
    -------
    ndarray of int, shape (m, kind.nodes)
        The points of each cell in the order of umform.

    Raises
    ------
    WrongCellType
        The cells have a middle layer that is not the mean of the lower and the upper face, or that is a
        face of other cells.
    """
    ordered = np.empty_like(connectivity)
    ordered[:, list(kind.vtk_nodes)] = connectivity
    cells, middle = ordered[:, : kind.nodes], ordered[:, kind.nodes :]
    if middle.size:
        _check_middle(points, cells, middle)
    return cells


def _with_means(values: FloatArray, pairs: IntArray) -> FloatArray:
    """Append to the values of the points the means of the values of some pairs of them."""
    return np.concatenate([values, 0.5 * (values[pairs[:, 0]] + values[pairs[:, 1]])])


def _check_middle(X: FloatArray, cells: IntArray, middle: IntArray) -> None:
    """Reject a middle layer that cannot be removed."""
    lower, upper = (X[half] for half in np.hsplit(cells, 2))
    away = np.linalg.norm(X[middle] - 0.5 * (lower + upper), axis=2)
    curved = np.flatnonzero((away > MIDDLE_TOLERANCE * np.linalg.norm(upper - lower, axis=2)).any(axis=1))
    shared = np.flatnonzero(np.isin(middle, cells).any(axis=1))
    if curved.size or shared.size:
        raise WrongCellType(
            f"{curved.size + shared.size} of {len(cells)} cells with 27 nodes cannot become hex18",
            where=f"cell {np.union1d(curved, shared)[0]}",
            cause="their edges are curved through the thickness"
            if curved.size
            else "neighbours do not agree on which direction is the thickness",
            remedy="let nodes 1-4 of each cell lie on the lower face of the sheet, with straight edges to "
            "the upper face, or use cells with 8 nodes",
        )
