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

from umform.analysis.newton.system import Evaluation, System

Floats = NDArray[np.float64]

EPS = float(np.finfo(float).eps)

#: Largest resultant of the residual, relative to the forces of the tools, over the tolerance of its norm; the least
#: such limit; and the part of the force scale below which the forces of tools are no reference. eq. (5.130)
_RESULTANT, _LEAST_RESULTANT, _OF_SCALE = 10.0, 1e-6, 0.01
#: Largest residual, and largest increment, of a state above the tolerance that is accepted where no increment is small
#: enough: the tolerances of drawing. eq. (5.131)
SETTLED_RESIDUAL, SETTLED_INCREMENT = 1e-3, 1e-2


class Criteria:
    """Judges the successive iterations of one increment.

    Parameters
    ----------
    system : System
        The system to solve.
    residual, increment : float
        Tolerances.
    settled : float
        Residual, relative to the forces, at which iterations end, above the tolerance; zero: none. eq. (5.131)
    rests : bool
        Whether the set of touching points should come to rest: up to two more iterations wait for it.
    """

    def __init__(
        self, system: System, residual: float, increment: float, settled: float = 0.0, *, rests: bool = True
    ) -> None:
        self._system, self._residual, self._increment = system, residual, increment
        self._granted, self._at_floor = 0 if rests else 2, 0
        self.settled = settled
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
            Whether contact points have just opened or closed.
        solved : bool
            Whether the last increment is the solution for a residual; a prediction may be zero without equilibrium.
        """
        displacement = largest(self._system, u, evaluation)
        floor = self.floor(displacement, evaluation)
        scale = evaluation.force_scale or 1.0
        small = norm <= max(self._residual * scale, floor) and increment <= self._increment
        small = small or (solved and self._nothing_left(norm, displacement * max(1.0, increment), evaluation))
        if small and norm > floor:
            small = self._balanced(evaluation, scale)
        self._at_floor = self._at_floor + 1 if norm <= floor else 0
        if (small and (not moved or self._granted >= 2)) or self._at_floor >= 2:
            return True
        self._granted += small
        return solved and norm <= self.settled * scale and increment <= SETTLED_INCREMENT

    def _balanced(self, evaluation: Evaluation, scale: float) -> bool:
        """Whether the resultant of the residual is small beside the forces of the tools. eq. (5.130)"""
        resultant, tools = self._system.resultants(evaluation)
        limit = max(_RESULTANT * self._residual, _LEAST_RESULTANT)
        return tools == 0.0 or resultant <= limit * max(tools, _OF_SCALE * scale)

    def floor(self, displacement: float, evaluation: Evaluation) -> float:
        """Residual due to round-off of the largest displacement and of the gaps. eqs. (5.10), (5.36)"""
        return math.hypot(self._round_off(evaluation, displacement), EPS * evaluation.round_off)

    def _nothing_left(self, norm: float, displacement: float, evaluation: Evaluation) -> bool:
        """Whether displacement, last increment and residual are below the round-off of positions. eq. (5.40)"""
        extent = self._system.extent
        return displacement <= EPS * extent and norm <= self._round_off(evaluation, extent)

    def _round_off(self, evaluation: Evaluation, length: float) -> float:
        """Residual due to a relative error of such lengths. eqs. (5.10), (5.40)"""
        system = self._system
        entry = system.largest_entry(evaluation.values) if self.entry is None else self.entry
        return EPS * entry * length * math.sqrt(system.pattern.n)


def largest(system: System, x: Floats, evaluation: Evaluation) -> float:
    """Largest displacement of a node, over all ranks; scalar unknowns have other units."""
    return system.ranks.max(float(np.abs(x[: x.size - len(evaluation.border.unknowns)]).max()))
