"""Symmetric part of an unsymmetric tangent: its factors show whether increments go downhill. eq. (5.101)"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.errors import SingularMatrix
from umform.solvers import Pattern, make_solver

Floats = NDArray[np.float64]


class SymmetricPart:
    """Counts the negative eigenvalues of (K + K^T) / 2.

    If there are none, every solution of K du = -r goes downhill, r . du < 0.

    Parameters
    ----------
    pattern : Pattern
        Of an unsymmetric matrix whose entries come in pairs (i, j) and (j, i).
    """

    def __init__(self, pattern: Pattern) -> None:
        rows, columns = pattern.rows, pattern.indices
        above = np.flatnonzero(columns >= rows)
        below = np.flatnonzero(columns <= rows)
        mirrored = below[np.lexsort((rows[below], columns[below]))]  # sorted as the upper triangle of the transpose
        starts = np.concatenate([[0], np.cumsum(np.bincount(rows[above], minlength=pattern.n))])
        upper = Pattern(pattern.n, starts.astype(np.int32), columns[above], symmetric=True)
        self._pairs, self._solver = (above, mirrored), make_solver(upper)

    def negative_pivots(self, values: Floats) -> int:
        """Number of negative eigenvalues of the symmetric part; one if it is singular.

        Parameters
        ----------
        values : ndarray
            Entries of the matrix.
        """
        above, mirrored = self._pairs
        try:
            found = self._solver.factor(0.5 * (values[above] + values[mirrored]))
        except SingularMatrix:
            return 1
        return found.negative_pivots or 0
