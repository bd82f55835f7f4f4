"""Newton's method on a system that can evaluate, recover, commit and revert; it knows no elements and no contact.

Convergence asks for a small residual AND a small increment, both without units: the residual against the root of the
sum of squares of all element forces, the increment against the largest displacement. Neither can fall below round-off,
so the floor that round-off sets is estimated in each iteration: a residual below it is small, and two in a row end the
iteration even where the increment cannot become small (sheets so thin that round-off moves them).
eqs. (5.8)-(5.11)
"""

from __future__ import annotations

import logging
import math
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, NotFinite, SingularMatrix
from umform.solvers import Pattern, SparseSolver, make_solver

log = logging.getLogger("umform.newton")

Floats = NDArray[np.float64]

#: Each trial is at least a quarter of the one before: thin sheets, whose energy is a narrow bent valley, creep else.
_LINE_SEARCH_TRIALS = 3


class Evaluation(Protocol):
    """What Newton reads of an evaluation."""

    @property
    def residual(self) -> Floats:
        """Residual at all degrees of freedom, reactions at the prescribed ones."""

    @property
    def values(self) -> Floats:
        """Entries of the tangent."""

    @property
    def predictor(self) -> Floats:
        """Tangent times the increment of the prescribed degrees of freedom."""

    @property
    def force_scale(self) -> float:
        """Scale of the forces."""

    @property
    def failed(self) -> int:
        """First cell outside of the domain of its law, or -1."""


class System(Protocol):
    """What Newton asks of a model."""

    u: Floats

    @property
    def pattern(self) -> Pattern:
        """Sparse pattern of the tangent."""

    @property
    def free(self) -> NDArray[np.int64]:
        """Free degrees of freedom."""

    def prescribed_displacement(self) -> Floats:
        """Displacement of the prescribed degrees of freedom, zero elsewhere."""

    def evaluate(self, u: Floats, du: Floats | None = None) -> Evaluation:
        """Residual and tangent."""

    def recover(self, du: Floats, s: float) -> None:
        """Update condensed parameters."""

    def undo_recover(self) -> None:
        """Take the last update back."""

    def active_set(self) -> NDArray[np.bool_]:
        """Contact points that penetrate."""

    def commit(self, u: Floats) -> None:
        """Accept."""

    def revert(self) -> None:
        """Forget."""


@dataclass(frozen=True)
class NewtonOptions:
    """How far and how hard to iterate.

    Attributes
    ----------
    residual : float
        Tolerance of the residual, relative to the element forces.
    increment : float
        Tolerance of the increment, relative to the largest displacement.
    max_iterations : int
        Iterations before a step is given up.
    line_search : bool
        Shorten increments that do not bring the residual along them down.
    extrapolate : bool
        Start a step from the extrapolated last one instead of the tangent.
    """

    residual: float = 1e-9
    increment: float = 1e-6
    max_iterations: int = 25
    line_search: bool = False
    extrapolate: bool = True

    def __post_init__(self) -> None:
        if not self.residual > 0 or not self.increment > 0 or self.max_iterations < 1:
            raise InvalidValue("tolerances and iterations must be positive", where="NewtonOptions", value=self)


@dataclass(frozen=True)
class Iteration:
    """Record of one iteration.

    Attributes
    ----------
    residual : float
        Norm of the residual of the free degrees of freedom over the force scale.
    increment : float
        Largest entry of the increment that led here over the largest displacement.
    energy : float
        Residual times the increment to come (absolute); zero in the last iteration.
    entered, left : int
        Contact points that came into and went out of contact.
    step_length : float
        Step length that the line search took.
    negative_pivots : int or None
        Negative pivots of the tangent, where the solver tells.
    seconds : float
        Wall time.
    """

    number: int
    residual: float
    increment: float
    energy: float
    entered: int
    left: int
    step_length: float
    negative_pivots: int | None
    seconds: float


