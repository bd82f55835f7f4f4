"""Newton's method for a system that can evaluate, recover, commit and revert, independent of elements and contact.

Scalar unknowns belong to the system: the travel of force-driven tools, the load along a path. Convergence is judged by
`umform.analysis.newton.criteria`.
"""

from __future__ import annotations

import logging
import math
import time as clock
from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.bordered import Bordered
from umform.analysis.newton.criteria import EPS, Criteria, largest
from umform.analysis.newton.divergence_guard import DivergenceGuard
from umform.analysis.newton.line_search import lengthened, shortened
from umform.analysis.newton.options import IndefiniteTangent, IterationMode, NewtonOptions
from umform.analysis.newton.recorder import Recorder
from umform.analysis.newton.system import Evaluation, State, System
from umform.analysis.newton.tangent import Tangent
from umform.analysis.newton.timed_solver import TimedSolver
from umform.errors import NotFinite, SingularMatrix
from umform.results.records import Cause, Converged, Failed, First, Iteration
from umform.solvers import Pattern, make_solver
from umform.timing import Timing

log = logging.getLogger("umform.newton")

Floats = NDArray[np.float64]
_T = TypeVar("_T")

#: Displacement, relative to the extent of the sheet, that indicates an unsupported sheet.
_FLIGHT = 1e4
#: Residual, relative to the forces, at which iterations end where a penalty will grow. docs/theory, 4.11
_NEAR = 1e-2


@dataclass
class _Analysed:
    """A solver, and the pattern that it has analysed; methods with other tolerances share it."""

    solver: Bordered | None = None
    pattern: Pattern | None = None


