"""Move controls along lines or functions, in increments that are cut where they fail and grow back. eq. (5.13)"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from umform.errors import InvalidValue, NotFinite
from umform.model.control import Control
from umform.solution.records import Failed
from umform.steps.increment import no_convergence, take_increment
from umform.steps.loop import Run

log = logging.getLogger("umform.steps")

#: A fraction this near to a mark, in increments, is at the mark.
_NEAR = 1e-9


@dataclass(frozen=True)
class Move:
    """Move one or more controls along straight lines in time, or along functions of time.

    Parameters
    ----------
    control : Control or sequence of Control
        What is moved: a prescribed displacement, a load factor, a pressure, a tool.
    to : float, callable or sequence
        End value, or a function of the fraction (0 ... 1) of the step, one for each control.
    steps : int
        Number of equal increments.
    cuts : int
        How often an increment may be halved before the run is given up.
    grow : float
        Largest increment over the nominal one: 1 never grows beyond ``1/steps``.
    """

    control: Control | Sequence[Control]
    to: float | Callable[[float], float] | Sequence[float | Callable[[float], float]]
    steps: int = 10
    cuts: int = 10
    grow: float = 1.0

    def __post_init__(self) -> None:
        if not isinstance(self.steps, int) or self.steps < 1:
            raise InvalidValue("a step needs a whole number of increments, one at least", value=self.steps)
        if not isinstance(self.cuts, int) or self.cuts < 0:
            raise InvalidValue("cuts must be 0 or more", value=self.cuts)
        if not self.grow >= 1:
            raise InvalidValue("grow must be 1 or more", value=self.grow)
        for target in self.targets():
            if not callable(target) and not (np.isscalar(target) and np.isrealobj(target) and np.isfinite(target)):
                raise InvalidValue("a control is moved to a finite number or along a function", value=target)
        if len(self.targets()) != len(self.moved()):
            raise InvalidValue(
                "give one target for each control", value=f"{len(self.moved())} controls, {len(self.targets())} targets"
            )

    def moved(self) -> list[Control]:
        """The controls of the step."""
        return [self.control] if isinstance(self.control, Control) else list(self.control)

    def targets(self) -> list[float | Callable[[float], float]]:
        """Their targets."""
        return list(self.to) if isinstance(self.to, Sequence) else [self.to]

    def values(self, fraction: float, starts: Sequence[float]) -> list[float]:
        """Values of the controls at a fraction of the step that has begun at ``starts``."""
        values = [
            float(target(fraction)) if callable(target) else start + fraction * (target - start)
            for start, target in zip(starts, self.targets(), strict=True)
        ]
        for control, value in zip(self.moved(), values, strict=True):
            if not math.isfinite(value):
                where = f"fraction {fraction:g} of the step"
                raise NotFinite(f"the function that moves {control.name} is not finite", where=where, value=value)
        return values


@dataclass
class Moving:
    """Moves the controls of a step: cuts increments that fail, and lets them grow while Newton is at ease.

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
    easy : int
        Increments in a row that took few iterations.
    last_size : float, optional
        Size of the last increment, for the extrapolation; None after a cut.
    count : int
        Increments so far.
    done : bool
        Whether the step is at its end.
    """

    starts: list[float]
    start_time: float
    size: float
    fraction: float = 0.0
    easy: int = 0
    last_size: float | None = None
    count: int = 0
    done: bool = False

    @classmethod
    def begin(cls, run: Run, step: Move) -> Self:
        """The loop at the beginning of the step."""
        return cls([control.value for control in step.moved()], run.model.time, 1.0 / step.steps)

    @classmethod
    def recall(cls, run: Run, step: Move, memory: dict[str, Any]) -> Self:
        """The loop as it stood."""
        return cls(**memory)

    def memory(self) -> dict[str, Any]:
        """All that the loop remembers."""
        return dict(vars(self))

    def advance(self, run: Run, step: Move) -> None:
        """Try one increment."""
        target = self._target(1.0 / step.steps)
        extrapolation = None if self.last_size is None else (target - self.fraction) / self.last_size
        try:
            values = step.values(target, self.starts)
            converged = take_increment(run, values, step.moved(), self.start_time + target, extrapolation)
        except Failed as failure:
            self._cut(run, step, failure, target)
            return
        self._accept(step, target, len(converged.iterations))
        every = max(1, round(step.steps / run.frames)) if run.frames > 0 else 0
        frame = bool(every) and (self.count % every == 0 or self.done)
        run.keep(converged, step.moved(), name=f"step {run.number}", fraction=self.fraction, frame=frame)

    def _target(self, nominal: float) -> float:
        """Where the increment goes: off the nominal marks, after a cut, the next one is met again."""
        passed = self.fraction / nominal
        next_mark = (math.floor(passed + _NEAR) + 1) * nominal
        on_mark = abs(passed - round(passed)) < _NEAR
        advance = min(self.size, (1.0 if on_mark else next_mark) - self.fraction)
        return 1.0 if self.fraction + advance > 1.0 - _NEAR * nominal else self.fraction + advance

    def _accept(self, step: Move, target: float, iterations: int) -> None:
        nominal = 1.0 / step.steps
        self.last_size, self.fraction = target - self.fraction, target
        self.count += 1
        self.easy = self.easy + 1 if iterations <= 8 else 0
        if self.easy >= 3 and self.size < step.grow * nominal * (1 - 1e-12):
            self.size = min(2.0 * self.size, step.grow * nominal)
            self.easy = 0
        self.done = target >= 1.0 - _NEAR * nominal

    def _cut(self, run: Run, step: Move, failure: Failed, target: float) -> None:
        """Halve an increment that failed, or give up."""
        self.size, self.easy, self.last_size = 0.5 * (target - self.fraction), 0, None
        if failure.chattering:
            time = self.start_time + target
            run.result.warn(f"step {run.number}, time {time:.4f}: {failure.reason}; the increment is cut")
        log.info("step %d: %s; increment cut to %.3g", run.number, failure.reason, self.size)
        if self.size < 1.0 / step.steps / 2**step.cuts:
            values = step.values(target, self.starts)
            raise no_convergence(run, failure, step.moved(), values) from None
