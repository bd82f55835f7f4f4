"""Take a control back until its force is zero or contact has lifted off."""

from __future__ import annotations

import math
from dataclasses import dataclass

from umform.boundary import Control
from umform.errors import InvalidValue
from umform.increment import Run, no_convergence, take_increment
from umform.newton import Failed


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


def release(run: Run, step: Release, number: int, frames: int) -> None:
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
            raise no_convergence(jump, number, [control], [target])
        time = start_time + 1.0 - target / start_value
        try:
            converged = take_increment(
                run, [target], [control], time, None if taken is None else (target - value) / taken
            )
        except Failed as failure:
            size, taken, failures = 0.25 * size, None, failures + 1
            if failures > 20:
                raise no_convergence(failure, number, [control], [target]) from None
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
