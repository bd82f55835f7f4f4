"""The cubic spline through points of a curve; that of SciPy, whose interpolation takes half a second to be imported."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Spline:
    """Cubic polynomials between knots with two continuous derivatives; at the second and the last but one a third.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Knots, four or more, increasing.
    y : ndarray, shape (n, m)
        Values there.
    """

    def __init__(self, x: Floats, y: Floats) -> None:
        self.x, self.y = x, y
        self._h = np.diff(x)
        self._chord = np.diff(y, axis=0) / self._h[:, None]
        self._slope = np.linalg.solve(*self._equations())

    def _equations(self) -> tuple[Floats, Floats]:
        """Equations of the slopes at the knots: the second derivatives of two neighbours are one."""
        h, chord, n = self._h, self._chord, len(self.x)
        matrix, right = np.zeros((n, n)), np.zeros_like(self.y)
        inner = np.arange(1, n - 1)
        matrix[inner, inner - 1], matrix[inner, inner + 1] = h[1:], h[:-1]
        matrix[inner, inner] = 2.0 * (h[:-1] + h[1:])
        right[1:-1] = 3.0 * (h[1:, None] * chord[:-1] + h[:-1, None] * chord[1:])
        for row, near, a, b in ((0, 1, 0, 1), (-1, -2, -1, -2)):  # the first two polynomials are one, the last two too
            both = h[a] + h[b]
            matrix[row, row], matrix[row, near] = h[b], both
            right[row] = ((h[a] + 2.0 * both) * h[b] * chord[a] + h[a] ** 2 * chord[b]) / both
        return matrix, right

    def __call__(self, at: Floats) -> Floats:
        """Values (k, m) at k places."""
        k, s = self._between(at)
        values: Floats = self.y[k] + s * (self._slope[k] + s * self._bend(k, s))
        return values

    def slope(self, at: Floats) -> Floats:
        """Derivatives (k, m) at k places."""
        k, s = self._between(at)
        h = self._h[k][:, None]
        second = self._third(k) * s / h
        slope: Floats = self._slope[k] + 2.0 * s * self._bend(k, s) + s * second
        return slope

    def _between(self, at: Floats) -> tuple[NDArray[np.int64], Floats]:
        """Polynomial at each place, and the way from its knot."""
        k = np.clip(np.searchsorted(self.x, at, side="right") - 1, 0, len(self._h) - 1)
        return k, (at - self.x[k])[:, None]

    def _third(self, k: NDArray[np.int64]) -> Floats:
        """The coefficient of s^3 times h."""
        third: Floats = (self._slope[k] + self._slope[k + 1] - 2.0 * self._chord[k]) / self._h[k][:, None]
        return third

    def _bend(self, k: NDArray[np.int64], s: Floats) -> Floats:
        """The coefficient of s^2 plus that of s^3 times s."""
        h = self._h[k][:, None]
        second = (self._chord[k] - self._slope[k]) / h - self._third(k)
        bend: Floats = second + self._third(k) * s / h
        return bend
