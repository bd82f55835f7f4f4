"""Increments of a move, equal or at a pace, with cuts after failures. eq. (5.13)"""

from __future__ import annotations

import logging
import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from umform.analysis.newton.newton import Newton
from umform.analysis.steps.increment import no_convergence, take_increment
from umform.analysis.steps.move import Move
from umform.analysis.steps.pace import Happened
from umform.analysis.steps.run_state import Run, Take
from umform.analysis.steps.saved_state import Saved
from umform.analysis.steps.trail import changes
from umform.model.terms.control import OnDofs
from umform.model.tools.tool_controls import ToolWay
from umform.results.records import Cause, Converged, Failed

log = logging.getLogger("umform.analysis.steps")

#: Distance from a mark, in increments, that counts as zero.
_NEAR = 1e-9
#: Largest number of easy increments after which a failed size is tried again.
_LONGEST_PATIENCE = 24
#: A size is trusted after this number of successive increments.
_TRUSTED = 2
#: After a cut, increments at a pace stay below this part of the failed size; each success raises the limit.
_BELOW_FAILED, _RAISE = 0.6, 1.05

#: Beginning of what is said of a residual above its tolerance.
MISSED = "the residual"


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
        Next increment, as a fraction of the step.
    fraction : float
        Completed fraction of the step.
    last_size : float, optional
        Size of the last increment, for the extrapolation; None after a cut. At the beginning that of the previous step,
        if this one continues its direction.
    count : int
        Increments so far.
    done : bool
        Whether the step is complete.
    tried : float
        Largest increment tried from the present state.
    leaps : bool
        Whether the next increment has the nominal size because all smaller ones failed. eq. (5.132)
    """

    starts: list[float]
    start_time: float
    size: float
    fraction: float = 0.0
    last_size: float | None = None
    count: int = 0
    done: bool = False
    tried: float = 0.0
    leaps: bool = False

    @classmethod
    def begin(cls, run: Run, step: Move) -> Self:
        """The loop at the beginning of the step."""
        starts = [control.value for control in step.moved()]
        return cls(starts, run.model.system.time, step.nominal, last_size=_size_of_last(run, step, starts))

    @classmethod
    def recall(cls, run: Run, step: Move, memory: dict[str, Any]) -> Self:
        """The restored loop."""
        return cls(**memory)

    def memory(self) -> dict[str, Any]:
        """State of the loop, for checkpoints."""
        return dict(vars(self))

    def advance(self, run: Run, step: Move) -> None:
        """Try one increment."""
        target, model = self._leap(step) if self.leaps else self._target(step), run.model
        self.tried = max(self.tried, target - self.fraction)
        extrapolation = None if self.last_size is None else (target - self.fraction) / self.last_size
        x_before, active_before = model.system.x.copy(), run.evaluation.active
        if self._hopeless(step, 0.5 * (target - self.fraction)):
            run.statistics.begin_last_attempt()
        saved, mark = self._saved(run), run.newton.timing.attempts.mark()
        try:
            values = step.values(target, self.starts)
            time = self.start_time + target * step.time
            converged = take_increment(run, values, step.moved(), time, extrapolation, newton=self._newton(run))
        except Failed as failure:
            self._cut(run, step, failure, target)
            return
        if saved is not None and not self.leaps and self._repeats(run, step, target, converged):
            saved.restore(run)
            self.size = 0.5 * (target - self.fraction)
            run.newton.timing.attempts.take_back(mark, "difference of work and energies")
            return
        if converged.jumped:
            way = float(np.abs(model.u - x_before[: model.u.size]).max())
            run.result.warn(
                f"step {run.number}, time {time:.4f}: the stable path ends (buckling, or a hinge of a metal without "
                f"hardening): the sheet jumped to the next stable state, by up to {way:.3g}; the way between is dynamic"
            )
        if converged.missed:
            tolerance = run.newton.options.residual
            above = f"{MISSED} {converged.missed:.2g} of the forces is above the tolerance {tolerance:.2g}"
            run.result.warn(
                f"step {run.number}, time {time:.4f}: "
                f"{above if converged.missed > tolerance else 'the last correction is above its tolerance'}: neither "
                "Newton's method nor smaller increments come nearer under these tools; more contact points, or a "
                "softer penalty"
            )
        before, self.last_size, self.fraction = self.fraction, target - self.fraction, target
        self.count, self.tried, self.leaps = self.count + 1, 0.0, False
        self.done = target == 1.0
        if not self.done:
            self._adapt(step, converged, lambda: Happened.between(model, x_before, active_before, converged))
        frame = run.frames > 0 and (self.done or self._pictured(step, run.frames, before))
        run.keep(converged, step.moved(), name=f"step {run.number}", fraction=self.fraction, frame=frame)

    def follow(self, run: Run, step: Move, lead: Run, take: Take) -> None:
        """Repeat the last accepted increment of the loop of a leading run: the same fraction of the own step."""
        assert isinstance(lead.loop, Moving)
        self.fraction, self.done = lead.loop.fraction, lead.loop.done
        take(step.values(self.fraction, self.starts), step.moved(), self.start_time + self.fraction * step.time)

    def _newton(self, run: Run) -> Newton:
        """The method of the increments."""
        return run.newton

    def _saved(self, run: Run) -> Saved | None:
        """The state before the increment, if it may be repeated although it converges."""
        return None

    def _repeats(self, run: Run, step: Move, target: float, converged: Converged) -> bool:
        """Whether a converged increment is repeated with half the size."""
        return False

    @abstractmethod
    def _target(self, step: Move) -> float:
        """End of the increment."""

    @abstractmethod
    def _adapt(self, step: Move, converged: Converged, happened: Callable[[], Happened]) -> None:
        """Choose the size of the next increment."""

    @abstractmethod
    def _pictured(self, step: Move, frames: int, before: float) -> bool:
        """Whether the state is kept for pictures, for the approximate number of states."""

    def _cut(self, run: Run, step: Move, failure: Failed, target: float) -> None:
        """Halve a failed increment; below the smallest size, try the nominal size once, or end the run. eq. (5.132)"""
        self.size, self.last_size = 0.5 * (target - self.fraction), None
        if failure.cause is Cause.CYCLE:
            time = self.start_time + target * step.time
            run.result.warn(f"step {run.number}, time {time:.4f}: {failure.reason}; the increment is cut")
        log.info("step %d: %s; increment cut to %.3g", run.number, failure.reason, self.size)
        self.leaps = False
        if self._hopeless(step, self.size):
            driven = all(isinstance(control, ToolWay | OnDofs) for control in step.moved())
            if driven and self.tried < 0.5 * (self._leap(step) - self.fraction):
                log.info("step %d: no smaller increment converges; one of the nominal size follows", run.number)
                self.leaps = True
                return
            values = step.values(target, self.starts)
            raise no_convergence(run, failure, step.moved(), values) from None

    def _leap(self, step: Move) -> float:
        """End of an increment of the nominal size."""
        return min(1.0, self.fraction + step.nominal)

    @staticmethod
    def _hopeless(step: Move, size: float) -> bool:
        """Whether the run ends rather than try such a small increment."""
        return bool(size < step.nominal / 2**step.cuts)


@dataclass
class Marching(Moving):
    """Equal increments that grow again after a cut and return to the nominal marks.

    Attributes
    ----------
    easy : int
        Successive increments that took few iterations.
    patience : int
        Number of easy increments before the size grows; doubled after each growth that failed.
    grown : bool
        Whether increments have grown to a size that is not trusted yet.
    held : int
        Successive increments of this size.
    """

    easy: int = 0
    patience: int = 3
    grown: bool = False
    held: int = 0

    def _target(self, step: Move) -> float:
        """Between nominal marks, after a cut, continue to the next mark."""
        nominal = step.nominal
        passed = self.fraction / nominal
        next_mark = (math.floor(passed + _NEAR) + 1) * nominal
        on_mark = abs(passed - round(passed)) < _NEAR
        advance = min(self.size, (1.0 if on_mark else next_mark) - self.fraction)
        return 1.0 if self.fraction + advance > 1.0 - _NEAR * nominal else self.fraction + advance

    def _adapt(self, step: Move, converged: Converged, happened: Callable[[], Happened]) -> None:
        """Grow after some easy increments."""
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
    """Increments whose size adapts to the changes in the last one.

    Attributes
    ----------
    limit : float
        Largest size after a cut.
    """

    limit: float = math.inf

    def _target(self, step: Move) -> float:
        """Divide the rest equally if less than two increments remain."""
        rest = 1.0 - self.fraction
        if self.size >= rest * (1.0 - _NEAR):
            return 1.0
        return self.fraction + (0.5 * rest if self.size > 0.5 * rest else self.size)

    def _saved(self, run: Run) -> Saved | None:
        return Saved.of(run.model, run.evaluation)

    def _repeats(self, run: Run, step: Move, target: float, converged: Converged) -> bool:
        """Where works and energies differ too much; a jump has a difference whatever the size."""
        if converged.jumped:
            return False
        assert step.pace is not None
        return step.pace.repeats(target - self.fraction, run.result.worked(converged.evaluation))

    def _adapt(self, step: Move, converged: Converged, happened: Callable[[], Happened]) -> None:
        """Adapt the size to the pace."""
        assert step.pace is not None
        assert self.last_size is not None
        self.limit = math.inf if converged.missed else self.limit  # the size was not why the increments failed
        self.size = min(step.pace.factor(happened()) * self.last_size, step.pace.largest, self.limit)
        self.limit *= _RAISE

    def _pictured(self, step: Move, frames: int, before: float) -> bool:
        return math.floor(self.fraction * frames) > math.floor(before * frames)

    def _cut(self, run: Run, step: Move, failure: Failed, target: float) -> None:
        self.limit = _BELOW_FAILED * (target - self.fraction)
        super()._cut(run, step, failure, target)


def _size_of_last(run: Run, step: Move, starts: list[float]) -> float | None:
    """Size of the last increment in terms of the new step, if the step continues its direction."""
    if run.trail is None or run.newton.options.extrapolate < 2:
        return None
    by = np.subtract(step.values(step.nominal, starts), starts)
    size = run.trail.size(changes(run.model.controls, step.moved(), by))
    return None if size is None else size * step.nominal


def loop_of(step: Move) -> type[Moving]:
    """The loop that moves the controls of a step."""
    return Marching if step.pace is None else Pacing
