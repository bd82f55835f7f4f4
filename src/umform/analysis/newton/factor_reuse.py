"""Modified Newton: reuse factors where its slower convergence costs less than a factorisation.

The tangent changes by a small multiple, `fall`, of the ratio of the last two increments. With old factors residual and
increment fall by this factor in each iteration, with new ones quadratically. Both are counted to the tolerances, and
each iteration is weighted: 1 for evaluation and solve, plus the cost of a factorisation. This cost is estimated from
the entries of the factors, not measured, so that a run is reproducible to the last bit. docs/performance-solving.md
"""

from __future__ import annotations

import math

from umform.analysis.newton.options import NewtonOptions
from umform.solvers import Factorisation

#: Cost of a factorisation, relative to an evaluation with a solve, below which factors are never reused.
_CHEAP = 1.0
#: Ratio of the residual left by old factors to the ratio of two increments: 2 in theory, 1 to 4 as measured.
_FALL = 3.0
#: Reduction per iteration above which old factors are not worthwhile.
_SLOW = 0.2
#: Nanoseconds, whose ratios alone count: of a factorisation for each entry of the factors times their mean number in a
#: column, of a solve for each of them, of an evaluation of effort 1 for each equation. benchmarks/reuse.py prints them.
_FACTOR, _SOLVE, _EVALUATE = 0.055, 1.5, 1450.0


def cost_of_factors(fill: int, equations: int, effort: float) -> float:
    """Cost of a factorisation over that of evaluation and solve, see :attr:`umform.Model.effort`."""
    column = fill / equations
    return _FACTOR * column * column / (_EVALUATE * effort + _SOLVE * column)


class Reuse:
    """Decides for the iterations of one increment, and keeps data of the last factorisation.

    Parameters
    ----------
    options : NewtonOptions
        Tolerances, and the cost of a factorisation if given.
    equations : int
        Of the matrix.
    effort : float
        Cost of an evaluation for each equation.
    """

    def __init__(self, options: NewtonOptions, equations: int, effort: float) -> None:
        self._options, self._equations, self._effort = options, equations, effort
        self._cost = 0.0
        self._increment: float | None = None  # of the iteration before
        self._residual = 0.0
        self._old = False  # whether the previous iteration had old factors

    @property
    def dear(self) -> bool:
        """Whether a factorisation is expensive enough for reuse."""
        return self._cost >= _CHEAP

    def factors_will_do(self, residual: float, increment: float, *, settled: bool) -> bool:
        """Whether the next iteration may use the previous factors.

        Parameters
        ----------
        residual, increment : float
            Without units, as :class:`umform.analysis.newton.newton.Iteration` has them.
        settled : bool
            Whether the tangent changes with the increment only: the active set of contact is that of the previous
            iteration.
        """
        before, self._increment = self._increment, increment
        fall = _FALL * increment / before if before else 1.0
        if (
            before is None and self.dear
        ):  # factors of the first increment: the remaining residual is quadratic in the change
            fall = _FALL * math.sqrt(residual)
        if self._old:  # measured, not estimated
            fall = max(residual / self._residual, increment / before if before else 1.0)
        self._residual = residual
        self._old = (
            settled
            and self.dear
            and fall <= _SLOW
            and self._count(residual, increment, fall, old=True)
            < self._count(residual, increment, fall, old=False) * (1.0 + self._cost)
        )
        return self._old

    def remember(self, factorisation: Factorisation) -> int | None:
        """Store the cost of new factors; return their negative pivots."""
        given = self._options.factor_cost
        self._cost = cost_of_factors(factorisation.fill, self._equations, self._effort) if given is None else given
        return factorisation.negative_pivots

    def _count(self, residual: float, increment: float, fall: float, *, old: bool) -> int:
        """Iterations to the tolerances."""
        count = 0
        while count == 0 or residual > self._options.residual or increment > self._options.increment:
            if not old:
                fall *= fall
            residual, increment, count = fall * residual, fall * increment, count + 1
        return count
