"""One increment of a run: set the controls, let Newton find the equilibrium, commit; or put everything back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from umform.boundary import Control
from umform.errors import NoConvergence
from umform.model import Model
from umform.newton import Converged, Failed, Iteration, Newton
from umform.results import Result

Floats = NDArray[np.float64]


@dataclass
class Run:
    """State of a run: the model, Newton, the result, and the last increment for the extrapolation."""

    model: Model
    newton: Newton
    result: Result
    last_du: Floats | None = None
    last_fraction: float = 0.0
    tick: Callable[[str, float], None] = field(default=lambda name, done: None)


def take_increment(
    run: Run, values: Sequence[float], controls: Sequence[Control], time: float, extrapolation: float | None
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


def no_convergence(failure: Failed, number: int, controls: Sequence[Control], values: Sequence[float]) -> NoConvergence:
    """Error for step ``number`` that could not bring the controls to the values."""
    goal = ", ".join(f"{c.name} = {v:.6g}" for c, v in zip(controls, values, strict=True))
    return NoConvergence(
        "Newton's method did not converge at the smallest increment",
        where=f"step {number}, on the way to {goal}",
        value=last_residuals(failure.iterations),
        cause=failure.reason,
        remedy="look at the last converged state (it is kept): buckling, a pinched sheet, folded elements; "
        "else take more steps, fewer contact jumps (more contact points), a softer penalty or line_search=True",
    )


def last_residuals(iterations: Sequence[Iteration]) -> str:
    """Residuals of the last iterations in words."""
    tail = [f"{record.residual:.1e}" for record in iterations[-4:]]
    return "last residuals " + ", ".join(tail) if tail else "no iteration"
