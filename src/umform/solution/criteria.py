"""Convergence criteria. docs/theory, 5.3

Convergence requires a small residual and a small increment, both dimensionless: the residual relative to the root of
the sum of squares of all element forces, the increment relative to the largest displacement. Neither falls below
round-off, which is estimated in each iteration: a residual below it is small, and two in a row end the iteration even
if the increment cannot become small (sheets so thin that round-off moves them). eqs. (5.8)-(5.11), (5.36), (5.40)
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from umform.solution.system import Evaluation, System

Floats = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)


class Criteria:
    """Judges the successive iterations of one increment.

    Parameters
    ----------
    system : System
        The system to solve.
    residual, increment : float
        Tolerances.
    """

    def __init__(self, system: System, residual: float, increment: float) -> None:
        self._system, self._residual, self._increment = system, residual, increment
        self._granted = self._at_floor = 0
        #: Largest entry of the tangent, for evaluations without one.
        self.entry: float | None = None

    def met(
        self, norm: float, increment: float, u: Floats, evaluation: Evaluation, *, moved: bool, solved: bool
    ) -> bool:
        """Whether the iteration has converged; to be called once in each.

        Parameters
        ----------
        norm : float
            Of the residual of the unknowns.
        increment : float
            The last one, relative to the largest displacement.
        u : ndarray, shape (3 n,)
            Displacement.
        evaluation : Evaluation
            The residual and tangent there.
        moved : bool
            Whether contact points opened or closed; two more iterations are then allowed.
        solved : bool
            Whether the last increment is the solution for a residual; a prediction may be zero without equilibrium.
        """
        displacement = largest(self._system, u, evaluation)
        floor = self.floor(displacement, evaluation)
        scale = evaluation.force_scale or 1.0
        small = norm <= max(self._residual * scale, floor) and increment <= self._increment
        small = small or (solved and self._nothing_left(norm, displacement * max(1.0, increment), evaluation))
        self._at_floor = self._at_floor + 1 if norm <= floor else 0
        if (small and (not moved or self._granted >= 2)) or self._at_floor >= 2:
            return True
        self._granted += small
        return False

    def floor(self, displacement: float, evaluation: Evaluation) -> float:
        """Residual due to round-off of the largest displacement and of the gaps. eqs. (5.10), (5.36)"""
        return math.hypot(self._round_off(evaluation, displacement), _EPS * evaluation.round_off)

    def _nothing_left(self, norm: float, displacement: float, evaluation: Evaluation) -> bool:
        """Whether displacement, last increment and residual are below the round-off of positions. eq. (5.40)"""
        extent = self._system.extent
        return displacement <= _EPS * extent and norm <= self._round_off(evaluation, extent)

    def _round_off(self, evaluation: Evaluation, length: float) -> float:
        """Residual due to a relative error of such lengths. eqs. (5.10), (5.40)"""
        system = self._system
        entry = system.largest_entry(evaluation.values) if self.entry is None else self.entry
        return _EPS * entry * length * math.sqrt(system.pattern.n)


def largest(system: System, x: Floats, evaluation: Evaluation) -> float:
    """Largest displacement of a node, over all ranks; scalar unknowns have other units."""
    return system.ranks.max(float(np.abs(x[: x.size - len(evaluation.border.unknowns)]).max()))
