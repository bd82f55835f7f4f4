"""The formed part as one sheet of triangles: checked, turned to one side, with its edges."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.errors import UnfitTriangles
from umform.mesh.neighbours import connected

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Size of a part over its thickness, and in mm, outside of which the unit is another one.
_SMALLEST, _LARGEST = 8.0, 2e4
#: Cosine of the angle between neighbours from which on the surface is folded onto itself.
_FOLDED = -0.94
#: Smallest height of a triangle over its longest side.
_SLIVER = 1e-5


@dataclass(frozen=True, eq=False)
class Sheet:
    """A connected surface of triangles with an edge, all counter-clockwise from one side.

    Attributes
    ----------
    points : ndarray, shape (n, 3)
        Points in mm.
    triangles : ndarray of int, shape (m, 3)
        Triangles.
    """

    points: Floats
    triangles: Ids

    @cached_property
    def boundary(self) -> Ids:
        """Sides of one triangle only, with the sheet on the left, shape (k, 2)."""
        return self._boundary[0]

    @cached_property
    def boundary_triangles(self) -> Ids:
        """The triangle of each of these sides."""
        return self._boundary[1]

    @cached_property
    def _boundary(self) -> tuple[Ids, Ids]:
        sides = _sides(self.triangles)
        _, first, times = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True)
        alone = np.sort(first[times == 1])
        return sides[alone], alone % len(self.triangles)

    @cached_property
    def loops(self) -> list[Ids]:
        """Points along each closed edge, the outer one, which is the longest, first."""
        following = dict(self.boundary.tolist())
        found, left = [], set(following)
        while left:
            start = at = min(left)
            chain = []
            while at in left:
                left.remove(at)
                chain.append(at)
                at = following[at]
            assert at == start
            found.append(np.array(chain, dtype=np.int64))
        return sorted(found, key=self._length, reverse=True)

    def _length(self, loop: Ids) -> float:
        return float(np.linalg.norm(np.diff(self.points[[*loop, loop[0]]], axis=0), axis=1).sum())

    @cached_property
    def normals(self) -> Floats:
        """Unit normals of the triangles."""
        a, b, c = np.moveaxis(self.points[self.triangles], 1, 0)
        n = np.cross(b - a, c - a)
        return np.asarray(n / np.linalg.norm(n, axis=1, keepdims=True))


def _sides(triangles: Ids) -> Ids:
    return np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])


def sheet_of(points: Floats, triangles: Ids, thickness: float, where: str = "part") -> Sheet:
    """The sheet of a formed mid-surface.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Points in mm.
    triangles : ndarray of int, shape (m, 3)
        Triangles, in any order of their corners.
    thickness : float
        Of the sheet, in mm.
    where : str
        For messages.

    Raises
    ------
    UnfitTriangles
        If it is closed, not connected, branched, folded, twisted like a Moebius strip, has a handle, or another unit.
    """
    used, ids = np.unique(triangles, return_inverse=True)
    points, triangles = np.asarray(points, dtype=float)[used], ids.reshape(-1, 3).astype(np.int64)
    _check_unit(points, thickness, where)
    _check_shapes(points, triangles, where)
    pairs = _neighbours(points, triangles, where)
    _check_connected(points, triangles, pairs, where)
    sheet = _face_up(Sheet(points, _turned(triangles, pairs, where)))
    _check_edges(sheet, where)
    _check_folds(sheet, pairs, where)
    return sheet


def _face_up(sheet: Sheet) -> Sheet:
    """The sheet with the normals of its larger part along z, as the flat has them."""
    a, b, c = np.moveaxis(sheet.points[sheet.triangles][:, :, :2], 1, 0)
    if float(np.sum((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])) >= 0.0:
        return sheet
    return Sheet(sheet.points, sheet.triangles[:, ::-1])


def _place(points: Floats, ids: Ids) -> str:
    x, y, z = points[ids].mean(axis=0)
    return f"at ({x:.4g}, {y:.4g}, {z:.4g})"


def _check_unit(points: Floats, thickness: float, where: str) -> None:
    size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    if not _SMALLEST * thickness <= size <= _LARGEST:
        raise UnfitTriangles(
            "the size of the part does not fit a sheet of this thickness",
            where=where,
            value=f"{size:.4g} mm long, {thickness:g} mm thick",
            cause="metres or inches in the file, or another thickness",
            remedy="--scale 1000 for metres, --scale 25.4 for inches",
        )


def _check_shapes(points: Floats, triangles: Ids, where: str) -> None:
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    longest = np.max([np.linalg.norm(s, axis=1) for s in (b - a, c - b, a - c)], axis=0)
    height = np.linalg.norm(np.cross(b - a, c - a), axis=1) / np.maximum(longest, 1e-300) ** 2
    if (worst := height.argmin()) >= 0 and height[worst] < _SLIVER:
        raise UnfitTriangles(
            "a triangle has no area",
            where=where,
            value=_place(points, triangles[worst]),
            cause="slivers of the export",
            remedy="export with another tolerance, or a larger weld distance",
        )


def _neighbours(points: Floats, triangles: Ids, where: str) -> Ids:
    """Pairs of sides that two triangles share, shape (p, 2), numbered as in `_sides`."""
    ends = np.sort(_sides(triangles), axis=1)
    _, ids, times = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    if (times > 2).any():
        side = ends[np.flatnonzero(times[ids.ravel()] > 2)[0]]
        raise UnfitTriangles(
            "three triangles share a side: this is no sheet",
            where=where,
            value=f"{int((times > 2).sum())} such sides, one {_place(points, side)}",
            cause="a rib or a flange welded on, or faces of the solid's inside",
            remedy="export the mid-surface of one sheet",
        )
    order = np.argsort(ids.ravel(), kind="stable")
    order = order[times[ids.ravel()[order]] == 2]
    pairs: Ids = order.reshape(-1, 2)
    return pairs


def _check_connected(points: Floats, triangles: Ids, pairs: Ids, where: str) -> None:
    part = connected(len(triangles), pairs % len(triangles))
    if part.any():
        sizes = np.bincount(part)
        smallest = int(sizes.argmin())
        raise UnfitTriangles(
            "the surface is not connected",
            where=where,
            value=f"{len(sizes)} pieces; the smallest, of {sizes[smallest]} triangles, "
            + _place(points, triangles[part == smallest].ravel()),
            cause="gaps between faces, or several parts in one file",
            remedy="a larger weld distance (--weld), or one part a file",
        )


def _turned(triangles: Ids, pairs: Ids, where: str) -> Ids:
    """All triangles turned as the first one."""
    count = len(triangles)
    sides = _sides(triangles)
    equal = sides[pairs[:, 0], 0] == sides[pairs[:, 1], 0]  # neighbours of opposite turns
    if not equal.any():
        return triangles
    a, b = pairs.T % count
    # Two copies of each triangle, as it is and turned: those of one turn are connected.
    links = np.concatenate([np.c_[a, np.where(equal, b + count, b)], np.c_[a + count, np.where(equal, b, b + count)]])
    part = connected(2 * count, links)
    if part[0] == part[count]:
        raise UnfitTriangles(
            "the surface has one side only, like a Moebius strip",
            where=where,
            cause="a twisted strip that is closed",
            remedy="a sheet with two sides",
        )
    turn = part[:count] != part[0]
    made = triangles.copy()
    made[turn] = made[turn][:, ::-1]
    return made


def _check_edges(sheet: Sheet, where: str) -> None:
    points, edge = sheet.points, sheet.boundary
    if not len(edge):
        raise UnfitTriangles(
            "the surface is closed: a sheet has an edge",
            where=where,
            value=f"{len(sheet.triangles)} triangles",
            cause="a solid with both skins in place of its mid-surface",
            remedy="export one skin, and give its distance from the mid-surface with --offset",
        )
    starts, times = np.unique(edge[:, 0], return_counts=True)
    if (times > 1).any():
        raise UnfitTriangles(
            "two edges meet in a point",
            where=where,
            value=_place(points, starts[times > 1][:1]),
            cause="two pieces that touch in a corner, or a hole that touches the edge",
            remedy="join or separate them",
        )
    sides = len(np.unique(np.sort(_sides(sheet.triangles), axis=1), axis=0))
    holes = len(sheet.loops)
    if len(points) - sides + len(sheet.triangles) + holes != 2:
        raise UnfitTriangles(
            "the surface has a handle: it cannot be flat",
            where=where,
            value=f"{holes} edges",
            cause="a tube whose ends are joined, or a bridge",
            remedy="cut it open",
        )


def _check_folds(sheet: Sheet, pairs: Ids, where: str) -> None:
    one, other = (sheet.normals[ids % len(sheet.triangles)] for ids in pairs.T)
    cosine = np.einsum("ij,ij->i", one, other)
    if len(cosine) and cosine.min() < _FOLDED:
        at = sheet.triangles[pairs[cosine.argmin(), 0] % len(sheet.triangles)]
        raise UnfitTriangles(
            "the surface is folded onto itself",
            where=where,
            value=f"{np.degrees(np.arccos(np.clip(cosine.min(), -1, 1))):.0f} degrees between two triangles, "
            + _place(sheet.points, at),
            cause="a hem without its radius, or both skins of a solid",
            remedy="the mid-surface with the radius of the fold",
        )
