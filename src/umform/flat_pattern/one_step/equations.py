"""Residuals and matrices of the places in the flat: sums over triangles on one sparse pattern."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.flat_pattern.one_step.strain import SIDES
from umform.solvers import Pattern

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: From corners (x0, y0, x1, y1, x2, y2) to sides (D00, D01, D10, D11).
CORNERS = np.zeros((4, 6))
CORNERS[:2, 0::2] = CORNERS[2:, 1::2] = SIDES


class Equations:
    """Two unknowns a point, of which some are held.

    Parameters
    ----------
    count : int
        Number of points.
    triangles : ndarray of int, shape (m, 3)
        Triangles.
    held : ndarray of bool, shape (2 count,)
        Unknowns that keep their values.
    symmetric : bool
        Whether only upper triangles of matrices are stored.
    """

    def __init__(self, count: int, triangles: Ids, held: NDArray[np.bool_], *, symmetric: bool) -> None:
        self.count, self.free, self.symmetric = count, np.flatnonzero(~held), symmetric
        self.dofs = (2 * triangles[:, :, None] + np.arange(2)).reshape(len(triangles), 6)
        self._number = np.full(2 * count, -1, dtype=np.int64)
        self._number[self.free] = np.arange(len(self.free))

    @cached_property
    def _places(self) -> tuple[Ids, Ids, Pattern]:
        """Entries of the triangles that are stored, their places in the pattern, the pattern."""
        equation = self._number[self.dofs]
        rows, columns = np.repeat(equation, 6, axis=1).ravel(), np.tile(equation, 6).ravel()
        kept = (rows >= 0) & (columns >= rows if self.symmetric else columns >= 0)
        entries = np.flatnonzero(kept)
        size = len(self.free)
        keys, places = np.unique(rows[entries] * size + columns[entries], return_inverse=True)
        starts = np.searchsorted(keys, np.arange(size + 1) * size)
        pattern = Pattern(size, starts.astype(np.int32), (keys % size).astype(np.int32), self.symmetric)
        return entries, places.ravel(), pattern

    @property
    def pattern(self) -> Pattern:
        """Pattern of the matrix of the free unknowns."""
        return self._places[2]

    def vector(self, of_corners: Floats) -> Floats:
        """Sum of values at corners, shape (m, 6), over all unknowns."""
        return np.bincount(self.dofs.ravel(), of_corners.ravel(), 2 * self.count).astype(float)

    def matrix(self, of_corners: Floats) -> Floats:
        """Values of the matrix of matrices of triangles, shape (m, 6, 6)."""
        entries, places, pattern = self._places
        return np.bincount(places, of_corners.reshape(-1)[entries], pattern.nnz).astype(float)

    def columns(self, of_corners: Floats, held: Ids) -> Floats:
        """Columns of the held unknowns in the rows of the free ones and of the held ones, shape (2 count, h)."""
        full = np.zeros((2 * self.count, len(held)))
        for k, dof in enumerate(held):
            cells, corner = np.nonzero(self.dofs == dof)
            np.add.at(full[:, k], self.dofs[cells], of_corners[cells, :, corner])
        return full

    def rows(self, of_corners: Floats, held: Ids) -> Floats:
        """Rows of the held unknowns, shape (h, 2 count)."""
        return self.columns(np.swapaxes(of_corners, 1, 2), held).T


def at_corners(gradient: Floats) -> Floats:
    """Derivatives by the sides as derivatives by the corners, shape (m, 6)."""
    return np.asarray(gradient @ CORNERS)


def between_corners(hessian: Floats) -> Floats:
    """Second derivatives by the sides as those by the corners, shape (m, 6, 6)."""
    return np.asarray(CORNERS.T @ hessian @ CORNERS)
