"""Whether old factors will do: Newton's method modified where its slower convergence costs less than a factorisation.

The tangent changes by what the last increment is relative to the one before; by a small multiple of this, `fall`, old
factors bring residual and increment down in each iteration, new ones quadratically. Both are counted up to the
tolerances, and each iteration weighed: 1 for evaluation and solve, and the cost of a factorisation on top. That cost is
estimated from the entries of the factors, never from a clock: a run repeats to the last bit.
docs/performance-solving.md
"""

from __future__ import annotations

import math

from umform.solution.options import NewtonOptions
from umform.solvers import Factorisation

#: Where new factors cost less than this, in evaluations with a solve, they are made always.
_CHEAP = 1.0
#: From the ratio of two increments to what old factors leave of the residual: 2 in theory, 1 to 4 as measured.
_FALL = 3.0
#: Slower than this old factors are not worth a thought.
_SLOW = 0.2
#: Nanoseconds, whose ratios alone count: of a factorisation for each entry of the factors times their mean number in a
#: column, of a solve for each of them, of an evaluation of effort 1 for each equation. benchmarks/reuse.py prints them.
_FACTOR, _SOLVE, _EVALUATE = 0.055, 1.5, 1450.0


def cost_of_factors(fill: int, equations: int, effort: float) -> float:
    """Factorisation over evaluation and solve, from the entries of the factors and :attr:`umform.Model.effort`."""
    column = fill / equations
    return _FACTOR * column * column / (_EVALUATE * effort + _SOLVE * column)


class Reuse:
    """Decides for the iterations of one increment, and hands on what is known of the last factorisation.

    Parameters
    ----------
    options : NewtonOptions
        Tolerances, and the cost of a factorisation if that is given.
    equations : int
        Of the matrix.
    effort : float
        Of an evaluation, for each equation.
    """

    def __init__(self, options: NewtonOptions, equations: int, effort: float) -> None:
        self._options, self._equations, self._effort = options, equations, effort
        self._cost = 0.0
        self._increment: float | None = None  # of the iteration before
        self._residual = 0.0
        self._old = False  # whether the iteration before had old factors

    @property
    def dear(self) -> bool:
        """Whether a factorisation costs so much that old factors may serve."""
        return self._cost >= _CHEAP

    def factors_will_do(self, residual: float, increment: float, *, settled: bool) -> bool:
        """Whether the next iteration may take the factors of the one before.

        Parameters
        ----------
        residual, increment : float
            Without units, as :class:`umform.solution.newton.Iteration` has them.
        settled : bool
            Whether the tangent changes with the increment only: the active set of contact is that of the iteration
            before.
        """
        before, self._increment = self._increment, increment
        fall = _FALL * increment / before if before else 1.0
        if (
            before is None and self.dear
        ):  # the factors of the first increment, which leaves what is quadratic in the change
            fall = _FALL * math.sqrt(residual)
        if self._old:  # seen, not guessed
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
        """Keep what new factors cost; return their negative pivots."""
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
