"""Turns in the plane, the flange across z, and lines that cross themselves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.flat_pattern.one_step.part import Sheet
from umform.mesh.neighbours import connected

Floats = NDArray[np.float64]

#: Cosine of the angle to z up to which a triangle at the outer edge belongs to the flange under the binder.
_FLAT = 0.995


def flange(sheet: Sheet) -> NDArray[np.bool_]:
    """Triangles across z that are connected to the outer edge."""
    flat = abs(sheet.normals[:, 2]) > _FLAT
    at_edge = np.isin(sheet.triangles, sheet.loops[0]).any(axis=1) & flat
    if not at_edge.any():
        return at_edge
    ids = np.flatnonzero(flat)
    points = sheet.triangles[ids]
    links = np.concatenate([points[:, [0, 1]], points[:, [1, 2]]])
    part = connected(len(sheet.points), links)[sheet.triangles[:, 0]]
    return np.asarray(flat & np.isin(part, np.unique(part[at_edge])))


def turn(degrees: float) -> Floats:
    """Matrix behind places (n, 2) that turns them."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, s], [-s, c]])


def about_z(degrees: float) -> Floats:
    """The same behind points (n, 3), about the z-axis."""
    matrix = np.eye(3)
    matrix[:2, :2] = turn(degrees)
    return matrix


def crossings(outline: Floats) -> int:
    """Number of pairs of sides of a closed line that cross."""
    a, b = outline, np.roll(outline, -1, axis=0)
    count = len(a)
    found = 0
    for k in range(count):  # one side against all later ones
        others = np.arange(k + 2, count - (k == 0))
        if len(others):
            found += int(_cross(a[k], b[k], a[others], b[others]).sum())
    return found


def _cross(p: Floats, q: Floats, a: Floats, b: Floats) -> NDArray[np.bool_]:
    def side(o: Floats, d: Floats, x: Floats) -> Any:
        return (d[..., 0] - o[..., 0]) * (x[..., 1] - o[..., 1]) - (d[..., 1] - o[..., 1]) * (x[..., 0] - o[..., 0])

    return np.asarray((side(p, q, a) * side(p, q, b) < 0.0) & (side(a, b, p) * side(a, b, q) < 0.0))
