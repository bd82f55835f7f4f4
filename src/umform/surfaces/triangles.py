"""Surfaces of tools as triangles, cut to a box."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.surfaces.directions import Point, not_negative, point

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
#: Lowest and highest corner.
Box3 = tuple[Point, Point]


@dataclass(frozen=True)
class Triangles:
    """Triangulated surface.

    Attributes
    ----------
    points : ndarray, shape (n, 3)
        Points.
    triangles : ndarray of int, shape (m, 3)
        Points of the triangles, counter-clockwise from outside of the tool.
    """

    points: Floats
    triangles: Ids

    @classmethod
    def all_of(cls, parts: Sequence[Triangles]) -> Triangles:
        """Several surfaces as one."""
        firsts = np.cumsum([0, *(len(part.points) for part in parts[:-1])])
        ids = [part.triangles + first for part, first in zip(parts, firsts, strict=True)]
        return cls(np.concatenate([part.points for part in parts]), np.concatenate(ids))

    @property
    def corners(self) -> Floats:
        """Coordinates of the corners of all triangles, shape (m, 3, 3)."""
        return self.points[self.triangles]

    @property
    def area_vectors(self) -> Floats:
        """Normals of the triangles times their areas, shape (m, 3)."""
        a, b, c = np.moveaxis(self.corners, 1, 0)
        return 0.5 * np.cross(b - a, c - a)

    def beyond(self, normal: ArrayLike, at: ArrayLike) -> Triangles:
        """The part on the side of a plane to which its normal points."""
        n = np.asarray(normal, dtype=float)
        corners = self.corners
        return _welded(_cut(corners, (corners - np.asarray(at)) @ n), 1e-9 * float(np.ptp(self.points, axis=0).max()))


def grid(points: Floats) -> Triangles:
    """Two triangles for each cell of a grid of points, shape (k, m, 3); from outside, m turns left into k."""
    k, m, _ = points.shape
    at = np.arange(k * m).reshape(k, m)
    a, b, c, d = at[:-1, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, 1:].ravel(), at[1:, :-1].ravel()
    return Triangles(points.reshape(-1, 3), np.vstack([np.c_[a, b, c], np.c_[a, c, d]]))


def halved(surface: Triangles, longest: float) -> Triangles:
    """A surface with all edges halved that are longer than a length; neighbours stay joined."""
    points, triangles = surface.points, surface.triangles
    while True:
        ends = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
        long = np.linalg.norm(points[ends[:, :, 0]] - points[ends[:, :, 1]], axis=2) > longest
        if not long.any():
            return Triangles(points, triangles)
        edges, ids = np.unique(ends[long], axis=0, return_inverse=True)
        middle = np.full(long.shape, -1)
        middle[long] = len(points) + ids.ravel()
        points = np.concatenate([points, points[edges].mean(axis=1)])
        count = long.sum(axis=1)
        parts = [triangles[count == 0]]
        for number, first in ((1, long.argmax(axis=1)), (2, (long.argmin(axis=1) + 1) % 3), (3, np.zeros_like(count))):
            rows = count == number
            order = (first[rows, None] + np.arange(3)) % 3
            a, b, c = np.take_along_axis(triangles[rows], order, axis=1).T
            m, n, p = np.take_along_axis(middle[rows], order, axis=1).T
            pieces = {
                1: ((a, m, c), (m, b, c)),
                2: ((m, b, n), (a, m, n), (a, n, c)),
                3: ((a, m, p), (m, b, n), (p, n, c), (m, n, p)),
            }
            parts += [np.stack(piece, axis=1) for piece in pieces[number]]
        triangles = np.concatenate(parts)


def across(axis: Point) -> tuple[Point, Point]:
    """Two unit vectors that are a right-handed frame with the axis."""
    a = np.array(axis)
    x = np.cross(np.eye(3)[np.abs(a).argmin()], a)
    x /= np.linalg.norm(x)
    y = np.cross(a, x)
    return (float(x[0]), float(x[1]), float(x[2])), (float(y[0]), float(y[1]), float(y[2]))


def rectangle(centre: Floats, reach: float, at: ArrayLike, normal: Point) -> Triangles:
    """Square of a plane around the foot of a point."""
    n = np.array(normal)
    foot = centre - ((centre - np.asarray(at)) @ n) * n
    x, y = (reach * np.array(v) for v in across(normal))
    return grid(np.array([[foot - x - y, foot + x - y], [foot - x + y, foot + x + y]]))


def inside_of(facets: Callable[[Floats, float, float], Triangles], box: Box3, chord: float) -> Triangles:
    """Triangles of a tool inside of a box.

    Parameters
    ----------
    facets : callable
        The tool's own triangles around a ball: centre, radius, chord error.
    box : tuple of two points
        Lowest and highest corner.
    chord : float
        Largest distance from the true surface; 0 means 1/1000 of the diagonal of the box.

    Raises
    ------
    InvalidValue
        If the box is empty.
    """
    low, high = (np.array(point(corner, "box")) for corner in box)
    if not (low < high).all():
        raise InvalidValue(
            "a box needs a lowest and a highest corner",
            where="box",
            value=box,
            cause="corners exchanged, or a box without thickness",
            remedy="((x0, y0, z0), (x1, y1, z1)) with each first number below the second one",
        )
    reach = 0.5 * float(np.linalg.norm(high - low))
    chord = not_negative(chord, "chord", "chord error") or 2e-3 * reach
    soup = facets(0.5 * (low + high), reach, chord).corners
    for k in range(3):
        soup = _cut(soup, soup[:, :, k] - low[k])
        soup = _cut(soup, high[k] - soup[:, :, k])
    return _welded(soup, 1e-9 * reach)


def _cut(soup: Floats, height: Floats) -> Floats:
    """Clip triangles (m, 3, 3) to the region where the height at their corners, shape (m, 3), is not negative."""
    inside = height >= 0.0
    count = inside.sum(axis=1)
    parts = [soup[count == 3]]
    for kept in (1, 2):  # rotate the odd corner to the front
        chosen = count == kept
        first = (inside[chosen] == (kept == 1)).argmax(axis=1)
        order = (first[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(soup[chosen], order[:, :, None], axis=1), 1, 0)
        ha, hb, hc = np.take_along_axis(height[chosen], order, axis=1).T
        ab = a + (ha / (ha - hb))[:, None] * (b - a)
        ac = a + (ha / (ha - hc))[:, None] * (c - a)
        parts += [np.stack([a, ab, ac], axis=1)] if kept == 1 else _pair_of((ab, b, c, ac))
    return np.concatenate(parts)


def _pair_of(quad: tuple[Floats, Floats, Floats, Floats]) -> list[Floats]:
    a, b, c, d = quad
    return [np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]


def _welded(soup: Floats, near: float) -> Triangles:
    """Merge coincident corners; drop degenerate triangles."""
    keys = np.round(soup.reshape(-1, 3) / near).astype(np.int64)
    _, first, ids = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    triangles = ids.reshape(-1, 3)
    a, b, c = triangles.T
    whole = triangles[(a != b) & (b != c) & (c != a)]
    used, whole = np.unique(whole, return_inverse=True)
    return Triangles(soup.reshape(-1, 3)[first[used]], whole.reshape(-1, 3))
