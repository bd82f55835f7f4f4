"""Steps: move controls with cutting and growth, release them to zero force; and `solve`, which runs them in a row."""

from __future__ import annotations

import logging
import math
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from umform.boundary import Control
from umform.errors import InvalidValue, NoConvergence, NotFinite
from umform.model import Model
from umform.newton import Converged, Failed, Iteration, Newton, NewtonOptions
from umform.results import Result

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


@dataclass(frozen=True)
class Release:
    """Take a displacement or a tool back until its force is zero (or contact has lifted off).

    Parameters
    ----------
    control : Control
        A prescribed displacement or a tool motion.
    increment : float, optional
        Size of the first increment of the way back; default 1/1000 of the present value. It doubles while Newton is at
        ease, up to a twentieth of the value.
    tolerance : float
        Force that counts as zero, relative to the force at the beginning.
    """

    control: Control
    increment: float | None = None
    tolerance: float = 1e-6

    def __post_init__(self) -> None:
        if self.increment is not None and not self.increment > 0:
            raise InvalidValue("the increment of a release must be positive", value=self.increment)
        if not self.tolerance > 0:
            raise InvalidValue("the tolerance of a release must be positive", value=self.tolerance)


Step = Move | Release


@dataclass
class _Run:
    """State of a run: the model, Newton, the result, and the last increment for the extrapolation."""

    model: Model
    newton: Newton
    result: Result
    last_du: Floats | None = None
    last_fraction: float = 0.0
    tick: Callable[[str, float], None] = field(default=lambda name, done: None)


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

    sequence = [steps] if isinstance(steps, Move | Release) else list(steps)
    for number, step in enumerate(sequence, start=1):
        if not isinstance(step, Move | Release):
            raise InvalidValue("a step is a Move or a Release", where=f"step {number}", value=step)
        for control in step.moved() if isinstance(step, Move) else [step.control]:
            if control not in model.controls:
                raise InvalidValue(
                    "a step moves a control that the model does not have",
                    where=f"step {number}",
                    value=control,
                    cause="it belongs to another model",
                    remedy="use what prescribe(), force(), pressure() or drive() of this model returned",
                )
    model.check()
    run = _Run(model, Newton(model, options, solver), Result(model))
    start = clock.perf_counter()
    run.result.solver = run.newton.solver
    run.result.add(model.evaluate(model.u).residual, [], frame=frames > 0)
    with progress_bar(progress) as tick:
        run.tick = tick
        for number, step in enumerate(sequence, start=1):
            try:
                if isinstance(step, Move):
                    _move(run, step, number, frames)
                else:
                    _release(run, step, number, frames)
            except BaseException as error:  # whatever ends the run: what was reached is kept with the error
                run.result.seconds = clock.perf_counter() - start
                error.result = run.result  # type: ignore[attr-defined]
                raise
    run.result.seconds = clock.perf_counter() - start
    return run.result


def _increment(
    run: _Run, values: Sequence[float], controls: Sequence[Control], time: float, extrapolation: float | None
) -> Converged:
    """One increment to new values of the controls; on failure everything stands as before."""
    model = run.model
    before, time_before = [control.value for control in controls], model.time
    for control, value in zip(controls, values, strict=True):
        control.value = float(value)
    model.time = time
    guess = None
    if extrapolation is not None and run.last_du is not None and run.newton.options.extrapolate:
        guess = extrapolation * run.last_du
    u_before = model.u.copy()
    try:
        try:
            converged = run.newton.solve(guess)
        except Failed:
            if guess is None:
                raise
            converged = run.newton.solve(None)  # the extrapolation may have gone too far: once more from the tangent
    except BaseException:  # no convergence, Ctrl-C, a user's function: the last converged state stands
        for control, value in zip(controls, before, strict=True):
            control.value = value
        model.time = time_before
        model.revert()
        raise
    model.commit(converged.u)
    run.last_du = model.u - u_before
    return converged


def _move(run: _Run, step: Move, number: int, frames: int) -> None:
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
            converged = _increment(run, path(target), controls, start_time + target, extrapolation)
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
                raise _no_convergence(failure, number, controls, path(target), step) from None
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


