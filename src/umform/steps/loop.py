"""State of a run between two increments, and what each kind of step remembers there.

A run is a state machine: between two increments all that it will do follows from the model, from what `Run` holds and
from the `Loop` of the step that is under way. There it may be written to a checkpoint, stopped and taken up again.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from umform._core import staged_returns
from umform.model import Evaluation, Model
from umform.model.control import Control
from umform.progress import Tick, silent
from umform.results.history import History
from umform.solution.habits import Habits
from umform.solution.newton import Newton
from umform.solution.records import Converged
from umform.steps.lost import lost_tools
from umform.steps.trail import Trail

log = logging.getLogger("umform.steps")

#: Beginning of the warning about return maps in stages, which is given once.
_STAGES = "the return map of the material went through stages of a shrinking yield surface"


class Loop(Protocol):
    """Where a step stands between two of its increments, and how it goes on."""

    @property
    def done(self) -> bool:
        """Whether the step has come to its end."""

    def advance(self, run: Run, step: Any) -> None:
        """Try one increment: take it, or learn from its failure."""

    def memory(self) -> dict[str, Any]:
        """All that the loop remembers, as numbers, lists and arrays; ``recall`` of its class makes it again."""


@dataclass
class Run:
    """State of a run between two increments.

    Attributes
    ----------
    model, newton, result
        What is solved, how, and what came out so far.
    frames : int
        About how many states of a step are kept for pictures.
    number : int
        The step under way, counted from 1.
    loop : Loop, optional
        Where it stands; None before it begins.
    trail : Trail, optional
        The last increments of the move or release under way and of moves before it, for the extrapolation.
    evaluation : Evaluation
        That of the converged state.
    habits : Habits
        What earlier increments have taught.
    staged : int
        Count of return maps in stages when the last increment was kept.
    tick, pause : callable
        Shows where the run stands; writes checkpoints and stops the run, between increments.
    """

    model: Model
    newton: Newton
    result: History
    evaluation: Evaluation
    habits: Habits = field(default_factory=Habits)
    frames: int = 60
    number: int = 1
    loop: Loop | None = None
    trail: Trail | None = None
    staged: int = field(default_factory=lambda: staged_returns())
    tick: Tick = silent
    pause: Callable[[], None] = field(default=lambda: None)

    def keep(
        self, converged: Converged, controls: Sequence[Control], *, name: str, fraction: float, frame: bool
    ) -> None:
        """Add a converged increment of the step to the result and show how far the step ``name`` has come."""
        self.result.add(converged.evaluation, converged.iterations + converged.passes, step=self.number, frame=frame)
        self._tell_of_stages()
        row = self.result.rows[-1]
        for as_planned, message in lost_tools(self.model, self.result.rows[-2], row):
            tell = self.result.note if as_planned else self.result.warn
            tell(f"step {self.number}, time {self.model.time:.4f}: {message}")
        forces = [f"{c.name} {row[c.name]:.5g}, force {row[f'{c.name}_force']:.5g}" for c in controls]
        self.tick(name, fraction, "; ".join([*forces, f"{row['iterations']} iterations"]))

    def _tell_of_stages(self) -> None:
        """Count the points whose return map went through stages since the last increment; warn at the first ones."""
        before, self.staged = self.staged, staged_returns()
        points = int(self.model.ranks.sum(float(self.staged - before)))
        if points == 0:
            return
        self.newton.timing.attempts.staged += points
        when = f"step {self.number}, time {self.model.time:.4f}"
        log.info("%s: return maps in stages at %d points, over all evaluations", when, points)
        if not any(_STAGES in warning for warning in self.result.warnings):
            self.result.warn(
                f"{when}: {_STAGES} at {points} points, over all evaluations: the increments of strain are large; "
                "smaller increments are safer. The count of the run is result.timing.attempts.staged"
            )
