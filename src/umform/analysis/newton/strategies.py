"""Strategies for an increment: start values for Newton's method, and alternatives after a failure.

They are tried in order until one converges. docs/theory, 4.13; `umform.attempts` counts trials and successes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.criteria import SETTLED_INCREMENT, SETTLED_RESIDUAL
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import IndefiniteTangent
from umform.analysis.newton.passed_through import same_side
from umform.analysis.newton.rigid_start import rigid_start
from umform.analysis.newton.rotation_check import follows
from umform.analysis.newton.rotation_predictor import carried, leaves_arc
from umform.analysis.newton.softening import softened
from umform.analysis.newton.strategy_statistics import StrategyStatistics
from umform.model import Evaluation, Model
from umform.model.terms.control import Control
from umform.model.terms.state import State
from umform.results.records import Cause, Converged, Failed

Floats = NDArray[np.float64]

#: Tolerance of an attempt that is repeated, relative to the least residual of the first one.
_AGAIN = 1.0 + 1e-9


@dataclass(frozen=True)
class Increment:
    """An increment to solve.

    Attributes
    ----------
    model, newton, statistics
        System, method, and statistics of earlier increments.
    goal : State
        The converged state with the new values of the controls, at the new time.
    moved : tuple of Control
        The controls that the step moves.
    guess : ndarray, shape (3 n + k,), optional
        The last increment, extrapolated.
    last : Evaluation
        Evaluation at the converged state.
    keeps : bool
        Whether an extrapolation keeps the contact points of the converged state. eq. (4.230)
    grows : bool
        Whether it ends near equilibrium where a penalty will grow.
    """

    model: Model
    newton: Newton
    statistics: StrategyStatistics
    goal: State
    moved: tuple[Control, ...]
    guess: Floats | None
    last: Evaluation
    keeps: bool = True
    grows: bool = True

    def accept(self, converged: Converged) -> Converged:
        """The equilibrium, unless the sheet passed through a tool, or rotated on one too far for its friction."""
        return follows(self.model, self.last, same_side(self.model, self.last, converged))

    @property
    def indefinite(self) -> IndefiniteTangent:
        """An indefinite tangent far from equilibrium ends an attempt: softer penalties converge faster."""
        if not (self.touches and self.statistics.stable):
            return IndefiniteTangent.IGNORED
        return IndefiniteTangent.STOPS_BEFORE_JUMP if self.statistics.last else IndefiniteTangent.STOPS

    @property
    def indefinite_with_soft_tools(self) -> IndefiniteTangent:
        """With softer penalties a growing number of negative pivots indicates divergence."""
        return IndefiniteTangent.STOPS_IF_MORE if self.statistics.stable else IndefiniteTangent.IGNORED

    @property
    def extrapolates(self) -> bool:
        """Whether there is a last increment to extrapolate, and the extrapolation is enabled."""
        return self.guess is not None and self.newton.options.extrapolate > 0 and self.statistics.extrapolates

    @property
    def touches(self) -> bool:
        """Whether there is contact, of sheets or with tools that are not open."""
        return any(pair.tool is None or not pair.tool.open for pair in self.model.system.penalised)

    @property
    def has_friction(self) -> bool:
        """Whether there is friction with tools that are not open."""
        return any(pair.has_friction and not pair.tool.open for pair in self.model.system.pairs_of_tools())

    @property
    def undeformed(self) -> bool:
        """Whether tools touch a sheet without forces: which points stay is the same for any size of increment."""
        return self.touched and not self.model.system.ranks.any(bool(self.model.u.any()))

    @property
    def touched(self) -> bool:
        """Whether the sheet touches a tool in the converged state."""
        return self.last.touching(self.model.system.ranks)

    def soft(self) -> Converged:
        """The equilibrium by continuation in the penalty."""
        start, mode = self.tangent(), self.newton.mode(indefinite=self.indefinite_with_soft_tools)
        go = lambda: self.newton.solve(self.goal, start, mode, self.beyond(start))  # noqa: E731
        return softened(self.model, self.newton, self.goal, go, self.accept, mode, touched=self.touched)

    def along_extrapolation(self) -> Converged:
        """The equilibrium from the last increment, scaled."""
        mode = self.newton.mode(indefinite=self.indefinite, grows=self.grows)
        return self.newton.solve(self.goal, self.guess, mode, keep=self.keeps and self.newton.options.keep)

    def rigid(self) -> Converged:
        """The equilibrium by continuation in the penalty from a rigid motion of the sheet. eq. (4.260)"""
        start = rigid_start(self.model, self.goal)
        if start is None:
            raise Failed("no rigid motion brings the sheet between its tools", [])
        go = lambda: self.newton.solve(self.goal, start)  # noqa: E731
        return softened(self.model, self.newton, self.goal, go, self.accept)

    def along_tangent(self, *, consistent: bool = False) -> Converged:
        """The equilibrium from the increment along the tangent, corrected for rotation with a tool by friction."""
        start = self.tangent()
        friction, extended = self.has_friction, self.undeformed
        mode = self.newton.mode(
            consistent=consistent, indefinite=self.indefinite, friction=friction, extended=extended, grows=self.grows
        )
        return self.newton.solve(self.goal, start, mode, self.beyond(start))

    def beyond(self, start: Floats | None) -> Floats | None:
        """Correction of the straight increment for a sheet that rotates with a tool. eq. (4.178)"""
        return None if start is None or not self.has_friction else carried(self.model, self.goal, self.last, start)

    @property
    def leaves_arc(self) -> bool:
        """Whether the last increment is that of a sheet that rotated with a tool: its extrapolation leaves the arc."""
        return self.guess is not None and self.has_friction and leaves_arc(self.model, self.goal, self.last, self.guess)

    def tangent(self) -> Floats | None:
        """Increment along the tangent of the converged state: the sheet follows the tools that touch it. eq. (4.36)

        None if the sheet is unsupported there except by a tool that is not yet in contact, and without contact: then
        Newton's method uses the tangent at the new values, eq. (5.6).
        """
        if not self.touches:
            return None
        model, newton = self.model, self.newton
        state = model.state
        rates = {c: self.goal.controls[c.name] - state.controls[c.name] for c in self.moved}

        def increment() -> Floats:
            evaluation = model.system.evaluate(state, rates=rates, until=self.goal.time)
            newton.check_domain(evaluation, [])
            solver = newton.ready_solver()
            solver.factor(evaluation)
            return model.system.extend(solver.solve(-model.system.restrict(evaluation.residual + evaluation.predictor)))

        try:
            return newton.guarded(increment)
        except Failed:
            return None


@dataclass(frozen=True)
class Strategy:
    """A strategy for an increment.

    Attributes
    ----------
    name : str
        For tables.
    serves : callable
        Whether it is applicable to an increment.
    attempt : callable
        Returns the equilibrium, or raises Failed.
    """

    name: str
    serves: Callable[[Increment], bool]
    attempt: Callable[[Increment], Converged]


STRATEGIES = (
    # The last increment, scaled: it needs no evaluation to begin with.
    Strategy(
        "extrapolation",
        lambda at: at.extrapolates and not at.leaves_arc,
        lambda at: at.along_extrapolation(),
    ),
    Strategy(
        "tangent",
        lambda at: True,
        lambda at: at.along_tangent(),
    ),
    # It may cross a snap-through where the mixed tangent of eq. (5.39) fails.
    Strategy(
        "consistent tangent",
        lambda at: at.newton.mixed,
        lambda at: at.along_tangent(consistent=True),
    ),
    # A stiff tool may reach a region without contact: a soft one gives the initial guess of the shape.
    Strategy(
        "softer penalties",
        lambda at: at.touches and (at.statistics.softens or not at.touched),
        lambda at: at.soft(),
    ),
    # Tools may hold an undeformed sheet only in another position, where it has no tangent until it is there.
    Strategy(
        "rigid motion",
        lambda at: at.undeformed and bool(at.model.contacts) and at.model.system.ranks.size == 1,
        lambda at: at.rigid(),
    ),
)
#: Strategies with other penalties: their failures are of other problems than that of the user.
_SOFT = ("softer penalties", "rigid motion")


def equilibrium(increment: Increment) -> Converged:
    """Equilibrium at the goal of an increment, by the first strategy that converges.

    Raises
    ------
    Failed
        If none does; the model is reverted. The error is that of the last start with the user's penalty.
    """
    attempts, failures = increment.newton.timing.attempts, {}
    touched = increment.touched
    for strategy in STRATEGIES:
        if not strategy.serves(increment):
            continue
        try:
            with attempts.trying(strategy.name):
                converged = increment.accept(strategy.attempt(increment))
        except Failed as failure:
            failures[strategy.name] = failure
            attempts.causes[_cause(strategy.name, failure, touched)] += 1
        else:
            increment.statistics.record(
                failed={name: failure.cause for name, failure in failures.items()},
                won=strategy.name,
                negative_pivots=converged.iterations[-1].negative_pivots,
            )
            return converged
    if increment.statistics.last and touched:
        settled = _settled(increment, failures)
        if settled is not None:
            return settled
    increment.statistics.record_cut({name: failure.cause for name, failure in failures.items()})
    plain = [failure for name, failure in failures.items() if name not in _SOFT]
    for one in plain:
        if one.cause is Cause.SINGULAR:
            plain[-1].cause = Cause.SINGULAR  # the motion stays that of the last attempt, whose state the message is of
    raise plain[-1]


def _settled(increment: Increment, failures: Mapping[str, Failed]) -> Converged | None:
    """The nearest that an attempt came to equilibrium, if it is within the tolerances of drawing. eq. (5.131)"""
    least, best = SETTLED_RESIDUAL, None
    for strategy in STRATEGIES:
        failure = failures.get(strategy.name)
        if failure is None or strategy.name in _SOFT:
            continue
        for record in failure.iterations:
            if record.residual <= least and record.increment <= SETTLED_INCREMENT:
                least, best = record.residual, strategy
    if best is None:
        return None
    again = replace(increment, newton=increment.newton.but(settled=_AGAIN * least))
    increment.model.system.prepare(increment.goal)
    try:
        with again.newton.timing.attempts.trying("settled contact"):
            converged = again.accept(best.attempt(again))
    except Failed:
        return None
    last = converged.iterations[-1]
    increment.statistics.record(failed={}, won=best.name, negative_pivots=last.negative_pivots)
    return replace(converged, missed=last.residual)


def _cause(strategy: str, failure: Failed, touched: bool) -> str:
    """Cause of the failure of an attempt, in words for users."""
    entered = any(record.entered for record in failure.iterations)
    if failure.cause is Cause.CYCLE:
        return "cycle of contact"
    if failure.cause in (Cause.PASSAGE, Cause.TURN):
        return str(failure.cause)
    if not touched and entered:
        return "first touch"
    if failure.cause is Cause.SINGULAR and touched:
        return "points of contact lost"
    if strategy == "extrapolation":
        return f"extrapolation too far: {failure.cause}"
    return str(failure.cause)
