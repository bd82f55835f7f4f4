"""When an iteration is converged. docs/theory, 5.3

Convergence asks for a small residual AND a small increment, both without units: the residual against the root of the
sum of squares of all element forces, the increment against the largest displacement. Neither can fall below round-off,
so the floor that round-off sets is estimated in each iteration: a residual below it is small, and two in a row end the
iteration even where the increment cannot become small (sheets so thin that round-off moves them).
eqs. (5.8)-(5.11), (5.36), (5.40)
"""

from __future__ import annotations

import math

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


def largest(system: System, x: Floats, evaluation: Evaluation) -> float:
    """Largest displacement of a node, over all ranks; scalar unknowns have other units."""
    return system.ranks.max(float(np.abs(x[: x.size - len(evaluation.border.unknowns)]).max()))
