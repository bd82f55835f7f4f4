"""Safeguards against divergence: contact that cycles, a residual that stagnates, indefinite tangents.

docs/theory, 4.9
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import IndefiniteTangent
from umform.analysis.newton.system import Evaluation, System
from umform.results.records import Cause, Failed, Iteration

#: A residual that is far from equilibrium, relative to the force scale.
_FAR = 0.1
#: A jump to the next stable state, or contact that sorts itself out in an undeformed sheet, may take so many times the
#: iterations of an increment; where points of contact still come and go at so many times the tolerance of the residual,
#: twice as many.
_LONG, _NEAR, _LONGER = 4, 3.0, 2


class DivergenceGuard:
    """Watches the successive iterations of one increment: shortens, shifts, extends or ends them.

    Parameters
    ----------
    system : System
        What is iterated.
    indefinite : IndefiniteTangent
        Response to an indefinite tangent far from equilibrium.
    extended : bool
        Whether more iterations are allowed from the beginning.

    Attributes
    ----------
    jumps : bool
        Whether the iterations go down to the next stable state, however far it is. eq. (5.102)
    """

    def __init__(
        self,
        system: System,
        indefinite: IndefiniteTangent = IndefiniteTangent.IGNORED,
        *,
        extended: bool = False,
    ) -> None:
        self._cycle, self._indefinite, self._extended = Cycle(system), indefinite, extended
        self._stall = None if system.smooth else Stall()
        self._status: NDArray[np.uint8] | None = None  # of the previous iteration
        self._pivots = 0
        self._downhill = self.jumps = False

    def iteration_limit(self, usual: int, iterations: list[Iteration], tolerance: float) -> int:
        """Largest number of iterations.

        Parameters
        ----------
        usual : int
            That of a usual increment.
        iterations : list of Iteration
            Those so far.
        tolerance : float
            Of the residual, relative to the force scale.
        """
        if self.jumps or self._extended:
            return _LONG * usual
        last = iterations[-1] if iterations else None
        near = last is not None and last.residual <= _NEAR * tolerance and last.entered + last.left > 0
        return _LONGER * usual if near else usual

    def needs_symmetric_part(self, residual: float) -> bool:
        """Whether the stability of an unsymmetric tangent is worth the factors of its symmetric part. eq. (5.101)

        It is after a cycle of contact, on the way down, and near equilibrium in the last attempt; parameter as of
        `check_pivots`.
        """
        last = self._indefinite is IndefiniteTangent.STOPS_BEFORE_JUMP and residual <= _FAR
        return self._cycle.met or self._downhill or last

    def longest_step(self, evaluation: Evaluation, norm: float, iterations: list[Iteration]) -> float:
        """Part of the next increment to apply; to be called once in each iteration.

        Parameters
        ----------
        evaluation : Evaluation
            Of this iteration.
        norm : float
            Of the residual of the unknowns.
        iterations : list of Iteration
            The previous ones.

        Raises
        ------
        Failed
            If convergence is not expected.
        """
        cycle, stall, before = self._cycle, self._stall, self._status
        self._status = evaluation.status
        longest = 0.5 if cycle.seen(evaluation.status, [record.residual for record in iterations]) else 1.0
        if cycle.stays:
            where = evaluation.at_points(evaluation.status != before)
            raise Failed(f"contact comes and goes in a cycle{where}", iterations, Cause.CYCLE)
        if stall is not None and not self._downhill and stall.seen(norm):  # downhill, the residual may grow
            raise Failed(f"the residual has not fallen for {stall.patience} iterations", iterations, Cause.STALL)
        return longest

    def check_pivots(self, pivots: int | None, residual: float, iterations: list[Iteration]) -> None:
        """Check the negative pivots of a new tangent.

        Parameters
        ----------
        pivots : int or None
            Their number, if the solver reports it.
        residual : float
            Relative to the force scale.
        iterations : list of Iteration
            The previous ones.

        Raises
        ------
        Failed
            If there are too many far from equilibrium.
        """
        before, self._pivots = self._pivots, pivots or 0
        if residual <= _FAR or not pivots or self.jumps:
            return
        more = self._indefinite is IndefiniteTangent.STOPS_IF_MORE and pivots > before > 0
        if self._indefinite.stops or more:
            reason = f"the tangent has {pivots} negative pivots far from equilibrium"
            raise Failed(reason, iterations, Cause.INDEFINITE)

    def shifts(self, pivots: int | None) -> bool:
        """Whether an indefinite tangent is shifted, so that the increment is a descent direction.

        It is if the last equilibrium was stable, and if contact has cycled; parameter as of `check_pivots`.
        """
        wanted = bool(pivots) and (self._indefinite.stops or self._cycle.met)
        self._downhill = self._downhill or wanted
        self.jumps = self.jumps or (wanted and self._indefinite is IndefiniteTangent.STOPS_BEFORE_JUMP)
        return wanted


class Cycle:
    """Detects contact points that cycle while the residual does not fall.

    Attributes
    ----------
    stays : bool
        Whether a cycle occurred again after a measure against the first one.
    """

    def __init__(self, system: System) -> None:
        self._system = system
        self._states: list[bytes] = []
        self._begin = self._count = 0

    @property
    def met(self) -> bool:
        """Whether a cycle occurred."""
        return self._count > 0

    @property
    def stays(self) -> bool:
        """Whether a cycle occurred again."""
        return self._count > 1

    def seen(self, status: NDArray[np.uint8], residuals: Sequence[float]) -> bool:
        """Whether two or three states have just repeated twice; to be called once in each iteration.

        Parameters
        ----------
        status : ndarray of uint8
            Status of the points in this iteration: open, held, slipping.
        residuals : sequence of float
            Those of the previous iterations.
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
    """Detects a residual that has not fallen by a tenth over a number of iterations.

    Attributes
    ----------
    patience : int
        That number.
    """

    patience = 8

    def __init__(self) -> None:
        self._least, self._since = math.inf, 0

    def seen(self, norm: float) -> bool:
        """Whether the residual stagnates; to be called once in each iteration."""
        if norm < 0.9 * self._least:
            self._least, self._since = norm, 0
        else:
            self._since += 1
        return self._since >= self.patience
