"""Find the direction of each hexahedron that runs through the thickness of the sheet.

Across a shared face, each of the three directions of one cell continues as a direction of its neighbour, with a sign.
The signed directions that are connected in this way form a *family*. In a sheet, however its surface is meshed, the
thickness is a family with one direction of every cell. The in-plane directions are so too in a structured mesh, but
merge where three or five cells meet around an edge.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from umform.errors import MeshError
from umform.mesh.mesh import FACE_NODES, Floats
from umform.mesh.neighbours import Whole, connected, place, shared_sides

#: Natural coordinates of the corners of a hexahedron.
CORNERS = np.concatenate([np.column_stack([FACE_NODES[:4], np.full(4, t)]) for t in (-1.0, 1.0)]).astype(int)

#: Corners of the faces, around each of them; face 2 k + 1 looks along direction k, face 2 k against it.
FACE_CORNERS = np.array([[0, 3, 7, 4], [1, 2, 6, 5], [0, 1, 5, 4], [3, 2, 6, 7], [0, 1, 2, 3], [4, 5, 6, 7]])

#: Smallest ratio of the second smallest thickness to the smallest one.
CLEARLY_THICKER = 1.5


class Family(NamedTuple):
    """One connected direction of each cell of a body.

    Attributes
    ----------
    signed : ndarray of int, shape (cells,)
        Twice the number of the direction, plus one for its positive sense.
    length : float
        Mean distance from one outer face to the other.
    """

    signed: Whole
    length: float


def through_the_sheet(X: Floats, cells: Whole, wanted: Floats | NDArray[np.bool_] | None) -> Whole:
    """Signed direction of each cell that runs from the lower to the upper face of the sheet.

    Parameters
    ----------
    X : ndarray, shape (n, 3)
        Positions.
    cells : ndarray of int, shape (m, 8)
        Corners of the hexahedra.
    wanted : ndarray or None
        A unit vector to the upper side, shape (3,); a mask of the nodes of the lower face, shape (n,); or None
        for the thinnest direction.

    Returns
    -------
    ndarray of int, shape (m,)
        Twice the number of the direction, plus one for its positive sense.
    """
    faces = cells[:, FACE_CORNERS].reshape(-1, 4)
    pairs = shared_sides(X, faces, "face")
    body = connected(len(cells), pairs // 6)
    family = connected(6 * len(cells), _links(X, cells, faces, pairs))
    signed = np.empty(len(cells), dtype=np.int64)
    for number in range(body.max() + 1):
        members = np.flatnonzero(body == number)
        found = _families(X, cells, pairs, family, members)
        signed[members] = _chosen(X, cells[members], found, wanted)
    return signed


def _links(X: Floats, cells: Whole, faces: Whole, pairs: Whole) -> Whole:
    """Signed directions that neighbours share; signed direction d of cell k has the number 6 k + d."""
    (one, other), (face, opposite) = (pairs // 6).T, (pairs % 6).T
    # outward for one cell is inward for the other
    links = [np.stack([6 * one + (face ^ flip), 6 * other + (opposite ^ 1 ^ flip)], axis=1) for flip in (0, 1)]
    start = faces[pairs[:, 0], 0]
    for k in (1, 3):  # the two edges of the face that begin in its first corner
        end = faces[pairs[:, 0], k]
        here, there = _along(cells[one], start, end), _along(cells[other], start, end)
        if (here < 0).any() or (there < 0).any():
            wrong = int(np.flatnonzero((here < 0) | (there < 0))[0])
            raise MeshError(
                "two cells share the nodes of a face but go around it in different ways",
                where=f"cells {one[wrong]} and {other[wrong]}, {place(X[faces[pairs[wrong, 0]]])}",
                cause="nodes of a cell in another order than that of VTK",
                remedy="look at what wrote the mesh",
            )
        links += [np.stack([6 * one + (here ^ flip), 6 * other + (there ^ flip)], axis=1) for flip in (0, 1)]
    return np.concatenate(links)


def _along(cells: Whole, start: Whole, end: Whole) -> Whole:
    """Signed direction of an edge in each cell; -1 where the two nodes have no common edge."""
    first, last = (np.argmax(cells == node[:, None], axis=1) for node in (start, end))
    step = CORNERS[last] - CORNERS[first]
    axis = np.abs(step).argmax(axis=1)
    sense = step[np.arange(len(step)), axis] > 0
    return np.where(np.abs(step).sum(axis=1) == 2, 2 * axis + sense, -1)


def _families(X: Floats, cells: Whole, pairs: Whole, family: Whole, members: Whole) -> list[Family]:
    """Families with one direction of every cell that end at outer faces, the thinnest first."""
    mine = family.reshape(-1, 6)[members]
    found = []
    twisted = False
    for label in np.unique(mine[0, 1::2]):
        hits = mine == label
        if (hits.sum(axis=1) == 1).all():
            signed = hits.argmax(axis=1)
            length = _length(X, cells, pairs, members, signed)
            if np.isfinite(length):
                found.append(Family(signed, length))
        twisted |= bool((hits.reshape(-1, 3, 2).all(axis=2).sum(axis=1) == 1).all() and (hits.sum(axis=1) == 2).all())
    if not found:
        raise MeshError(
            "no direction of the cells runs through the thickness of the body",
            where=f"{len(members)} cells, {place(X[cells[members[0]]])}",
            cause="the sheet has one side only, as the band of Moebius"
            if twisted
            else "the body is no sheet: going around an edge inside it, the thickness becomes another direction",
            remedy="sweep a mesh of quadrilaterals through the thickness, or thicken a surface (umform.mesh.thicken)",
        )
    return sorted(found, key=lambda one: one.length)


def _length(X: Floats, cells: Whole, pairs: Whole, members: Whole, signed: Whole) -> float:
    """Mean length of the columns of cells along a family; infinite if a column is closed."""
    axis = np.full(len(cells), -1)
    axis[members] = signed // 2
    links = pairs[(pairs[:, 0] % 6) // 2 == axis[pairs[:, 0] // 6]] // 6
    column = connected(len(cells), links)[members]
    _, column, sizes = np.unique(column, return_inverse=True, return_counts=True)
    joints = np.bincount(column[np.searchsorted(members, links[:, 0])], minlength=len(sizes))
    if (joints >= sizes).any():
        return float("inf")
    size = np.linalg.norm(_rise(X, cells[members], signed), axis=1)
    return float(np.bincount(column, weights=size).mean())


def _rise(X: Floats, cells: Whole, signed: Whole) -> Floats:
    """Vector of each cell from the middle of one face to that of the opposite one along its signed direction."""
    rows = np.arange(len(cells))[:, None]
    high, low = (X[cells[rows, FACE_CORNERS[side]]].mean(axis=1) for side in (signed, signed ^ 1))
    return np.asarray(high - low)


def _chosen(X: Floats, cells: Whole, found: list[Family], wanted: Floats | NDArray[np.bool_] | None) -> Whole:
    """The requested family, or the thinnest one, with its sign."""
    if wanted is None:
        if len(found) > 1 and found[1].length < CLEARLY_THICKER * found[0].length:
            raise MeshError(
                "two directions of the body are about as thin as each other: either may be the thickness",
                where=f"{len(cells)} cells, {place(X[cells[0]])}",
                value=", ".join(f"{one.length:.4g}" for one in found),
                remedy="name the axis through the thickness, or a set with the nodes of the lower face",
            )
        return _upwards(X, cells, found[0].signed)
    if wanted.dtype == bool:
        return _from_below(X, cells, found, wanted.astype(bool))
    slopes = []
    for one in found:
        rise = _rise(X, cells, one.signed)
        slopes.append(float((rise @ wanted / np.linalg.norm(rise, axis=1)).mean()))
    best = int(np.argmax(np.abs(slopes)))
    if abs(slopes[best]) < np.sqrt(0.5):
        raise MeshError(
            "no direction of the cells runs along the axis that was named",
            where=f"{len(cells)} cells, {place(X[cells[0]])}",
            value=f"mean cosines {', '.join(f'{slope:.2f}' for slope in slopes)}",
            cause="the sheet is curved, or lies in another plane",
            remedy="name another axis, a set with the nodes of the lower face, or take the thinnest direction",
        )
    return found[best].signed ^ int(slopes[best] < 0)


def _upwards(X: Floats, cells: Whole, signed: Whole) -> Whole:
    """Sign for which the mean thickness vector points up; in a closed shell, outside is up."""
    rise = _rise(X, cells, signed)
    mean = rise.mean(axis=0)
    if np.linalg.norm(mean) > 0.01 * np.linalg.norm(rise, axis=1).mean():
        largest = np.abs(mean) > 0.999 * np.abs(mean).max()
        return signed ^ int(mean[np.flatnonzero(largest)[-1]] < 0)
    area = []
    for side in (signed ^ 1, signed):
        x = X[cells[np.arange(len(cells))[:, None], FACE_CORNERS[side]]]
        area.append(np.linalg.norm(np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]), axis=1).sum())
    return signed ^ int(area[0] > area[1])


def _from_below(X: Floats, cells: Whole, found: list[Family], lower: NDArray[np.bool_]) -> Whole:
    """The family whose columns all begin in the faces of the named nodes."""
    faces = np.sort(cells[:, FACE_CORNERS].reshape(-1, 4), axis=1)
    _, number, counts = np.unique(faces, axis=0, return_inverse=True, return_counts=True)
    outer = (counts[number.ravel()] == 1).reshape(-1, 6)
    named = lower[cells[:, FACE_CORNERS]].all(axis=2) & outer
    rows = np.arange(len(cells))
    for one in found:
        for signed in (one.signed, one.signed ^ 1):
            begin, end = signed ^ 1, signed
            if (named[rows, begin] == outer[rows, begin]).all() and not named[rows, end].any():
                return signed
    raise MeshError(
        "the set is not the lower face of the sheet",
        where=f"{len(cells)} cells, {place(X[cells[0]])}",
        value=f"it has {int(named.sum())} whole outer faces",
        cause="nodes of the face are missing in it, or it has faces of both sides",
        remedy="give a set of all nodes of one side of the sheet",
    )
