"""State of a run between two increments, and the state of each kind of step.

A run is a state machine: between two increments its future depends only on the model, on `Run` and on the `Loop` of the
present step. At such a point it may be written to a checkpoint, stopped and resumed.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from umform.analysis.newton.newton import Newton
from umform.analysis.newton.strategy_statistics import StrategyStatistics
from umform.analysis.steps.lost_contact import lost_tools
from umform.analysis.steps.own_parts import linear_rate, own_checks
from umform.analysis.steps.trail import Trail
from umform.errors import InvalidValue
from umform.model import Evaluation, Model
from umform.model.terms.control import Control
from umform.progress import Tick, silent
from umform.results.history import History
from umform.results.records import Converged

log = logging.getLogger("umform.analysis.steps")

#: Slow increments at which the run warns.
_SLOW = 3
#: Beginning of the warning about return maps in stages, which is issued once.
_STAGES = "the return map of the material went through stages of a shrinking yield surface"


class Loop(Protocol):
    """Position of a step between two of its increments."""

    @property
    def done(self) -> bool:
        """Whether the step is complete."""

    def advance(self, run: Run, step: Any) -> None:
        """Try one increment: accept it, or adapt to its failure."""

    def memory(self) -> dict[str, Any]:
        """State of the loop as numbers, lists and arrays; ``recall`` of its class restores it."""

    def follow(self, run: Run, step: Any, lead: Run, take: Take) -> None:
        """Repeat the last accepted increment of the loop of a leading run. docs/theory, 5.17"""


#: Makes an increment to values of some controls at a time.
Take = Callable[[Sequence[float], Sequence[Control], float], None]


class Follower(Protocol):
    """Runs that follow another one, increment by increment."""

    @property
    def level(self) -> bool:
        """Whether they have repeated the last increment of the leading run to its end."""

    def follow(self, lead: Run, *, frame: bool) -> None:
        """Repeat the increment that the leading run has accepted."""

    def mark(self) -> str:
        """Text that identifies their input."""

    def memory(self) -> dict[str, Any]:
        """Their state, for checkpoints."""

    def recall(self, lead: Run, memory: dict[str, Any]) -> None:
        """Restore their state, beside a leading run that is restored already."""


@dataclass
class Run:
    """State of a run between two increments.

    Attributes
    ----------
    model, newton, result
        Model, method and results so far.
    frames : int
        Approximate number of states of a step that are kept for pictures.
    number : int
        The present step, counted from 1.
    loop : Loop, optional
        Its loop; None before it begins.
    trail : Trail, optional
        The last increments of the present move or release and of preceding moves, for the extrapolation.
    evaluation : Evaluation
        Evaluation at the converged state.
    statistics : StrategyStatistics
        Statistics of earlier increments that select the first strategy.
    staged : int
        Number of return maps of the model in stages up to the last increment.
    tick, pause : callable
        Shows progress; writes checkpoints and stops the run, between increments.
    follower : Follower, optional
        Runs that follow this one.
    slow : int
        Increments in which the residual has fallen by nearly the same factor from one iteration to the next.
    on_increment : callable, optional
        Called with the result after each increment, on the first rank.
    """

    model: Model
    newton: Newton
    result: History
    evaluation: Evaluation
    statistics: StrategyStatistics = field(default_factory=StrategyStatistics)
    frames: int = 60
    number: int = 1
    loop: Loop | None = None
    trail: Trail | None = None
    staged: int = field(init=False)
    tick: Tick = silent
    pause: Callable[[], None] = field(default=lambda: None)
    follower: Follower | None = None
    on_increment: Callable[[Any], object] | None = None
    slow: int = 0

    def __post_init__(self) -> None:
        self.staged = self._staged()

    def keep(
        self, converged: Converged, controls: Sequence[Control], *, name: str, fraction: float, frame: bool
    ) -> None:
        """Add a converged increment to the result and show the progress of the step ``name``."""
        self.newton.timing.attempts.accepted += len(converged.iterations)
        self.result.add(converged.evaluation, converged.iterations + converged.passes, step=self.number, frame=frame)
        self._warn_of_stages()
        self._warn_of_slow(converged)
        if self.follower is not None:
            self.follower.follow(self, frame=frame)
        row = self.result.rows[-1]
        for as_planned, message in lost_tools(self.model, self.result.rows[-2], row):
            tell = self.result.note if as_planned else self.result.warn
            tell(f"step {self.number}, time {self.model.system.time:.4f}: {message}")
        forces = [f"{c.name} {row[c.name]:.5g}, force {row[f'{c.name}_force']:.5g}" for c in controls]
        self.tick(name, fraction, "; ".join([*forces, f"{row['iterations']} iterations"]))
        if self.on_increment is not None and self.model.system.ranks.rank == 0:
            try:
                self.on_increment(self.result)
            except Exception as error:
                error.add_note("in on_increment, called with the result so far after each increment")
                raise
            self.model.system.revert()  # what evaluations of the user have tried

    def call(self, function: Callable[[Any], object] | None) -> None:
        """Call a function after each increment."""
        if function is not None and not callable(function):
            raise InvalidValue(
                "on_increment is a function of the result",
                where="on_increment",
                value=function,
                cause="the value of a call in place of the function",
                remedy="def each(result): ..., then on_increment=each",
            )
        self.on_increment = function

    def _warn_of_slow(self, converged: Converged) -> None:
        """Warn at the third increment without quadratic convergence, if laws or tools of the user may be the cause."""
        rate = linear_rate(converged.iterations)
        self.slow += rate is not None
        if rate is None or self.slow != _SLOW or not (checks := own_checks(self.model)):
            return
        self.result.warn(
            f"step {self.number}: Newton's method converges slowly in {self.slow} of {len(self.result.rows) - 1} "
            f"increments, by a factor of about {rate:.2g} in each iteration: a tangent is not the derivative; "
            f"{' and '.join(checks)} with differences"
        )

    def _staged(self) -> int:
        return sum(body.block.staged_returns for body in self.model.bodies)

    def _warn_of_stages(self) -> None:
        """Count the points with return maps in stages since the last increment; warn at the first ones."""
        before, self.staged = self.staged, self._staged()
        points = int(self.model.system.ranks.sum(float(self.staged - before)))
        if points == 0:
            return
        self.newton.timing.attempts.staged += points
        when = f"step {self.number}, time {self.model.system.time:.4f}"
        log.info("%s: return maps in stages at %d points, over all evaluations", when, points)
        if not any(_STAGES in warning for warning in self.result.warnings):
            self.result.warn(
                f"{when}: {_STAGES} at {points} points, over all evaluations: the increments of strain are large; "
                "smaller increments are safer. The count of the run is result.timing.attempts.staged"
            )
