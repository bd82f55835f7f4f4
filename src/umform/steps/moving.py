"""Increments of a move, equal ones or at a pace, which are cut where they fail. eq. (5.13)"""

from __future__ import annotations

import logging
import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from umform.solution.records import Cause, Converged, Failed
from umform.steps.increment import no_convergence, take_increment
from umform.steps.loop import Run
from umform.steps.move import Move
from umform.steps.pace import Happened
from umform.steps.trail import changes

log = logging.getLogger("umform.steps")

#: A fraction this near to a mark, in increments, is at the mark.
_NEAR = 1e-9
#: Easy increments after which a size that has failed is tried again, at most.
_LONGEST_PATIENCE = 24
#: A size is trusted once so many increments in a row have been made with it.
_TRUSTED = 2
#: After a cut, increments at a pace stay below this part of the size that failed; each of them raises the limit.
_BELOW_FAILED, _RAISE = 0.6, 1.05


@dataclass
class Moving:
    """Moves the controls of a step.

    Attributes
    ----------
    starts : list of float
        Values of the controls at the beginning.
    start_time : float
        Time there.
    size : float
        Increment that comes next, of the fraction of the step.
    fraction : float
        How much of the step is done.
    last_size : float, optional
        Size of the last increment, for the extrapolation; None after a cut. At the beginning that of the step
        before, if this one goes on the same way.
    count : int
        Increments so far.
    done : bool
        Whether the step is at its end.
    """

    starts: list[float]
    start_time: float
    size: float
    fraction: float = 0.0
    last_size: float | None = None
    count: int = 0
    done: bool = False

    @classmethod
    def begin(cls, run: Run, step: Move) -> Self:
        """The loop at the beginning of the step."""
        starts = [control.value for control in step.moved()]
        return cls(starts, run.model.time, step.nominal, last_size=_size_of_last(run, step, starts))

    @classmethod
    def recall(cls, run: Run, step: Move, memory: dict[str, Any]) -> Self:
        """The loop as it stood."""
        return cls(**memory)

    def memory(self) -> dict[str, Any]:
        """All that the loop remembers."""
        return dict(vars(self))

    def advance(self, run: Run, step: Move) -> None:
        """Try one increment."""
        target, model = self._target(step), run.model
        extrapolation = None if self.last_size is None else (target - self.fraction) / self.last_size
        x_before, active_before = model.x.copy(), run.evaluation.active
        if self._hopeless(step, 0.5 * (target - self.fraction)):
            run.habits.last_chance()
        try:
            values = step.values(target, self.starts)
            time = self.start_time + target * step.time
            converged = take_increment(run, values, step.moved(), time, extrapolation)
        except Failed as failure:
            self._cut(run, step, failure, target)
            return
        before, self.last_size, self.fraction = self.fraction, target - self.fraction, target
        self.count += 1
        self.done = target == 1.0
        if not self.done:
            self._adapt(step, converged, lambda: Happened.between(model, x_before, active_before, converged))
        frame = run.frames > 0 and (self.done or self._pictured(step, run.frames, before))
        run.keep(converged, step.moved(), name=f"step {run.number}", fraction=self.fraction, frame=frame)

    @abstractmethod
    def _target(self, step: Move) -> float:
        """Where the increment goes."""

    @abstractmethod
    def _adapt(self, step: Move, converged: Converged, happened: Callable[[], Happened]) -> None:
        """Choose the size of the next increment."""

    @abstractmethod
    def _pictured(self, step: Move, frames: int, before: float) -> bool:
        """Whether the state is kept for pictures, of which there shall be about so many."""

    def _cut(self, run: Run, step: Move, failure: Failed, target: float) -> None:
        """Halve an increment that failed, or give up."""
        self.size, self.last_size = 0.5 * (target - self.fraction), None
        if failure.cause is Cause.CYCLE:
            time = self.start_time + target * step.time
            run.result.warn(f"step {run.number}, time {time:.4f}: {failure.reason}; the increment is cut")
        log.info("step %d: %s; increment cut to %.3g", run.number, failure.reason, self.size)
        if self._hopeless(step, self.size):
            values = step.values(target, self.starts)
            raise no_convergence(run, failure, step.moved(), values) from None

    @staticmethod
    def _hopeless(step: Move, size: float) -> bool:
        """Whether the run is given up rather than tried with so small an increment."""
        return bool(size < step.nominal / 2**step.cuts)


