"""Orient imported hexahedra so that t runs through the thickness of the sheet."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue, WrongCellType
from umform.mesh.directions import through_the_sheet
from umform.mesh.mesh import FACE_NODES, Floats, Mesh
from umform.mesh.neighbours import Whole, outer_faces, place, used_only, with_centres
from umform.mesh.surface import TURNED

#: Tolerated distance of a middle node from the mean of its two outer nodes, relative to their distance.
MIDDLE_TOLERANCE = 1e-3

#: Natural coordinates of 27 nodes in the order of VTK: corners, edges below, above, between, faces, centre. The first 8
#: and the first 20 are the nodes of the smaller hexahedra.
NATURAL = np.concatenate(
    [
        *(np.column_stack([FACE_NODES[:4], np.full(4, t)]) for t in (-1.0, 1.0)),
        *(np.column_stack([FACE_NODES[4:8], np.full(4, t)]) for t in (-1.0, 1.0)),
        np.column_stack([FACE_NODES[:4], np.zeros(4)]),
        [(-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0), (0, 0, -1), (0, 0, 1), (0, 0, 0)],
    ]
)


def orient(
    points: ArrayLike,
    cells: ArrayLike,
    sets: Mapping[str, ArrayLike] | None = None,
    *,
    through: str | ArrayLike = "thinnest",
) -> Mesh:
    """Orient hexahedra so that t runs through the thickness, from the lower face of the sheet to the upper one.

    A direction is followed from cell to cell over their common faces. If it contains one direction of each cell, it may
    be the thickness; of these, the one along which the body is thinnest between outer faces is used, or the named one.
    Without a name, upper is the side to which the mean of all thickness vectors points, along its largest component;
    where this mean vanishes, as in a closed shell, lower is the smaller of the outer faces.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Positions. Unused ones are removed.
    cells : array_like of int, shape (m, 8), (m, 20) or (m, 27)
        Hexahedra in the node order of VTK and meshio. Those with 8 nodes become ``hex8``. Those with 20 and 27 nodes
        become ``hex18`` if their edges through the thickness are straight with the node in the middle, so that removing
        the middle layer loses nothing; faces of 8 nodes get the centre of their serendipity surface.
    sets : mapping of str to array_like of int, optional
        Named sets of nodes.
    through : str or array_like, shape (3,)
        ``"thinnest"``; an axis ``"x"``, ``"-x"``, ``"y"``, ... or a vector that points to the upper side; or the name
        of a set that has all nodes of the lower face of the sheet.

    Returns
    -------
    Mesh
        With face sets ``lower`` and ``upper``.

    Raises
    ------
    WrongCellType
        If the cells are of another type.
    MeshError
        If there is no such direction, two are about as thin, or the body branches or is one-sided.
    """
    X, hexahedra = np.asarray(points, dtype=float), np.asarray(cells)
    if hexahedra.ndim != 2 or hexahedra.shape[1] not in (8, 20, 27) or not len(hexahedra):
        raise WrongCellType(
            "hexahedra have 8, 20 or 27 nodes",
            where="orient",
            value=hexahedra.shape,
            cause="quadrilaterals or tetrahedra, or a flat array",
            remedy="mesh.thicken makes cells of quadrilaterals",
        )
    if X.ndim != 2 or X.shape[1] != 3 or hexahedra.min() < 0 or hexahedra.max() >= len(X):
        raise InvalidValue(
            "points must have shape (n, 3), and the cells name some of them",
            where="orient",
            value=X.shape,
            cause="node numbers that start at 1, or points of a part of the mesh",
            remedy="points and cells of one mesh, numbers from 0",
        )
    named: dict[str, Whole] = {name: np.unique(np.asarray(ids, dtype=np.int64)) for name, ids in (sets or {}).items()}
    corners = hexahedra[:, :8].astype(np.int64)
    signed = through_the_sheet(X, corners, _wanted(through, named, len(X)))
    lower, upper, middle = _turned(X, hexahedra.astype(np.int64), signed)
    if middle.size:
        _check_middle(X, lower, upper, middle)
    if lower.shape[1] == 8:
        count = len(lower)
        X, faces, named = with_centres(X, np.concatenate([lower, upper]), named)
        lower, upper = faces[:count], faces[count:]
    X, connectivity, named = used_only(X, np.concatenate([lower, upper], axis=1), named)
    kind = "hex8" if connectivity.shape[1] == 8 else "hex18"
    return Mesh(X, {kind: connectivity}, named, outer_faces(connectivity))


def _wanted(through: str | ArrayLike, sets: dict[str, Whole], count: int) -> Floats | NDArray[np.bool_] | None:
    """The request: none, a vector, or a mask over the nodes of the lower face."""
    if isinstance(through, str):
        if through == "thinnest":
            return None
        if through in sets:
            mask = np.zeros(count, dtype=bool)
            mask[sets[through]] = True
            return mask
        if through.lstrip("+-") not in ("x", "y", "z"):
            raise InvalidValue(
                "unknown direction through the thickness",
                value=through,
                remedy="thinnest, an axis such as z or -z, a vector, or a node set: " + (", ".join(sets) or "none"),
            )
        axis: Floats = np.zeros(3)
        axis["xyz".index(through[-1])] = -1.0 if through[0] == "-" else 1.0
        return axis
    vector = np.asarray(through, dtype=float)
    if vector.shape != (3,) or not np.isfinite(vector).all() or not vector.any():
        raise InvalidValue(
            "a direction is a vector of three numbers, not all zero",
            where="through",
            value=vector,
            cause="an angle, two components, or zeros",
            remedy="(0.0, 0.0, 1.0)",
        )
    return np.asarray(vector / np.linalg.norm(vector))


def _turned(X: Floats, cells: Whole, signed: Whole) -> tuple[Whole, Whole, Whole]:
    """Lower, upper and middle nodes of cells with a given signed thickness direction."""
    nodes = {8: 4, 20: 8, 27: 9}[cells.shape[1]]
    layers = [np.empty((len(cells), count), dtype=np.int64) for count in (nodes, nodes, {4: 0, 8: 4, 9: 9}[nodes])]
    for axis, sign in product(range(3), (-1, 1)):
        rows = np.flatnonzero(signed == 2 * axis + (sign > 0))
        frame = np.zeros((3, 3))
        frame[2, axis], frame[0, (axis + 1) % 3], frame[1, (axis + 2) % 3] = sign, 1.0, sign  # right-handed
        for layer, t in zip(layers, (-1.0, 1.0, 0.0)):
            natural = np.column_stack([FACE_NODES[: layer.shape[1]], np.full(layer.shape[1], t)]) @ frame
            order = (natural[:, None] == NATURAL).all(axis=2).argmax(axis=1)
            layer[rows] = cells[rows[:, None], order]
    lower, upper, middle = layers
    x = X[lower[:, :4]]
    rise = X[upper[:, :4]].mean(axis=1) - x.mean(axis=1)
    left = np.einsum("ek,ek->e", np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]), rise) < 0
    lower[left], upper[left] = lower[left][:, TURNED[nodes]], upper[left][:, TURNED[nodes]]
    if middle.size:
        middle[left] = middle[left][:, TURNED[middle.shape[1]]]
    return lower, upper, middle


def _check_middle(X: Floats, lower: Whole, upper: Whole, middle: Whole) -> None:
    """Reject a middle layer that cannot be removed."""
    low, high = X[lower[:, : middle.shape[1]]], X[upper[:, : middle.shape[1]]]
    away = np.linalg.norm(X[middle] - 0.5 * (low + high), axis=2) / np.linalg.norm(high - low, axis=2)
    curved = np.flatnonzero((away > MIDDLE_TOLERANCE).any(axis=1))
    if curved.size:
        raise WrongCellType(
            f"{curved.size} of {len(lower)} cells are curved through the thickness and cannot become hex18",
            where=f"cell {curved[0]}, {place(X[lower[curved[0]]])}",
            value=f"a node of the middle layer lies off by {away[curved[0]].max():.3g} of the thickness",
            remedy="straighten the edges through the thickness, or mesh with 8 nodes a cell",
        )
