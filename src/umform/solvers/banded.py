"""Cholesky factorisation in band storage by LAPACK, for long narrow strips: symmetric matrices only.

For comparison: on strips up to a bandwidth of 32 it is as fast as the multifrontal solver, but not faster. The latter
takes over for matrices that are not positive definite, and counts their negative pivots.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..errors import InvalidValue
from .band_order import bandwidth, orders
from .multifrontal import Multifrontal
from .protocol import Factorisation, FloatArray, Pattern, not_factored, singular, vanishing_pivot


class Banded:
    """Band Cholesky factorisation, with the multifrontal solver as a fallback."""

    name = "banded"
    _back_substitute: Callable[[FloatArray], FloatArray] | None = None

    def analyse(self, pattern: Pattern) -> None:
        """Find the order with the smallest bandwidth and the map of the values into the band."""
        if not pattern.symmetric:
            raise InvalidValue(
                "The solver 'banded' takes symmetric matrices only",
                where="solver",
                cause="friction, or an unsymmetric law",
                remedy="choose 'auto'",
            )
        rows, columns = pattern.rows, pattern.indices
        places = min(orders(pattern), key=lambda place: bandwidth(place, rows, columns))
        i, j = places[rows], places[columns]
        self.bandwidth = bandwidth(places, rows, columns)
        self._pattern = pattern
        self._places = places
        self._scatter = np.minimum(i, j) * (self.bandwidth + 1) + np.abs(i - j)
        self._diagonal = pattern.indptr[:-1]
        self._fallback: Multifrontal | None = None
        self._back_substitute = None

    def factor(self, values: FloatArray) -> Factorisation:
        """Factorise by Cholesky, or by the multifrontal solver if a pivot is not positive."""
        self._back_substitute = None
        values = self._pattern.checked(values)
        from scipy.linalg import lapack  # the import is slow

        band = np.zeros((self._pattern.n, self.bandwidth + 1))  # each row stores a column of the lower triangle
        band.reshape(-1)[self._scatter] = values
        self._band, first_bad = lapack.dpbtrf(band.T, lower=1, overwrite_ab=1)
        if first_bad:
            return self._factor_indefinite(values)
        weakest = vanishing_pivot(self._band[0, self._places] ** 2, values[self._diagonal])
        if weakest is not None:
            raise singular(self.name, weakest)
        self._back_substitute = self._solve_band
        return Factorisation(negative_pivots=0, fill=band.size)

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve with the last factors."""
        if self._back_substitute is None:
            raise not_factored()
        return self._back_substitute(rhs)

    def _factor_indefinite(self, values: FloatArray) -> Factorisation:
        if self._fallback is None:
            self._fallback = Multifrontal()
            self._fallback.analyse(self._pattern)
        self._fallback.recall(0)  # known not to be positive definite
        factorisation = self._fallback.factor(values)
        self._back_substitute = self._fallback.solve
        return factorisation

    def _solve_band(self, rhs: FloatArray) -> FloatArray:
        from scipy.linalg import lapack

        rhs = self._pattern.checked_rhs(rhs)
        b = np.empty(rhs.shape, order="F")
        b[self._places] = rhs
        return np.asarray(lapack.dpbtrs(self._band, b, lower=1, overwrite_b=1)[0][self._places])
