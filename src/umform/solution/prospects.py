"""Whether iterations are hopeless: contact that goes in circles, a residual that does not fall. docs/theory, 4.9"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform.solution.options import Wary
from umform.solution.records import Cause, Failed, Iteration
from umform.solution.system import Evaluation, System

#: A residual this large, over the force scale, is far from equilibrium.
_FAR = 0.1


class Prospects:
    """Looks at the iterations of one increment, one after the other."""

    def __init__(self, system: System) -> None:
        self._cycle = Cycle(system)
        self._stall = None if system.smooth else Stall()
        self._pivots = 0
        self._downhill = False

    def longest(
        self, evaluation: Evaluation, before: NDArray[np.uint8], norm: float, iterations: list[Iteration]
    ) -> float:
        """Part of the next increment that may be taken; asked once in each iteration.

        Parameters
        ----------
        evaluation : Evaluation
            Of this iteration.
        before : ndarray of uint8
            Status of the contact points in the iteration before.
        norm : float
            Of the residual of the unknowns.
        iterations : list of Iteration
            Those before.

        Raises
        ------
        Failed
            If there is no hope.
        """
        cycle, stall = self._cycle, self._stall
        longest = 0.5 if cycle.seen(evaluation.status, [record.residual for record in iterations]) else 1.0
        if cycle.stays:
            where = evaluation.at_points(evaluation.status != before)
            raise Failed(f"contact comes and goes in a cycle{where}", iterations, Cause.CYCLE)
        if stall is not None and not self._downhill and stall.seen(norm):  # downhill the residual may grow
            raise Failed(f"the residual has not fallen for {stall.patience} iterations", iterations, Cause.STALL)
        return longest

    def bear(self, pivots: int | None, residual: float, wary: Wary, iterations: list[Iteration]) -> None:
        """Look at the negative pivots of the tangent; asked where there is a new one.

        Parameters
        ----------
        pivots : int or None
            Their number, where the solver tells.
        residual : float
            Over the force scale.
        wary : Wary
            What is borne.
        iterations : list of Iteration
            Those before.

        Raises
        ------
        Failed
            If there are too many far from equilibrium.
        """
        before, self._pivots = self._pivots, pivots or 0
        if residual <= _FAR or not pivots:
            return
        if wary is Wary.OF_ANY or (wary is Wary.OF_MORE and pivots > before > 0):
            reason = f"the tangent has {pivots} negative pivots far from equilibrium"
            raise Failed(reason, iterations, Cause.INDEFINITE)

    def shifts(self, pivots: int | None, wary: Wary) -> bool:
        """Whether an indefinite tangent is shifted, so that the increment goes downhill; parameters as of `bear`.

        It is where the last equilibrium was stable, and where contact has gone in a cycle.
        """
        wanted = bool(pivots) and (wary is Wary.OF_ANY or self._cycle.met)
        self._downhill = self._downhill or wanted
        return wanted


class Cycle:
    """Sees contact points come and go in a cycle while the residual does not fall.

    Attributes
    ----------
    stays : bool
        Whether a cycle was seen again after the first one was to be broken.
    """

    def __init__(self, system: System) -> None:
        self._system = system
        self._states: list[bytes] = []
        self._begin = self._count = 0

    @property
    def met(self) -> bool:
        """Whether a cycle was seen."""
        return self._count > 0

    @property
    def stays(self) -> bool:
        """Whether a cycle was seen again."""
        return self._count > 1

    def seen(self, status: NDArray[np.uint8], residuals: Sequence[float]) -> bool:
        """Whether two or three states have just followed each other twice; asked once in each iteration.

        Parameters
        ----------
        status : ndarray of uint8
            Which points are open, held, slipping in this iteration.
        residuals : sequence of float
            Those of the iterations before.
        """
        ranks = self._system.ranks
        if not ranks.any(status.size > 0):
            return False
        self._states.append(ranks.join(status.tobytes()))
        for period in (2, 3):
            states = self._states[self._begin :][-2 * period :]
            if len(states) < 2 * period or len(residuals) < period + 1:
                continue
            cycle = states[:period] == states[period:] and len(set(states)) > 1
            if cycle and residuals[-1] > 0.5 * residuals[-1 - period]:
                self._begin, self._count = len(self._states), self._count + 1
                return True
        return False


class Stall:
    """Sees a residual that has not fallen by a tenth for a number of iterations.

    Attributes
    ----------
    patience : int
        That number.
    """

    patience = 8

    def __init__(self) -> None:
        self._least, self._since = math.inf, 0

    def seen(self, norm: float) -> bool:
        """Whether it has not; asked once in each iteration."""
        if norm < 0.9 * self._least:
            self._least, self._since = norm, 0
        else:
            self._since += 1
        return self._since >= self.patience
