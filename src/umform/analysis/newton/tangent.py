"""The tangent of the iterations of one increment: when it is evaluated, factorised, shifted."""

from __future__ import annotations

import math

from umform.analysis.newton.bordered import Bordered
from umform.analysis.newton.divergence_guard import DivergenceGuard
from umform.analysis.newton.options import IterationMode, NewtonOptions
from umform.analysis.newton.shift import Shift
from umform.analysis.newton.system import Evaluation, State, System
from umform.results.records import First, Iteration

#: The factors of a predictor reduce its residual, which is quadratic in the change of the tangent, by so many times the
#: square root of it; 2 in theory.
_FALL = 3.0


class Tangent:
    """Keeps a solver factorised for the iterations of one increment.

    Parameters
    ----------
    system, solver, options, mode, guard
        Of the iterations.
    first : First, optional
        Factors of the predictor.

    Attributes
    ----------
    pivots : int or None
        Negative pivots of the last factors.
    shifted : bool
        Whether the last factors are those of a shifted tangent. eq. (5.54)
    forces_first : bool
        Whether the next evaluation is of forces only, as in a linear step: the factors of the predictor serve again.
    entry : float or None
        Largest entry of the tangent, for evaluations without one.
    """

    def __init__(
        self,
        system: System,
        solver: Bordered,
        options: NewtonOptions,
        mode: IterationMode,
        guard: DivergenceGuard,
        first: First | None,
    ) -> None:
        self._system, self._solver, self._mode, self._guard = system, solver, mode, guard
        self._tolerance, self._shift = options.residual, Shift(system)
        self.pivots = None if first is None else first.factors.negative_pivots
        self.entry = None if first is None else first.entry
        self.shifted, self.forces_first = False, first is not None and system.smooth and not self.searches

    def use(self, solver: Bordered) -> None:
        """Use a solver that has analysed the present pattern, after that has changed; it has no factors yet."""
        self._solver, self._shift = solver, Shift(self._system)

    @property
    def searches(self) -> bool:
        """Whether increments are shortened if they are too long."""
        return self._mode.line_search or self._guard.jumps

    def factor(self, goal: State, evaluation: Evaluation, residual: float, iterations: list[Iteration]) -> Evaluation:
        """Factorise the tangent, unless the step is linear; return its evaluation.

        Parameters
        ----------
        goal : State
            Time and controls of the increment.
        evaluation : Evaluation
            The present one, perhaps of forces only.
        residual : float
            Relative to the forces.
        iterations : list of Iteration
            The previous ones.

        Raises
        ------
        Failed
            If the tangent is indefinite far from equilibrium.
        """
        system, guard = self._system, self._guard
        if self.forces_first:
            if _FALL * math.sqrt(residual) * residual <= self._tolerance:
                system.follow()
                return evaluation
            evaluation, self.forces_first = system.evaluate(system.state_at(evaluation.x, goal)), False
        pivots = self._solver.factor(evaluation).negative_pivots
        guard.check_pivots(pivots, residual, iterations)
        asked = guard.needs_symmetric_part(residual)
        self.pivots = self._shift.negative_pivots(evaluation, pivots, asked=asked)
        self.shifted = guard.shifts(self.pivots)
        if self.shifted:
            self._shift.factor(self._solver, evaluation)
        self.entry = None
        return evaluation

    def follow(self) -> None:
        """After an evaluation of forces only: let the next recovery use them."""
        if self.forces_first:
            self._system.follow()
