"""Steps: move controls with cutting and growth; and `solve`, which runs steps of all kinds in a row."""

from __future__ import annotations

import logging
import math
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.arc import Arc, follow
from umform.boundary import Control
from umform.errors import InvalidValue, NotFinite
from umform.increment import Run, no_convergence, take_increment
from umform.model import Model
from umform.newton import Failed, Newton, NewtonOptions
from umform.release import Release, release
from umform.results import Result

__all__ = ["Arc", "Move", "Release", "Step", "solve"]

log = logging.getLogger("umform.steps")

Floats = NDArray[np.float64]


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

    def path(self) -> Callable[[float], list[float]]:
        """Values of the controls as a function of the fraction of the step, from where they stand now."""
        starts = [control.value for control in self.moved()]

        def at(fraction: float) -> list[float]:
            values = [
                float(target(fraction)) if callable(target) else start + fraction * (target - start)
                for start, target in zip(starts, self.targets(), strict=True)
            ]
            for control, value in zip(self.moved(), values, strict=True):
                if not math.isfinite(value):
                    where = f"fraction {fraction:g} of the step"
                    raise NotFinite(f"the function that moves {control.name} is not finite", where=where, value=value)
            return values

        return at


Step = Move | Release | Arc


def solve(
    model: Model,
    steps: Sequence[Step] | Step,
    *,
    solver: str = "auto",
    options: NewtonOptions | None = None,
    frames: int = 60,
    progress: bool | None = None,
) -> Result:
    """Solve a model step by step.

    Parameters
    ----------
    model : Model
        The model; it is left at its last converged state, whatever happens.
    steps : Step or sequence of Step
        What happens, in a row.
    solver : str
        Sparse solver, see :mod:`umform.solvers`.
    options : NewtonOptions, optional
        Tolerances, line search, predictor.
    frames : int
        About how many states are kept for pictures in each step (the history has all of them); 0 keeps none.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.

    Returns
    -------
    Result
        History, frames and iterations.

    Raises
    ------
    NoConvergence
        If an increment fails at its smallest size.
    RigidBodyMotion, ToolSwallowsSheet
        If the model cannot be solved as it stands.

    Notes
    -----
    Any exception that ends the run, Ctrl-C too, carries all that was reached as its attribute ``result``.
    """
    from umform.progress import progress_bar

    sequence = [steps] if isinstance(steps, Step) else list(steps)
    for number, step in enumerate(sequence, start=1):
        if not isinstance(step, Step):
            raise InvalidValue("a step is a Move, a Release or an Arc", where=f"step {number}", value=step)
        for control in [step.control] if isinstance(step, Release) else step.moved():
            if control not in model.controls:
                raise InvalidValue(
                    "a step moves a control that the model does not have",
                    where=f"step {number}",
                    value=control,
                    cause="it belongs to another model",
                    remedy="use what prescribe(), force(), pressure() or drive() of this model returned",
                )
    model.check()
    run = Run(model, Newton(model, options, solver), Result(model))
    start = clock.perf_counter()
    run.result.solver = run.newton.solver
    run.result.add(model.evaluate(model.u).residual, [], frame=frames > 0)
    with progress_bar(progress) as tick:
        run.tick = tick
        for number, step in enumerate(sequence, start=1):
            try:
                if isinstance(step, Move):
                    _move(run, step, number, frames)
                elif isinstance(step, Arc):
                    follow(run, step, number, frames)
                else:
                    release(run, step, number, frames)
            except BaseException as error:  # whatever ends the run: what was reached is kept with the error
                run.result.seconds = clock.perf_counter() - start
                error.result = run.result  # type: ignore[attr-defined]
                raise
    run.result.seconds = clock.perf_counter() - start
    return run.result


def _move(run: Run, step: Move, number: int, frames: int) -> None:
    model = run.model
    controls, path, start_time = step.moved(), step.path(), model.time
    nominal = 1.0 / step.steps
    fraction, size, easy = 0.0, nominal, 0
    smallest = nominal / 2**step.cuts
    last_size: float | None = None
    every = max(1, round(step.steps / frames)) if frames > 0 else 0
    count = 0
    while fraction < 1.0 - 1e-9 * nominal:
        passed = fraction / nominal
        next_mark = (math.floor(passed + 1e-9) + 1) * nominal
        on_mark = abs(passed - round(passed)) < 1e-9  # off the nominal marks, after a cut, the next one is met again
        advance = min(size, (1.0 if on_mark else next_mark) - fraction)
        target = 1.0 if fraction + advance > 1.0 - 1e-9 * nominal else fraction + advance
        extrapolation = None if last_size is None else (target - fraction) / last_size
        try:
            converged = take_increment(run, path(target), controls, start_time + target, extrapolation)
        except Failed as failure:
            size = 0.5 * (target - fraction)
            easy = 0
            last_size = None
            if failure.chattering:
                run.result.warn(
                    f"step {number}, time {start_time + target:.4f}: {failure.reason}; the increment is cut"
                )
            log.info("step %d: %s; increment cut to %.3g", number, failure.reason, size)
            if size < smallest:
                raise no_convergence(failure, number, controls, path(target)) from None
            continue
        last_size = target - fraction
        fraction = target
        count += 1
        easy = easy + 1 if len(converged.iterations) <= 8 else 0
        if easy >= 3 and size < step.grow * nominal * (1 - 1e-12):
            size = min(2.0 * size, step.grow * nominal)
            easy = 0
        last = fraction >= 1.0 - 1e-9 * nominal
        run.result.add(
            converged.residual, converged.iterations, step=number, frame=bool(every) and (count % every == 0 or last)
        )
        run.tick(f"step {number}", fraction)
