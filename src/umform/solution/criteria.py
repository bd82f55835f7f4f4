"""When an iteration is converged, and when it goes in circles. docs/theory, 5.3 and 4.9

Convergence asks for a small residual AND a small increment, both without units: the residual against the root of the
sum of squares of all element forces, the increment against the largest displacement. Neither can fall below round-off,
so the floor that round-off sets is estimated in each iteration: a residual below it is small, and two in a row end the
iteration even where the increment cannot become small (sheets so thin that round-off moves them).
eqs. (5.8)-(5.11), (5.36), (5.40)
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform.solution.system import Evaluation, System

Floats = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


class Criteria:
    """Judges the iterations of one increment, one after the other.

    Parameters
    ----------
    system : System
        What is iterated on.
    residual, increment : float
        Tolerances.
    """

    def __init__(self, system: System, residual: float, increment: float) -> None:
        self._system, self._residual, self._increment = system, residual, increment
        self._granted = self._at_floor = 0
        #: Largest entry of the tangent, where evaluations have none.
        self.entry: float | None = None

    def met(self, norm: float, increment: float, u: Floats, evaluation: Evaluation, *, moved: bool) -> bool:
        """Whether the iteration has converged; asked once in each.

        Parameters
        ----------
        norm : float
            Of the residual of the unknowns.
        increment : float
            The last one, over the largest displacement.
        u : ndarray, shape (3 n,)
            Displacement.
        evaluation : Evaluation
            The residual and tangent there.
        moved : bool
            Whether contact points came or went; two iterations more are granted then.
        """
        displacement = largest(self._system, u, evaluation)
        floor = self.floor(displacement, evaluation)
        scale = evaluation.force_scale or 1.0
        small = norm <= max(self._residual * scale, floor) and increment <= self._increment
        small = small or self._nothing_left(norm, displacement * max(1.0, increment), evaluation)
        self._at_floor = self._at_floor + 1 if norm <= floor else 0
        if (small and (not moved or self._granted >= 2)) or self._at_floor >= 2:
            return True
        self._granted += small
        return False

    def floor(self, displacement: float, evaluation: Evaluation) -> float:
        """Residual that round-off of the largest displacement and of the gaps leaves behind. eqs. (5.10), (5.36)"""
        return math.hypot(self._round_off(evaluation, displacement), _EPS * evaluation.round_off)

    def _nothing_left(self, norm: float, displacement: float, evaluation: Evaluation) -> bool:
        """Whether displacement, last increment and residual are below the round-off of positions. eq. (5.40)"""
        extent = self._system.extent
        return displacement <= _EPS * extent and norm <= self._round_off(evaluation, extent)

    def _round_off(self, evaluation: Evaluation, length: float) -> float:
        """Residual that a relative error of such lengths leaves behind. eqs. (5.10), (5.40)"""
        system = self._system
        entry = system.largest_entry(evaluation.values) if self.entry is None else self.entry
        return _EPS * entry * length * math.sqrt(system.pattern.n)


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
    def stays(self) -> bool:
        """Whether a cycle was seen again."""
        return self._count > 1

    def seen(self, active: NDArray[np.bool_], residuals: Sequence[float]) -> bool:
        """Whether two or three active sets have just followed each other twice; asked once in each iteration.

        Parameters
        ----------
        active : ndarray of bool
            The active set of this iteration.
        residuals : sequence of float
            Those of the iterations before.
        """
        ranks = self._system.ranks
        if not ranks.any(active.size > 0):
            return False
        self._states.append(ranks.join(np.packbits(active).tobytes()))
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


def largest(system: System, x: Floats, evaluation: Evaluation) -> float:
    """Largest displacement of a node, over all ranks; scalar unknowns have other units."""
    return system.ranks.max(float(np.abs(x[: x.size - len(evaluation.border.unknowns)]).max()))
