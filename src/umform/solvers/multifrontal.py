"""The solver of umform itself: multifrontal factors in the order of a sheet, with the BLAS of SciPy."""

from __future__ import annotations

import numpy as np

from .. import _core
from . import blas
from .protocol import (
    Factorisation,
    FloatArray,
    Pattern,
    backward_error,
    check_accuracy,
    not_factored,
    singular,
    vanishing_pivot,
)

# A backward error above this is worth a step of iterative refinement.
_POOR_RESIDUAL = 1e-14


class Multifrontal:
    """Supernodal multifrontal factorisation: Cholesky, L D L^T with pivots of one and two columns, or LU."""

    name = "multifrontal"
    _values: FloatArray | None = None

    def analyse(self, pattern: Pattern) -> None:
        """Order the equations and plan the fronts; Cholesky is expected of a symmetric matrix."""
        self._values = None
        blas.hand_over()
        indptr, indices = (np.ascontiguousarray(part, np.int32) for part in (pattern.indptr, pattern.indices))
        self._pattern = pattern
        self._factors = _core.Multifrontal(indptr, indices, pattern.symmetric)
        self._positive = pattern.symmetric

    def factor(self, values: FloatArray) -> Factorisation:
        """Factorise; after a pivot that is not positive, Cholesky is left out until none is negative any more."""
        self._values = None
        values = self._pattern.checked(values)
        factors, symmetric = self._factors, self._pattern.symmetric
        self._with_cholesky = self._positive
        outcome = factors.factor(values, self._positive)
        if outcome.not_positive:
            self._with_cholesky = self._positive = False
            outcome = factors.factor(values, False)
        if not outcome.done:
            raise singular(self.name, outcome.equation if outcome.equation >= 0 else None)
        pivots = factors.pivots()
        scale = values[self._pattern.indptr[:-1]] if self._with_cholesky else factors.column_sizes(values)
        weakest = vanishing_pivot(pivots.size, scale)
        if weakest is not None:
            raise singular(self.name, weakest)
        self._positive = symmetric and pivots.negative == 0
        self._values = values
        return Factorisation(pivots.negative if symmetric else None, factors.fill, pivots.odd)

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve; without Cholesky the residual is checked, and the solution refined where that is poor."""
        if self._values is None:
            raise not_factored()
        b = self._pattern.checked_rhs(rhs)
        b = np.ascontiguousarray(b.T)
        x = np.empty_like(b)
        self._factors.solve(b, x)
        if not self._with_cholesky:
            self._refine(self._values, b, x)
        return x.T

    def memory(self) -> int:
        """What later answers follow from, beside the values: whether the next matrix is tried with Cholesky."""
        return int(self._positive)

    def recall(self, kind: int) -> None:
        """Go on with the kind of factors of a run that was kept."""
        self._positive = bool(kind) and self._pattern.symmetric

    def _refine(self, values: FloatArray, b: FloatArray, x: FloatArray) -> None:
        """Improve the solution once if its residual is poor."""
        residual = np.empty_like(b)
        size = max(float(values.max()), -float(values.min()))
        self._factors.residual(values, b, x, residual)
        if backward_error(residual.T, size, x.T, b.T) > _POOR_RESIDUAL:
            change = np.empty_like(x)
            self._factors.solve(residual, change)
            x += change
            self._factors.residual(values, b, x, residual)
        check_accuracy(self.name, backward_error(residual.T, size, x.T, b.T))
