"""The tangent of the iterations of one increment: when it is evaluated, factorised, reused, shifted."""

from __future__ import annotations

from umform.analysis.newton.bordered import Bordered
from umform.analysis.newton.divergence_guard import DivergenceGuard
from umform.analysis.newton.factor_reuse import Reuse
from umform.analysis.newton.options import IterationMode, NewtonOptions
from umform.analysis.newton.shift import Shift
from umform.analysis.newton.system import Evaluation, State, System
from umform.results.records import First, Iteration


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
        Whether the next evaluation is of forces only: where factors are expensive, they may serve again.
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
        self._options = options
        self._reuse, self._shift = Reuse(options, system.pattern.n, system.effort), Shift(system)
        self.pivots = None if first is None else self._reuse.remember(first.factors)
        self.entry = None if first is None else first.entry
        self.shifted, self.forces_first = False, first is not None and self._saves

    def use(self, solver: Bordered) -> None:
        """Use a solver that has analysed the present pattern, after that has changed; it has no factors yet."""
        system = self._system
        self._solver, self._shift = solver, Shift(system)
        self._reuse = Reuse(self._options, system.pattern.n, system.effort)

    @property
    def _saves(self) -> bool:
        return self._reuse.dear and not self.searches and self._system.smooth

    @property
    def searches(self) -> bool:
        """Whether increments are shortened if they are too long."""
        return self._mode.line_search or self._guard.jumps

    def factor(
        self,
        goal: State,
        evaluation: Evaluation,
        residual: float,
        increment: float,
        iterations: list[Iteration],
        *,
        moved: bool,
    ) -> Evaluation:
        """Factorise the tangent, unless the previous factors will do; return its evaluation.

        Parameters
        ----------
        goal : State
            Time and controls of the increment.
        evaluation : Evaluation
            The present one, perhaps of forces only.
        residual, increment : float
            Without units, as :class:`umform.results.records.Iteration` has them.
        iterations : list of Iteration
            The previous ones.
        moved : bool
            Whether contact points have opened or closed, begun or ceased to slip.

        Raises
        ------
        Failed
            If the tangent is indefinite far from equilibrium.
        """
        system, guard = self._system, self._guard
        if self._reuse.factors_will_do(residual, increment, settled=self._mode.reuses and not moved):
            self.follow()
            return evaluation
        if self.forces_first:
            evaluation = system.evaluate(system.state_at(evaluation.x, goal))
        pivots = self._reuse.remember(self._solver.factor(evaluation))
        guard.check_pivots(pivots, residual, iterations)
        asked = guard.needs_symmetric_part(residual)
        self.pivots = self._shift.negative_pivots(evaluation, pivots, asked=asked)
        self.shifted = guard.shifts(self.pivots)
        if self.shifted:
            self._shift.factor(self._solver, evaluation)
        self.entry = system.largest_entry(evaluation.values)
        return evaluation

    def follow(self) -> None:
        """After an evaluation of forces only: let the next recovery use them."""
        if self.forces_first:
            self._system.follow()

    def plan(self, evaluation: Evaluation) -> None:
        """Choose what the next evaluation is of, from the present one."""
        self.forces_first = self._saves and not evaluation.border.unknowns
        self.entry = self.entry if self.forces_first else None