class Newton:
    """Newton's method with a solver that keeps its symbolic factorisation while the pattern is unchanged."""

    def __init__(
        self,
        system: System,
        options: NewtonOptions | None = None,
        solver: str = "auto",
        timing: Timing | None = None,
    ) -> None:
        self.system = system
        self.timing = timing or Timing()
        self.options = options or NewtonOptions()
        self.solver_name = solver
        self._analysed = _Analysed()
        self.callbacks: list[Callable[[Iteration], None]] = []
        #: Whether the sheet springs back, nearly elastic, even if its laws have a history. docs/theory, 5.13
        self.springs_back = False
        #: Relative residual at which iterations end, above the tolerance; zero: none. eq. (5.131)
        self.settled = 0.0

    def but(
        self, *, residual: float | None = None, settled: float | None = None, springs_back: bool | None = None
    ) -> Self:
        """The same method with other tolerances, or for a sheet that springs back; it shares the sparse solver.

        Parameters
        ----------
        residual : float, optional
            Tolerance of the residual.
        settled, springs_back : optional
            The attributes.
        """
        other = copy(self)
        if residual is not None:
            other.options = replace(self.options, residual=residual)
        other.settled = self.settled if settled is None else settled
        other.springs_back = self.springs_back if springs_back is None else springs_back
        return other

    @property
    def solver(self) -> str:
        """Name of the sparse solver for the system."""
        return self.ready_solver().solver.name

    @property
    def mixed(self) -> bool:
        """Whether tangents have the geometric stiffness of the stress predicted by the last increment. eq. (5.39)"""
        return self._elastic if self.options.mixed is None else self.options.mixed

    @cached_property
    def _has_history(self) -> bool:
        return not self.system.elastic

    @property
    def _elastic(self) -> bool:
        """Whether the sheet is elastic, or nearly so."""
        return self.springs_back or not self._has_history

    def mode(
        self,
        *,
        consistent: bool = False,
        indefinite: IndefiniteTangent = IndefiniteTangent.IGNORED,
        friction: bool = False,
        extended: bool = False,
        grows: bool = False,
    ) -> IterationMode:
        """Mode of the iterations, with the options of the user.

        Parameters
        ----------
        consistent : bool
            Use the consistent tangent even if the options select the mixed one.
        indefinite : IndefiniteTangent
            When to stop because the tangent is indefinite far from equilibrium.
        friction : bool
            Whether points may alternate between stick and slip, so that elastic sheets use a line search, too.
        extended : bool
            Whether more iterations are allowed.
        grows : bool
            Whether to end near equilibrium where a penalty will grow.
        """
        search = self.options.line_search
        if search is None:  # in elastic sheets, whose energy is a narrow curved valley, it is too slow
            search = friction or not self._elastic
        return IterationMode(search, self.mixed and not consistent, indefinite, extended, grows)

    def solve(
        self,
        goal: State | None = None,
        extrapolation: Floats | None = None,
        mode: IterationMode | None = None,
        beyond: Floats | None = None,
        keep: bool = False,
    ) -> Converged:
        """Find the equilibrium at the loads, supports and tools of a goal, starting from the converged state.

        Parameters
        ----------
        goal : State, optional
            The converged state with the time and the controls of the increment; default: without a change of them.
        extrapolation : ndarray, shape (3 n,), optional
            Predicted increment; prescribed entries are overwritten. Without it the first increment is that of the
            tangent. It is recovered with the blocks of the last evaluation, which must be at the converged state.
        mode : IterationMode, optional
            Mode of the iterations; default: from the options.
        beyond : ndarray, shape (3 n + k,), optional
            A rigid rotation in addition to the extrapolation, which strains no element. eq. (4.178)
        keep : bool
            Whether the first evaluation keeps the contact points of the converged state. eq. (4.230)

        Raises
        ------
        Failed
            If it does not converge; the system is reverted.
        """
        goal = self.system.state if goal is None else goal
        return self.guarded(lambda: self._solve(goal, extrapolation, mode or self.mode(), beyond, keep))

    def go_on(self, converged: Converged, change: Floats, mode: IterationMode | None = None) -> Converged:
        """Find the equilibrium again after a change of forces in the system at fixed loads, supports and tools.

        Parameters
        ----------
        converged : Converged
            The previous equilibrium, at which the last evaluation was made.
        change : ndarray, shape (3 n,)
            First-order change of the residual there; the first increment uses the previous tangent.
        mode : IterationMode, optional
            Mode of the iterations; default: from the options.

        Raises
        ------
        Failed
            If it does not converge; the system is reverted.
        """

        def work() -> Converged:
            solver = self.ready_solver()
            solver.factor(converged.evaluation)
            du = self.system.extend(solver.solve(-self.system.restrict(change)))
            return self.correct(converged.goal, converged.x, du, mode or self.mode())

        return self.guarded(work)

    def along_last_factors(self, rate: Floats) -> Floats | None:
        """Increment for a rate of the residual, with the last factors of the iterations; None if they are inaccurate.

        Parameters
        ----------
        rate : ndarray, shape (3 n,)
            At the converged state.
        """
        solver = self.ready_solver()
        try:
            return self.guarded(lambda: self.system.extend(solver.solve(-self.system.restrict(rate))))
        except Failed:
            return None

    def guarded(self, work: Callable[[], _T]) -> _T:
        """Run an attempt that leaves the system unchanged if it fails.

        Raises
        ------
        Failed
            If it does not converge, or the tangent is singular or not finite.
        """
        try:
            return work()
        except (SingularMatrix, NotFinite) as error:
            self.system.revert()
            what = ", ".join(filter(None, (error.what, error.where)))
            cause = Cause.SINGULAR if isinstance(error, SingularMatrix) else Cause.OTHER
            raise Failed(what, [], cause, getattr(error, "motion", None)) from error
        except BaseException as error:  # errors of a user's function and interrupts also leave the system unchanged
            self.system.revert()
            solver = self._analysed.solver
            if isinstance(error, Failed) and error.motion is None and solver is not None:
                error.motion = solver.weak
            raise

    def _solve(
        self, goal: State, extrapolation: Floats | None, mode: IterationMode, beyond: Floats | None, keep: bool
    ) -> Converged:
        """First increment from the extrapolation, or from the tangent by eq. (5.6); then corrections."""
        system = self.system
        start = clock.perf_counter()
        u = goal.x.copy()
        du, of_tangent = self.prescribed_increment(goal, u), None
        if extrapolation is not None:
            du += system.extend(system.coefficients(extrapolation))
        else:
            first = system.evaluate(system.state_at(u, goal), du)
            self.check_domain(first, [])
            solver = self.ready_solver()
            factors = solver.factor(first)
            if not first.border.unknowns:
                of_tangent = First(factors, system.largest_entry(first.values))
            du += system.extend(solver.solve(-system.restrict(first.residual + first.predictor)))
            del first  # with its tangent
        return self.correct(goal, u, du, mode, start, of_tangent, beyond, keep)

    def prescribed_increment(self, goal: State, u: Floats) -> Floats:
        """Increment of the supports from ``u`` to their values at a goal; zero at the unknowns."""
        gap = np.zeros_like(u)
        prescribed = self.system.prescribed_displacement(goal)
        gap[: prescribed.size] = prescribed - u[: prescribed.size]
        return gap - self.system.extend(self.system.coefficients(gap))

    def correct(
        self,
        goal: State,
        u: Floats,
        du: Floats,
        mode: IterationMode,
        start: float | None = None,
        first: First | None = None,
        beyond: Floats | None = None,
        keep: bool = False,
    ) -> Converged:
        """Apply a first increment ``du`` from ``u``, and iterate until residual and increments are small. eq. (5.9)"""
        system, options, solver = self.system, self.options, self.ready_solver()
        recorder = Recorder(self.callbacks, system.ranks, clock.perf_counter() if start is None else start)
        guard = DivergenceGuard(system, mode.indefinite, extended=mode.extended)
        tangent = Tangent(system, solver, options, mode, guard, first)
        criteria = Criteria(system, options.residual, options.increment, self.settled, rests=not options.keep)
        iterations = recorder.iterations

        du, evaluation = self._predicted(goal, u, du, mode, beyond, keep=keep, forces=tangent.forces_first)
        increment, length = self._relative(du, evaluation), 1.0
        while len(iterations) < guard.iteration_limit(options.max_iterations, iterations, options.residual):
            self.check_domain(evaluation, iterations)
            r = system.restrict(evaluation.residual)
            norm = self._finite(math.sqrt(system.ranks.dot(r, r)), iterations)
            residual = norm / (evaluation.force_scale or 1.0)

            solved = bool(iterations) or first is not None
            criteria.entry = tangent.entry
            moved = recorder.moved(evaluation)
            if self._accepts(criteria, evaluation, norm, increment, moved=moved, solved=solved, grows=mode.grows):
                recorder.add(evaluation, residual, increment, 0.0, length, tangent.pivots)
                self._check_flight(evaluation, iterations)
                tangent.follow()
                return Converged(evaluation, iterations, goal, jumped=guard.jumps, linear=tangent.forces_first)

            if system.pattern is not self._analysed.pattern:  # sheets have met others
                solver = self.ready_solver()
                tangent.use(solver)
            longest = guard.longest_step(evaluation, norm, iterations)
            evaluation = tangent.factor(goal, evaluation, residual, iterations)
            du = system.extend(solver.solve(-r))
            energy = abs(system.ranks.dot(r, system.coefficients(du)))
            recorder.add(evaluation, residual, increment, energy, length, tangent.pivots)
            evaluation = evaluation.without_tangent()  # factors exist: release the memory of the tangent
            evaluation, length = self._advanced(goal, evaluation, du, r, mode, longest, tangent)
            increment = length * self._relative(du, evaluation)
        raise Failed(f"no convergence in {len(iterations)} iterations", iterations, Cause.ITERATIONS)

    def _predicted(
        self,
        goal: State,
        u: Floats,
        du: Floats,
        mode: IterationMode,
        beyond: Floats | None,
        *,
        keep: bool,
        forces: bool,
    ) -> tuple[Floats, Evaluation]:
        """The first increment, and the evaluation at its end."""
        system = self.system
        if system.ranks.max(float(np.abs(du).max(initial=0.0))) <= EPS * system.extent:
            du = self.prescribed_increment(goal, u)  # the rest would shake a sheet without forces off its tools
        system.recover(du, mode.mixed)
        end = system.state_at(u + du if beyond is None else u + du + beyond, goal)
        return du, system.evaluate(end, keep=True) if keep else system.evaluate(end, tangent=not forces)

    def _accepts(
        self,
        criteria: Criteria,
        evaluation: Evaluation,
        norm: float,
        increment: float,
        *,
        moved: bool,
        solved: bool,
        grows: bool,
    ) -> bool:
        """Whether the iterations end: they have converged, or are near equilibrium where a penalty will grow."""
        if evaluation.kept:
            return False
        near = grows and solved and norm <= _NEAR * (evaluation.force_scale or 1.0)
        done = criteria.met(norm, increment, evaluation.x, evaluation, moved=moved, solved=solved)
        return done or (near and bool(self.system.too_deep(evaluation)))

    def _advanced(
        self,
        goal: State,
        before: Evaluation,
        du: Floats,
        r: Floats,
        mode: IterationMode,
        longest: float,
        tangent: Tangent,
    ) -> tuple[Evaluation, float]:
        """The evaluation after the increment, or after a part of it if it is too long; this part. eq. (5.12)"""
        system, u, length = self.system, before.x, longest
        system.recover(du, mode.mixed)
        if length < 1.0:
            system.shorten(length)
        evaluation = system.evaluate(system.state_at(u + length * du, goal), tangent=not tangent.forces_first)
        if tangent.shifted:
            return lengthened(system, goal, u, du, r, evaluation, length)
        if tangent.searches:
            return shortened(system, goal, u, du, r, evaluation, length, keep=before.kept)
        return evaluation, length

    def ready_solver(self) -> Bordered:
        """Return the solver that has analysed the present pattern."""
        pattern, analysed = self.system.pattern, self._analysed
        if analysed.solver is None or analysed.pattern is not pattern:
            with self.timing.analysis:
                solver = TimedSolver(make_solver(pattern, self.solver_name), self.timing)
                analysed.solver = Bordered(self.system, solver)
            analysed.pattern = pattern
        return analysed.solver

    @staticmethod
    def check_domain(evaluation: Evaluation, iterations: list[Iteration]) -> None:
        """Fail if a cell has no residual: it is inverted, or its law failed."""
        if evaluation.failed >= 0:
            raise Failed(f"cell {evaluation.failed} {evaluation.failure}", iterations, Cause.CELL)

    @staticmethod
    def _finite(norm: float, iterations: list[Iteration]) -> float:
        if not math.isfinite(norm):
            raise Failed("the residual is not finite", iterations)
        return norm

    def _relative(self, dx: Floats, evaluation: Evaluation) -> float:
        """Size of an increment relative to the displacement."""
        displacement = largest(self.system, evaluation.x, evaluation)
        return largest(self.system, dx, evaluation) / displacement if displacement > 0 else 0.0

    def _check_flight(self, evaluation: Evaluation, iterations: list[Iteration]) -> None:
        """Fail if the sheet is unsupported but round-off has hidden this from the factorisation."""
        displacement = largest(self.system, evaluation.x, evaluation)
        if displacement > _FLIGHT * self.system.extent:
            reason = f"nothing holds the sheet: a displacement of {displacement:.3g} follows from round-off"
            raise Failed(reason, iterations, Cause.SINGULAR)