def _release(run: _Run, step: Release, number: int, frames: int) -> None:
    """Secant on force against displacement from saved states; lift-off is bracketed to 1e-6 of the value. eq. (5.14)"""
    model, control = run.model, step.control
    start_time, start_value = model.time, control.value
    evaluation = model.evaluate(model.u)
    force = model.conjugate_force(control, evaluation.residual)
    scale = abs(force)
    if start_value == 0.0 or scale <= 1e-9 * evaluation.force_scale:
        run.result.note(f"step {number}: nothing to release, the force of {control.name} is zero")
        return
    size = -math.copysign(step.increment or abs(start_value) / 1000.0, start_value)
    largest, resolution = abs(start_value) / 20.0, 1e-6 * abs(start_value)
    before: tuple[float, float] | None = None  # value and force of the state before the present one
    bound: float | None = None  # a value where the force is known to be zero or beyond
    finest = resolution  # of the way to the bound: where the force changes sign, only its zero counts
    taken: float | None = None
    failures = attempts = 0
    while True:
        saved, value, touching = model.snapshot(), control.value, bool(model.active_set().any())
        target = _next_release(value, force, before, bound, size, finest)
        if target * start_value < 0.0:
            target = 0.0
        if target == value or attempts > 50:  # the force jumps over zero
            jump = Failed("the zero of the force cannot be closed in", [])
            raise _no_convergence(jump, number, [control], [target], step)
        time = start_time + 1.0 - target / start_value
        try:
            converged = _increment(run, [target], [control], time, None if taken is None else (target - value) / taken)
        except Failed as failure:
            size, taken, failures = 0.25 * size, None, failures + 1
            if failures > 20:
                raise _no_convergence(failure, number, [control], [target], step) from None
            continue
        force_there = model.conjugate_force(control, converged.residual)
        zero = abs(force_there) <= step.tolerance * scale
        lifted = touching and zero and not model.active_set().any()
        if (force_there * force < 0.0 and not zero) or (lifted and abs(target - value) > 2.5 * resolution):
            bound, finest, attempts = target, resolution if lifted else 0.0, attempts + 1
            model.restore(saved)
            model.evaluate(model.u)
            run.last_du, taken = None, None
            if not lifted:
                size = (target - value) * force / (force - force_there)
                before = None
            continue
        before, taken, force = (value, force), target - value, force_there
        done = zero or target == 0.0
        run.result.add(converged.residual, converged.iterations, step=number, frame=frames > 0 and done)
        run.tick(f"step {number}: release", 1.0 if done else 1.0 - min(1.0, abs(force) / scale))
        if done:
            how = "contact has lifted off" if lifted else "the force is zero" if zero else "the way back is complete"
            run.result.note(f"step {number}: {how} at {control.name} = {control.value:.6g}")
            return
        if bound is None and abs(2.0 * size) <= largest and len(converged.iterations) <= 8:
            size *= 2.0


def _next_release(
    value: float, force: float, before: tuple[float, float] | None, bound: float | None, size: float, resolution: float
) -> float:
    """Next value of a control on its way to zero force; with a bound, close in on the zero from the loaded side."""
    if bound is None:
        return value + size
    sign = 1.0 if bound > value else -1.0
    if abs(bound - value) <= 2.5 * resolution:
        return bound
    if before is None or before[0] == value:  # crossed zero: the size is that of the secant
        return value + size if abs(size) < abs(bound - value) else 0.5 * (value + bound)
    slope = (force - before[1]) / (value - before[0])
    zero = value - force / slope if slope != 0.0 else bound
    if sign * (zero - value) <= 0.0 or sign * (bound - zero) < 0.0:
        zero = 0.5 * (value + bound)
    if abs(zero - value) <= 1.5 * resolution:
        return value + sign * 2.0 * resolution
    return value + 0.99 * (zero - value)


def _no_convergence(
    failure: Failed, number: int, controls: Sequence[Control], values: Sequence[float], step: Step
) -> NoConvergence:
    goal = ", ".join(f"{c.name} = {v:.6g}" for c, v in zip(controls, values, strict=True))
    return NoConvergence(
        "Newton's method did not converge at the smallest increment",
        where=f"step {number}, on the way to {goal}",
        value=_history(failure.iterations),
        cause=failure.reason,
        remedy="look at the last converged state (it is kept): buckling, a pinched sheet, folded elements; "
        "else take more steps, fewer contact jumps (more contact points), a softer penalty or line_search=True",
    )


def _history(iterations: Sequence[Iteration]) -> str:
    tail = [f"{record.residual:.1e}" for record in iterations[-4:]]
    return "last residuals " + ", ".join(tail) if tail else "no iteration"