class Failed(Exception):
    """A step that did not converge: why, and the iterations so far. Steps turn it into a cut or an error."""

    def __init__(self, reason: str, iterations: list[Iteration], *, chattering: bool = False) -> None:
        super().__init__(reason)
        self.reason = reason
        self.iterations = iterations
        self.chattering = chattering


@dataclass(frozen=True)
class Converged:
    """A converged step: displacement, residual (with reactions) and the iterations."""

    u: Floats
    residual: Floats
    iterations: list[Iteration]


class Newton:
    """Newton's method with a solver that keeps its symbolic factorisation while the pattern holds."""

    def __init__(self, system: System, options: NewtonOptions | None = None, solver: str = "auto") -> None:
        self.system = system
        self.options = options or NewtonOptions()
        self.solver_name = solver
        self._solver: SparseSolver | None = None
        self._pattern: Pattern | None = None
        self.callbacks: list[Callable[[Iteration], None]] = []

    @property
    def solver(self) -> str:
        """Name of the sparse solver that the system gets."""
        return self._ready_solver().name

    def solve(self, extrapolation: Floats | None = None) -> Converged:
        """Find the equilibrium at the present loads, supports and tools, starting from the converged state.

        Parameters
        ----------
        extrapolation : ndarray, shape (3 n,), optional
            Guess of the increment of this step; prescribed entries are overwritten. Without it the first increment is
            that of the tangent. It is recovered with the blocks of the last evaluation, which must be at ``system.u``.

        Raises
        ------
        Failed
            If it does not converge; the system is reverted.
        """
        try:
            return self._solve(extrapolation)
        except (SingularMatrix, NotFinite) as error:
            self.system.revert()
            raise Failed(error.what, []) from error
        except BaseException:  # an error of a user's function or an interrupt too leaves no trace
            self.system.revert()
            raise

    def _solve(self, extrapolation: Floats | None) -> Converged:
        system, options = self.system, self.options
        free = system.free
        solver = self._ready_solver()
        target = system.prescribed_displacement()
        constrained = np.ones(target.size, dtype=bool)
        constrained[free] = False
        prescribed_increment = np.where(constrained, target - system.u, 0.0)
        u = system.u.copy()
        iterations: list[Iteration] = []
        seen: list[bytes] = []
        start = clock.perf_counter()

        if extrapolation is not None:
            du = np.where(constrained, prescribed_increment, extrapolation)
            system.recover(du, 1.0)
        else:
            first = system.evaluate(u, prescribed_increment)
            self._check_domain(first, iterations)
            solver.factor(first.values)
            du = prescribed_increment.copy()
            du[free] = solver.solve(-(first.residual + first.predictor)[free])
            system.recover(du, 1.0)
        u += du
        increment, step_length, pivots = _size(du, u), 1.0, None
        evaluation = system.evaluate(u)
        active = system.active_set()
        previous_active = active
        extra = at_floor = 0

        for number in range(1, options.max_iterations + 1):
            self._check_domain(evaluation, iterations)
            r = evaluation.residual[free]
            norm = float(np.linalg.norm(r))
            scale = evaluation.force_scale or 1.0
            if not np.isfinite(norm):
                raise Failed("the residual is not finite", iterations)
            entered, left = int((active & ~previous_active).sum()), int((~active & previous_active).sum())
            floor = self._floor(evaluation.values, u)
            small = norm <= max(options.residual * scale, floor) and increment <= options.increment
            settled = small and (not (entered or left) or extra >= 2)
            at_floor = at_floor + 1 if norm <= floor else 0
            if settled or at_floor >= 2:
                self._record(
                    iterations, number, norm / scale, increment, 0.0, entered, left, step_length, pivots, start
                )
                return Converged(u, evaluation.residual, iterations)
            extra += int(small)
            self._detect_chatter(seen, active, iterations)

            pivots = solver.factor(evaluation.values).negative_pivots
            du = np.zeros(u.size)
            du[free] = solver.solve(-r)
            energy = abs(float(r @ du[free]))
            self._record(iterations, number, norm / scale, increment, energy, entered, left, step_length, pivots, start)
            u, evaluation, step_length = self._advance(u, du, r)
            increment = step_length * _size(du, u)
            previous_active, active = active, system.active_set()
        raise Failed(f"no convergence in {options.max_iterations} iterations", iterations)

    def _advance(self, u: Floats, du: Floats, r: Floats) -> tuple[Floats, Evaluation, float]:
        """Take the increment, shortened by the line search if that is wanted. eq. (5.12)"""
        system, free = self.system, self.system.free
        s = 1.0
        slope = float(r @ du[free])
        for _ in range(_LINE_SEARCH_TRIALS):
            system.recover(du, s)
            trial = u + s * du
            evaluation = system.evaluate(trial)
            if not self.options.line_search:
                break
            along = float(evaluation.residual[free] @ du[free]) if evaluation.failed < 0 else np.inf
            if abs(along) <= 0.8 * abs(slope):
                break
            # Evaluation is pure: put the parameters back and evaluate at u again, and nothing of the trial is left.
            system.undo_recover()
            system.evaluate(u)
            secant = s * slope / (slope - along) if np.isfinite(along) and slope != along else 0.5 * s
            s = min(max(secant, 0.25 * s), 0.5 * s)
        else:
            system.recover(du, s)
            trial = u + s * du
            evaluation = system.evaluate(trial)
        return trial, evaluation, s

    def _ready_solver(self) -> SparseSolver:
        pattern = self.system.pattern
        if self._solver is None or self._pattern is not pattern:
            self._solver = make_solver(pattern, self.solver_name)
            self._pattern = pattern
        return self._solver

    def _floor(self, values: Floats, u: Floats) -> float:
        """Residual that round-off of the displacements leaves behind. eq. (5.10)"""
        largest = float(np.abs(values).max(initial=0.0))
        eps = float(np.finfo(float).eps)
        return eps * largest * float(np.abs(u).max()) * math.sqrt(self.system.free.size)

    def _record(
        self,
        iterations: list[Iteration],
        number: int,
        residual: float,
        increment: float,
        energy: float,
        entered: int,
        left: int,
        step_length: float,
        pivots: int | None,
        start: float,
    ) -> None:
        record = Iteration(
            number, residual, increment, energy, entered, left, step_length, pivots, clock.perf_counter() - start
        )
        iterations.append(record)
        log.debug(
            "    iteration %2d  residual %.3e  increment %.3e  contact +%d -%d%s",
            number,
            residual,
            increment,
            entered,
            left,
            f"  negative pivots {pivots}" if pivots else "",
        )
        for callback in self.callbacks:
            callback(record)

    @staticmethod
    def _check_domain(evaluation: Evaluation, iterations: list[Iteration]) -> None:
        if evaluation.failed >= 0:
            raise Failed(
                f"cell {evaluation.failed} is strained beyond the domain of its material law "
                "(or so far that its enhanced parameters cannot be eliminated)",
                iterations,
            )

    @staticmethod
    def _detect_chatter(seen: list[bytes], active: NDArray[np.bool_], iterations: list[Iteration]) -> None:
        """Give up when contact points go in and out in a cycle and the residual does not fall any more."""
        if active.size == 0:
            return
        state = np.packbits(active).tobytes()
        seen.append(state)
        for period in (2, 3):
            if len(seen) < 3 * period or len(iterations) < 2 * period:
                continue
            tail = seen[-period:]
            cycle = tail == seen[-2 * period : -period] == seen[-3 * period : -2 * period] and len(set(tail)) > 1
            if cycle and iterations[-1].residual > 0.5 * iterations[-1 - period].residual:
                raise Failed(
                    f"the active set of contact chatters between {len(set(tail))} states", iterations, chattering=True
                )


def _size(du: Floats, u: Floats) -> float:
    largest = float(np.abs(u).max())
    return float(np.abs(du).max()) / largest if largest > 0 else 0.0