@dataclass
class Marching(Moving):
    """Equal increments, that grow back and meet the nominal marks again after a cut.

    Attributes
    ----------
    easy : int
        Increments in a row that took few iterations.
    patience : int
        So many of them let the increments grow; twice as many after each increment that had grown and failed.
    grown : bool
        Whether increments have grown to a size that is not trusted yet.
    held : int
        Increments in a row of this size.
    """

    easy: int = 0
    patience: int = 3
    grown: bool = False
    held: int = 0

    def _target(self, step: Move) -> float:
        """Off the nominal marks, after a cut, the next one is met again."""
        nominal = step.nominal
        passed = self.fraction / nominal
        next_mark = (math.floor(passed + _NEAR) + 1) * nominal
        on_mark = abs(passed - round(passed)) < _NEAR
        advance = min(self.size, (1.0 if on_mark else next_mark) - self.fraction)
        return 1.0 if self.fraction + advance > 1.0 - _NEAR * nominal else self.fraction + advance

    def _adapt(self, step: Move, converged: Converged, happened: Callable[[], Happened]) -> None:
        """Grow after some increments that were easy."""
        largest = step.grow * step.nominal
        self.easy = self.easy + 1 if len(converged.iterations) <= 8 else 0
        assert self.last_size is not None
        self.held = self.held + 1 if self.last_size > self.size * (1 - _NEAR) else 0
        self.grown = self.grown and self.held < _TRUSTED
        if self.easy >= self.patience and self.size < largest * (1 - 1e-12):
            self.size, self.grown = min(2.0 * self.size, largest), True
            self.easy = self.held = 0

    def _pictured(self, step: Move, frames: int, before: float) -> bool:
        return self.count % max(1, round(1.0 / step.nominal / frames)) == 0

    def _cut(self, run: Run, step: Move, failure: Failed, target: float) -> None:
        self.easy = self.held = 0
        if self.grown:
            self.patience, self.grown = min(2 * self.patience, _LONGEST_PATIENCE), False
        super()._cut(run, step, failure, target)


@dataclass
class Pacing(Moving):
    """Increments whose size follows what happened in the last one.

    Attributes
    ----------
    limit : float
        Largest size after a cut.
    """

    limit: float = math.inf

    def _target(self, step: Move) -> float:
        """The rest of the way is divided equally where less than two increments are left."""
        rest = 1.0 - self.fraction
        if self.size >= rest * (1.0 - _NEAR):
            return 1.0
        return self.fraction + (0.5 * rest if self.size > 0.5 * rest else self.size)

    def _adapt(self, step: Move, converged: Converged, happened: Callable[[], Happened]) -> None:
        """Follow the pace."""
        assert step.pace is not None
        assert self.last_size is not None
        self.size = min(step.pace.factor(happened()) * self.last_size, step.pace.largest, self.limit)
        self.limit *= _RAISE

    def _pictured(self, step: Move, frames: int, before: float) -> bool:
        return math.floor(self.fraction * frames) > math.floor(before * frames)

    def _cut(self, run: Run, step: Move, failure: Failed, target: float) -> None:
        self.limit = _BELOW_FAILED * (target - self.fraction)
        super()._cut(run, step, failure, target)


def _size_of_last(run: Run, step: Move, starts: list[float]) -> float | None:
    """Size that the last increment would have in the step that begins, if the step goes on where that one led."""
    if run.trail is None or run.newton.options.extrapolate < 2:
        return None
    by = np.subtract(step.values(step.nominal, starts), starts)
    size = run.trail.size(changes(run.model.controls, step.moved(), by))
    return None if size is None else size * step.nominal


def loop_of(step: Move) -> type[Moving]:
    """The loop that moves the controls of a step."""
    return Marching if step.pace is None else Pacing
