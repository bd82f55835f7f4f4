"""Multifrontal factorisation, for any matrix, with dense products by the BLAS of SciPy.

The equations of a sheet are ordered by nested dissection of the graph of its fibres, those of other matrices by that or
by minimum degree, whichever has fewer operations (`cpp/include/umform/multifrontal/elimination.hpp`). A symmetric
matrix is first tried with Cholesky; a pivot that is not positive leads to L D L^T with pivots of one and two columns,
which give the inertia, until a matrix has no negative pivot. Unsymmetric matrices get LU factors. A pivot that is
unstable within its front is delayed to the parent front, so that no matrix needs another solver.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, partial

import numpy as np

from .. import _core
from ..errors import SolveError
from . import blas
from .protocol import (
    Factorisation,
    FloatArray,
    Pattern,
    backward_error,
    check_accuracy,
    not_factored,
    singular,
)
from .singularity import Iteration, Loose, large_solution, weak_pivot

# Backward error above which iterative refinement is used, and the largest number of its steps.
_POOR_RESIDUAL, _STEPS = 1e-14, 2


class Multifrontal:
    """Supernodal multifrontal factorisation: Cholesky, L D L^T or LU; the same bits on any number of threads."""

    name = "multifrontal"
    _ready = False
    _values: FloatArray | None = None  # for refinement, unless the factors are those of Cholesky
    _factors: _core.Multifrontal
    _found: Factorisation | None = None

    def analyse(self, pattern: Pattern) -> None:
        """Order the equations and plan the fronts; a symmetric matrix is first tried with Cholesky."""
        self._ready, self._values, self._found, self._asked = False, None, None, False
        blas.hand_over()
        indptr, indices = (np.ascontiguousarray(part, np.int32) for part in (pattern.indptr, pattern.indices))
        self._pattern = pattern
        with _memory(pattern, lambda: 0):
            self._factors = _core.Multifrontal(indptr, indices, pattern.symmetric)
        self._positive = pattern.symmetric

    def factor(self, values: FloatArray) -> Factorisation:
        """Factorise; after a pivot that is not positive, Cholesky is skipped until no pivot is negative."""
        self._ready, self._values, self._found = False, None, None
        values = self._pattern.checked(values)
        factors, symmetric = self._factors, self._pattern.symmetric
        with _memory(self._pattern, lambda: factors.bytes):
            self._with_cholesky = self._positive
            outcome = factors.factor(values, self._positive)
            if outcome.not_positive:
                self._with_cholesky = self._positive = False
                outcome = factors.factor(values, False)
            if not outcome.done:
                raise singular(self.name, outcome.equation if outcome.equation >= 0 else None)
            negative, odd, lost = self._inspected(values)
        self._positive = symmetric and negative == 0
        self._values = None if self._with_cholesky else values
        self._found = Factorisation(negative if symmetric else None, factors.fill, odd)
        self._ready = lost is None
        if lost is not None:
            raise singular(self.name, lost.equation, lost.motion)
        return self._found

    def accept(self) -> Factorisation:
        """Use the factors of a matrix that was refused for a displacement that it hardly resists."""
        if self._found is None:
            raise not_factored()
        self._ready = True
        return self._found

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve; without Cholesky the residual is checked, and the solution refined if necessary."""
        if not self._ready:
            raise not_factored()
        b = np.ascontiguousarray(self._pattern.checked_rhs(rhs).T)
        x = np.empty_like(b)
        with _memory(self._pattern, lambda: self._factors.bytes):
            self._factors.solve(b, x)
            if self._values is not None:
                self._refine(self._values, b, x)
            elif not np.isfinite(x).all():
                check_accuracy(self.name, np.nan)
        return x.T

    def memory(self) -> int:
        """State that affects later results, besides the values: whether the next matrix is tried with Cholesky."""
        return int(self._positive)

    def recall(self, kind: int) -> None:
        """Restore the kind of factors of a run."""
        self._positive = kind == 1 and self._pattern.symmetric

    def _inspected(self, values: FloatArray) -> tuple[int, bool, Loose | None]:
        """Negative pivots, sign of the determinant, and a displacement without resistance.

        That is found from a weak pivot, or for the first matrix of a pattern from a solution.
        """
        pivots, iteration = self._factors.pivots(), cache(partial(self._iteration, values))
        negative, odd = pivots.negative, pivots.odd
        size = values[self._pattern.indptr[:-1]] if self._with_cholesky else self._factors.column_sizes
        lost = weak_pivot(pivots.size, size, lambda *start: iteration().resistance(*start))
        del pivots, size  # a solution needs as much memory again
        if lost is None and not self._asked:
            resistance = iteration().resistance
            lost = large_solution(self._pattern.n, partial(resistance, solves=1), resistance)
        self._asked = True
        if lost is not None and lost.motion is not None:
            lost = Loose(lost.equation, iteration().column * lost.motion)
        return negative, odd, lost

    def _iteration(self, values: FloatArray) -> Iteration:
        """Inverse iteration with the factors."""
        row, column = self._factors.scales
        if self._with_cholesky:
            row = column = 1.0 / np.sqrt(values[self._pattern.indptr[:-1]])
        elif not row.size:
            row = column = np.ones(self._pattern.n)

        def solve(b: FloatArray) -> FloatArray:
            x = np.empty_like(b)
            self._factors.solve(b, x)
            return x

        def magnitude(x: FloatArray) -> FloatArray:
            product = np.empty_like(x)
            self._factors.residual_of_magnitudes(values, np.zeros_like(x), x, product)
            return -product

        return Iteration(row, column, solve, magnitude)

    def _refine(self, values: FloatArray, b: FloatArray, x: FloatArray) -> None:
        """Refine the solution while its residual is large; refuse it if that does not help."""
        residual, change = np.empty_like(b), np.empty_like(b)
        size = float(self._factors.column_sizes.max())
        row, column = self._factors.scales
        for left in range(_STEPS, -1, -1):
            self._factors.residual(values, b, x, residual)
            if row.size:  # of the eliminated equations
                error = backward_error((residual * row).T, size, (x / column).T, (b * row).T)
            else:
                error = backward_error(residual.T, size, x.T, b.T)
            if not error > _POOR_RESIDUAL or left == 0:
                break
            self._factors.solve(residual, change)
            x += change
        check_accuracy(self.name, error)


@contextmanager
def _memory(pattern: Pattern, needed: Callable[[], int]) -> Iterator[None]:
    """Reject factors that exceed the memory of the machine, and report it if memory is exhausted later."""
    if needed() > _installed():
        raise _too_large(pattern, needed())
    try:
        yield
    except MemoryError as error:
        raise _too_large(pattern, needed()) from error


def _installed() -> float:
    """Memory of the machine in bytes; infinity if unknown."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return np.inf


def _too_large(pattern: Pattern, needed: int) -> SolveError:
    return SolveError(
        "There is not enough memory for the factors of the matrix",
        where=f"{pattern.n} equations, {pattern.nnz} entries",
        value=f"{needed / 1e9:.3g} GB for the factors" if needed else None,
        cause="the model is too large for this machine, or other programs hold its memory",
        remedy="take fewer elements, or a machine with more memory",
    )
