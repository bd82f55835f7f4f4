"""Find shared sides of cells, and sides that belong to one cell only."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.errors import MeshError
from umform.mesh.mesh import Floats, Ids

Whole = NDArray[np.integer]


def place(X: Floats) -> str:
    """Mean of some positions, for an error message."""
    return "near (" + ", ".join(f"{x:.4g}" for x in X.mean(axis=0)) + ")"


def shared_sides(points: Floats, sides: Whole, kind: str) -> Whole:
    """Pairs of sides with the same nodes.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Positions.
    sides : ndarray of int, shape (k, nodes)
        Node ids of each side of each cell, in any order.
    kind : str
        Word for a side in messages: edge or face.

    Returns
    -------
    ndarray of int, shape (p, 2)
        Rows of `sides`.

    Raises
    ------
    MeshError
        If a side belongs to three cells or more, or twice to one cell.
    """
    _, number, counts = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True, return_counts=True)
    number = number.ravel()
    if counts.max() > 2:
        crowded = sides[np.flatnonzero(counts[number] > 2)[0]]
        raise MeshError(
            f"a {kind} belongs to more than two cells: the body branches or overlaps itself",
            where=place(points[crowded]),
            value=f"{counts.max()} cells, nodes {np.sort(crowded).tolist()}",
            cause="a rib that stands on the sheet, or cells that the file has twice",
            remedy="mesh one sheet without branches; delete cells that are there twice",
        )
    order = np.argsort(number, kind="stable")
    starts = np.cumsum(counts)[counts == 2] - 2
    return np.stack([order[starts], order[starts + 1]], axis=1)


def connected(count: int, links: Whole) -> NDArray[np.int64]:
    """Connected component of each of `count` things; links have shape (p, 2).

    Union-find: each thing points to the lowest known one of its component. A link between two components makes the
    higher one point to the lower, and all pointers are shortened, until no link joins two components. SciPy is avoided
    because its import is slow.
    """
    lowest = np.arange(count)
    while len(links):
        ends = np.sort(lowest[links], axis=1)
        links = links[ends[:, 0] != ends[:, 1]]
        np.minimum.at(lowest, ends[:, 1], ends[:, 0])
        while not np.array_equal(lowest, following := lowest[lowest]):
            lowest = following
    parts: NDArray[np.int64] = np.unique(lowest, return_inverse=True)[1]
    return parts


def outer_faces(cells: Whole) -> dict[str, Ids]:
    """Lower and upper faces that no other cell shares, as face sets ``lower`` and ``upper``."""
    half = cells.shape[1] // 2
    lower, upper = np.sort(cells[:, :half], axis=1), np.sort(cells[:, half:], axis=1)
    outer = {}
    for name, number, mine, others in (("lower", 0, lower, upper), ("upper", 1, upper, lower)):
        shared = {row.tobytes() for row in others}
        ids = np.array([k for k, row in enumerate(mine) if row.tobytes() not in shared], dtype=np.int32)
        outer[name] = np.stack([ids, np.full(len(ids), number, dtype=np.int32)], axis=1)
    return outer


def used_only(points: Floats, cells: Whole, sets: dict[str, Whole]) -> tuple[Floats, Whole, dict[str, Whole]]:
    """Remove points that no cell uses, and sets that become empty."""
    used = np.unique(cells)
    number = np.full(len(points), -1)
    number[used] = np.arange(len(used))
    kept = {name: number[np.intersect1d(ids, used)] for name, ids in sets.items()}
    return points[used], number[cells], {name: ids for name, ids in kept.items() if ids.size}


def with_centres(points: Floats, faces: Whole, sets: dict[str, Whole]) -> tuple[Floats, Whole, dict[str, Whole]]:
    """Add the ninth node to faces with 8 nodes: the centre of their surface.

    The serendipity surface of 8 nodes is a special biquadratic surface of 9 nodes; both agree when the centre lies at
    half the sum of the mid-sides minus a quarter of the sum of the corners. Faces with the same nodes share their
    centre. A set with all 8 nodes of a face also gets its centre.

    Returns
    -------
    points : ndarray, shape (n + c, 3)
    faces : ndarray of int, shape (m, 9)
    sets : dict of str to ndarray of int
    """
    _, first, number = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_inverse=True)
    one_of_each = faces[first]
    centres = 0.5 * points[one_of_each[:, 4:]].sum(axis=1) - 0.25 * points[one_of_each[:, :4]].sum(axis=1)
    grown = {
        name: np.concatenate([ids, len(points) + np.flatnonzero(np.isin(one_of_each, ids).all(axis=1))])
        for name, ids in sets.items()
    }
    return np.concatenate([points, centres]), np.column_stack([faces, len(points) + number.ravel()]), grown
