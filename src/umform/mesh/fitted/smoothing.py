"""Smoothing of quadrilaterals by their shape, in the metric of the sheet of which they are a part. eq. (1.30)"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

#: Smallest determinants of the regularised energy, from coarse to fine, and how often the line is met again.
_DELTAS, _ROUNDS = (0.5, 0.1, 0.02), 3


def corners_of(x: Floats, quads: Numbers) -> tuple[Floats, Floats]:
    """Edges from each corner to the next and to the last one, shape (quads, 4, 2) each."""
    at = x[quads]
    return np.roll(at, -1, axis=1) - at, np.roll(at, 1, axis=1) - at


def sines(x: Floats, quads: Numbers) -> Floats:
    """Smallest sine of the angles of each quadrilateral, negative where it is folded; (quads,)."""
    a, b = corners_of(x, quads)
    cross = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return np.asarray((cross / np.maximum(np.linalg.norm(a, axis=2) * np.linalg.norm(b, axis=2), 1e-300)).min(axis=1))


def smoothed(
    x: Floats,
    quads: Numbers,
    metric: Floats,
    free: NDArray[np.bool_],
    on_line: Numbers,
    line: Callable[[Floats], tuple[Floats, Floats]],
) -> Floats:
    """Places of free nodes that minimise the sum of (|a|^2 + |b|^2) / (2 det) over all corners. eq. (1.30)

    Parameters
    ----------
    x : ndarray, shape (n, 2)
        Places.
    quads : ndarray of int, shape (k, 4)
        The quadrilaterals, counter-clockwise.
    metric : ndarray, shape (k, 2, 2)
        Maps edges of each one to a plane in which good ones are squares.
    free : ndarray of bool, shape (n,)
        Nodes that may move.
    on_line : ndarray of int
        Those of them that stay on the line.
    line : callable
        Signed distance (m,) and normal (m, 2) at places (m, 2).
    """
    from scipy.optimize import minimize  # slow to import

    x, slides = x.copy(), np.zeros(len(x), dtype=bool)
    slides[on_line] = True
    moving = np.flatnonzero(free)
    for delta in _DELTAS:
        for _ in range(_ROUNDS):
            normal = np.zeros_like(x)
            normal[on_line] = line(x[on_line])[1]
            start = x[moving].ravel()

            def energy(
                v: Floats, normal: Floats = normal, delta: float = delta, start: Floats = start
            ) -> tuple[float, Floats]:
                at = x.copy()
                d = (v - start).reshape(-1, 2)
                n = normal[moving]
                at[moving] = x[moving] + d - n * np.einsum("ni,ni->n", n, d)[:, None]
                value, slope = _energy(at, quads, metric, delta)
                g = slope[moving]
                return value, (g - n * np.einsum("ni,ni->n", n, g)[:, None]).ravel()

            found = minimize(energy, start, jac=True, method="L-BFGS-B", options={"maxiter": 100})
            d = (found.x - start).reshape(-1, 2)
            n = normal[moving]
            x[moving] += d - n * np.einsum("ni,ni->n", n, d)[:, None]
            x[on_line] = onto(x[on_line], line)
    return x


def onto(x: Floats, line: Callable[[Floats], tuple[Floats, Floats]]) -> Floats:
    """The nearest places on a line."""
    for _ in range(8):
        distance, normal = line(x)
        x = x - distance[:, None] * normal
    return x


def _energy(x: Floats, quads: Numbers, metric: Floats, delta: float) -> tuple[float, Floats]:
    """The energy and its gradient; the determinant is regularised so that folded corners have a finite one."""
    a, b = (np.einsum("kij,kcj->kci", metric, e) for e in corners_of(x, quads))
    det = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    root = np.sqrt(det**2 + 4.0 * delta**2)
    h = 0.5 * (det + root)
    size = np.einsum("kci,kci->kc", a, a) + np.einsum("kci,kci->kc", b, b)
    by_det = -0.5 * size / h**2 * 0.5 * (1.0 + det / root)
    da = a / h[..., None] + by_det[..., None] * np.stack([b[..., 1], -b[..., 0]], axis=2)
    db = b / h[..., None] + by_det[..., None] * np.stack([-a[..., 1], a[..., 0]], axis=2)
    da, db = (np.einsum("kij,kci->kcj", metric, e) for e in (da, db))
    slope = np.zeros_like(x)
    np.add.at(slope, quads, -da - db)
    np.add.at(slope, np.roll(quads, -1, axis=1), da)
    np.add.at(slope, np.roll(quads, 1, axis=1), db)
    return float((0.5 * size / h).sum()), slope
