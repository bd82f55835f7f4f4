"""Places in a sheet of quadrilaterals: in which one a point lies, and where."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

#: Quadrilaterals around a point that are tried, and Newton iterations.
_CANDIDATES, _ITERATIONS = 16, 12


def bilinear(rs: Floats) -> tuple[Floats, Floats]:
    """Shape functions (n, 4) and derivatives (n, 2, 4) of a quadrilateral at natural points (n, 2). eq. (1.28)"""
    r, s = rs[:, 0], rs[:, 1]
    N = 0.25 * np.stack([(1 - r) * (1 - s), (1 + r) * (1 - s), (1 + r) * (1 + s), (1 - r) * (1 + s)], axis=1)
    dr = 0.25 * np.stack([s - 1, 1 - s, 1 + s, -1 - s], axis=1)
    ds = 0.25 * np.stack([r - 1, -1 - r, 1 + r, 1 - r], axis=1)
    return N, np.stack([dr, ds], axis=1)


@dataclass(frozen=True)
class Places:
    """Where points lie.

    Attributes
    ----------
    quad : ndarray of int, shape (n,)
        The quadrilateral.
    rs : ndarray, shape (n, 2)
        Natural coordinates, within [-1, 1].
    outside : ndarray, shape (n,)
        By how much they were outside of this range: zero up to round-off for points in the sheet.
    """

    quad: Numbers
    rs: Floats
    outside: Floats

    @property
    def weights(self) -> Floats:
        """Shape functions, shape (n, 4); round-off is removed, so that points on edges have two."""
        N = bilinear(self.rs)[0]
        N[np.abs(N) < 1e-9] = 0.0
        return np.asarray(N / N.sum(axis=1, keepdims=True))


def located(points: Floats, places: Floats, quads: Numbers) -> Places:
    """Quadrilaterals that contain some points of the plane.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        The points.
    places : ndarray, shape (m, 2)
        Corners of the quadrilaterals.
    quads : ndarray of int, shape (k, 4)
        Their ids.
    """
    from scipy.spatial import cKDTree  # slow to import

    corners = places[quads]
    count = min(_CANDIDATES, len(quads))
    near = np.asarray(cKDTree(corners.mean(axis=1)).query(points, k=count)[1]).reshape(len(points), count)
    at, x = corners[near].reshape(-1, 4, 2), np.repeat(points, count, axis=0)
    rs = np.zeros((len(x), 2))
    for _ in range(_ITERATIONS):
        N, dN = bilinear(rs)
        J = np.einsum("nka,nai->nik", dN, at)
        det = J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
        r = x - np.einsum("na,nai->ni", N, at)
        det = np.where(np.abs(det) > 1e-300, det, 1e-300)
        step = np.stack([J[:, 1, 1] * r[:, 0] - J[:, 0, 1] * r[:, 1], J[:, 0, 0] * r[:, 1] - J[:, 1, 0] * r[:, 0]], 1)
        rs = np.clip(rs + step / det[:, None], -3.0, 3.0)
    outside = np.maximum(np.abs(rs).max(axis=1) - 1.0, 0.0)
    miss = np.linalg.norm(x - np.einsum("na,nai->ni", bilinear(rs)[0], at), axis=1)
    size = np.linalg.norm(at[:, 2] - at[:, 0], axis=1)
    outside = (outside + miss / size).reshape(len(points), count)
    best = outside.argmin(axis=1)
    row = np.arange(len(points))
    found = np.clip(rs.reshape(len(points), count, 2)[row, best], -1.0, 1.0)
    return Places(near[row, best], found, outside[row, best])
