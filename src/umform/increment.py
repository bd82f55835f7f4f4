"""One increment of a run: set the controls, let Newton find the equilibrium, commit; or put everything back.

A run is a state machine: between two increments all that it will do follows from the model, from what `Run` holds and
from the `Loop` of the step that is under way. There it may be written to a checkpoint, stopped and taken up again.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from umform.boundary import Control
from umform.contact.augmentation import augmented
from umform.contact.softening import softened
from umform.errors import NoConvergence
from umform.model import Model
from umform.newton import Converged, Failed, Iteration, Newton
from umform.progress import Tick, silent
from umform.results import Result

log = logging.getLogger("umform.steps")

Floats = NDArray[np.float64]


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
    last_du : ndarray, shape (3 n,), optional
        The last increment of displacement, for the extrapolation.
    history : ndarray
        History of the material that the last evaluation at ``model.u`` has read: with it that evaluation can be made
        again, to the last bit, and with it the blocks that the next enhanced parameters are recovered with.
    tick, pause : callable
        Shows where the run stands; writes checkpoints and stops the run, between increments.
    """

    model: Model
    newton: Newton
    result: Result
    frames: int = 60
    number: int = 1
    loop: Loop | None = None
    last_du: Floats | None = None
    history: Floats = field(default_factory=lambda: np.empty(0))
    tick: Tick = silent
    pause: Callable[[], None] = field(default=lambda: None)

    def keep(
        self, converged: Converged, controls: Sequence[Control], *, name: str, fraction: float, frame: bool
    ) -> None:
        """Add a converged increment of the step to the result and show how far the step ``name`` has come."""
        self.result.add(converged.residual, converged.iterations + converged.passes, step=self.number, frame=frame)
        row = self.result.rows[-1]
        forces = [f"{c.name} {row[c.name]:.5g}, force {row[f'{c.name}_force']:.5g}" for c in controls]
        self.tick(name, fraction, "; ".join([*forces, f"{row['iterations']} iterations"]))


def take_increment(
    run: Run, values: Sequence[float], controls: Sequence[Control], time: float, extrapolation: float | None
) -> Converged:
    """One increment to new values of the controls; on failure everything stands as before."""
    model = run.model
    before, time_before = [control.value for control in controls], model.time
    for control, value in zip(controls, values, strict=True):
        control.value = float(value)
    model.time = time
    u_before, history = model.u.copy(), model.block.state
    try:
        starts = dict(zip(controls, before, strict=True))
        converged = _converged(run, starts, time_before, extrapolation)
        try:
            converged = augmented(model, run.newton, converged)
        except Failed as failure:  # a smaller increment would end in the same pass: it is taken as the penalty has it
            log.info("%s in a pass of the multipliers: they stay what they were", failure.reason)
            converged = _converged(run, starts, time_before, None)
    except BaseException:  # no convergence, Ctrl-C, a user's function: the last converged state stands
        for control, value in zip(controls, before, strict=True):
            control.value = value
        model.time = time_before
        model.revert()
        raise
    model.commit(converged.u)
    run.last_du, run.history = model.u - u_before, history
    return converged


def _converged(run: Run, before: Mapping[Control, float], time: float, extrapolation: float | None) -> Converged:
    """Equilibrium at the new values, from the first start that leads there. docs/theory, 4.13

    The extrapolation, then the tangent, then the consistent tangent throughout, which may cross a sudden change of
    shape where the mixed one of (5.39) does not; with contact a line search, for where one row of points holds the
    sheet a full step may lose it; and softer penalties, for a stiff tool may come to where nothing touched before.
    """
    newton, touches = run.newton, bool(run.model.contacts)
    if extrapolation is not None and run.last_du is not None and newton.options.extrapolate:
        try:
            return newton.solve(extrapolation * run.last_du)
        except Failed:  # it may have gone too far
            pass
    ways = [(False, False)]  # whether the tangent is consistent, and whether a line is searched
    if newton.mixed:
        ways.append((True, False))
    if touches and not newton.options.line_search:
        ways.append((True, True))
    failures = []
    for consistent, search in ways:
        try:
            start = _tangent(run, before, time) if touches else None
            return newton.solve(start, line_search=search, consistent=consistent)
        except Failed as failure:
            failures.append(failure)
    if not touches:
        raise failures[-1]
    try:
        return softened(run.model, newton, _tangent(run, before, time))
    except Failed:
        raise failures[-1] from None  # what fails is the increment with the penalty of the user


def _tangent(run: Run, before: Mapping[Control, float], time: float) -> Floats | None:
    """Increment along the tangent of the last converged state, which goes with the tools that touch it. eq. (4.36)

    None where nothing holds the sheet there but a tool that is still to come.
    """
    model, newton = run.model, run.newton
    after, time_after = {control: control.value for control in before}, model.time
    rates = {control: after[control] - value for control, value in before.items()}

    def increment() -> Floats:
        evaluation = model.evaluate(model.u, rates=rates, until=time_after)
        newton.check_domain(evaluation, [])
        solver = newton.ready_solver()
        solver.factor(evaluation.values)
        return model.extend(solver.solve(-model.restrict(evaluation.residual + evaluation.predictor)))

    _put(before, time, model)
    try:
        return newton.guarded(increment)
    except Failed:
        return None
    finally:
        _put(after, time_after, model)


def _put(values: Mapping[Control, float], time: float, model: Model) -> None:
    for control, value in values.items():
        control.value = value
    model.time = time


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
