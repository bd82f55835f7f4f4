"""Closed curves of a blank as polygons: whether they meet, and which lie inside of which."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from umform.errors import MeshError

Floats = NDArray[np.float64]

#: Largest distance of a chord from its arc over the length of this: 180 chords of a circle, with one end on each axis.
_CHORD = 2.43e-5


class Closed(Protocol):
    """A closed curve: :class:`umform.surfaces.Profile`."""

    @property
    def segments(self) -> Sequence[Any]:
        """Lines and arcs, each starting where the one before has ended."""

    @property
    def closed(self) -> bool:
        """Whether the end of the last one is the start of the first one."""


def check_curves(outline: Closed, holes: Sequence[Closed]) -> None:
    """Refuse curves that meet, and holes that do not lie side by side in the outline.

    Raises
    ------
    MeshError
        With the curves and the place; gmsh would search for ever, or mesh another region.
    """
    curves = [_polygon(curve) for curve in (outline, *holes)]
    low, high = (np.array([reduce(x, axis=0) for x in curves]) for reduce in (np.min, np.max))
    for i, one in enumerate(curves):
        near = ((low[i + 1 :] <= high[i]) & (high[i + 1 :] >= low[i])).all(axis=1)
        for k in (i + 1 + np.flatnonzero(near | (i == 0))).tolist():
            _check_pair(one, curves[k], f"hole {i - 1}" if i else "", f"hole {k - 1}")


def _check_pair(one: Floats, hole: Floats, name: str, hole_name: str) -> None:
    """Refuse a hole that meets another curve, or does not lie beside it; without a name this is the outline."""
    if (at := _meeting(one, hole)) is not None:
        raise MeshError(
            "curves of the blank meet",
            where="blank",
            value=f"{name or 'the outline'} and {hole_name} at ({at[0]:.6g}, {at[1]:.6g})",
            cause="a hole that is there twice, or that reaches the edge",
            remedy="each hole once; a notch is part of the outline, and holes that overlap are one",
        )
    if not name and not _inside(one, hole[0]):
        raise MeshError(
            "a hole lies outside of the outline",
            where="blank",
            value=hole_name,
            cause="another unit or origin, or another curve as the outline",
            remedy="holes side by side inside of the outline",
        )
    if name and (_inside(one, hole[0]) or _inside(hole, one[0])):
        raise MeshError(
            "a hole lies in another one",
            where="blank",
            value=f"{name} and {hole_name}",
            cause="an outline among holes",
            remedy="holes side by side inside of the outline",
        )


def _polygon(curve: Closed) -> Floats:
    return np.vstack([segment.points(_CHORD * segment.length)[:-1] for segment in curve.segments])


def _meeting(one: Floats, other: Floats) -> Floats | None:
    """A common point of two polygons."""
    (p, q), (r, s) = ((x, np.roll(x, -1, axis=0)) for x in (one, other))
    near = (np.minimum(p, q) <= other.max(axis=0)) & (np.maximum(p, q) >= other.min(axis=0))
    p, q = p[near.all(axis=1)], q[near.all(axis=1)]
    overlap = (np.minimum(p, q)[:, None] <= np.maximum(r, s)) & (np.maximum(p, q)[:, None] >= np.minimum(r, s))
    i, k = np.nonzero(overlap.all(axis=2))
    p, q, r, s = p[i], q[i], r[k], s[k]
    first, last = _side(r, s, p), _side(r, s, q)
    hit = np.flatnonzero((first * last <= 0.0) & (_side(p, q, r) * _side(p, q, s) <= 0.0))
    if not len(hit):
        return None
    n = hit[0]
    share = first[n] / (first[n] - last[n]) if first[n] != last[n] else 0.0
    return np.asarray(p[n] + share * (q[n] - p[n]))


def _side(start: Floats, end: Floats, x: Floats) -> Floats:
    """Twice the area of a triangle, positive if x is on the left of the way from start to end."""
    a, b = end - start, x - start
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _inside(polygon: Floats, x: Floats) -> bool:
    """Whether a ray from a point along x leaves a polygon."""
    p, q = polygon, np.roll(polygon, -1, axis=0)
    crossed = (p[:, 1] > x[1]) != (q[:, 1] > x[1])
    p, q = p[crossed], q[crossed]
    return bool(((_side(p, q, x) > 0.0) == (q[:, 1] > p[:, 1])).sum() % 2)
