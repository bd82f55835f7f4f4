"""One increment of a run: set the controls, solve with Newton's method, commit; or restore the previous state."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.augmentation import augmented
from umform.analysis.newton.growing_penalties import relaxed, within_allowed
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.strategies import Increment, equilibrium
from umform.analysis.steps.crushed import crushed
from umform.analysis.steps.limit_load import limit_load
from umform.analysis.steps.own_parts import own_parts
from umform.analysis.steps.run_state import Run
from umform.analysis.steps.thinned import thinned
from umform.analysis.steps.trail import Trail, changes
from umform.errors import NoConvergence
from umform.model.equations.checks import diagnosis
from umform.model.terms.control import Control
from umform.model.terms.state import State
from umform.model.transfer.loose_part import loose_part
from umform.results.records import Cause, Converged, Failed, Iteration

Floats = NDArray[np.float64]

log = logging.getLogger("umform.analysis.steps")


def take_increment(
    run: Run,
    values: Sequence[float],
    controls: Sequence[Control],
    time: float,
    extrapolation: float | None,
    *,
    keep: bool = True,
    newton: Newton | None = None,
) -> Converged:
    """One increment to new values of the controls; after a failure the previous state is restored.

    With ``keep`` an extrapolation keeps the contact points: not where tools are to lose the sheet. eq. (4.230)
    Another ``newton`` than that of the run has other tolerances.
    """
    model, newton = run.model, newton or run.newton
    start = model.state
    targets = {control.name: float(value) for control, value in zip(controls, values, strict=True)}
    goal, x_before = start.toward(targets, time), start.x.copy()
    penalties = model.system.penalties
    try:
        guess = None if extrapolation is None or run.trail is None else run.trail.guess(extrapolation)
        increment = Increment(model, newton, run.statistics, goal, tuple(controls), guess, run.evaluation, keep)
        converged, x_soft = _within_allowed(increment)
        try:
            with _counted(run):
                converged = augmented(model, newton, converged)
            _multipliers_stay(run, goal, None)
        except Failed as failure:  # a smaller increment would fail in the same pass: accept the penalty solution
            _multipliers_stay(run, goal, failure)
            model.system.prepare(goal)
            converged = equilibrium(replace(increment, guess=converged.x - x_before, grows=False))
    except BaseException as error:  # no convergence, Ctrl-C, an error of a user's function: restore the previous state
        if isinstance(error, Failed):
            run.statistics.count_penetration(kept=False)
        model.system.use_penalties(penalties)
        model.system.revert()
        raise
    if not model.system.too_deep(converged.evaluation):
        run.statistics.count_penetration(kept=True)
    model.system.commit(converged.evaluation)
    by = np.subtract(values, [start.controls[control.name] for control in controls])
    way = changes(model.controls, controls, by)
    earlier = run.trail if run.newton.options.extrapolate > 1 else None
    reached = model.system.x if x_soft is None else x_soft
    tangent = _along_tangent(run, newton, converged, dict(zip(controls, by.tolist(), strict=True)))
    run.trail = Trail.of(reached - x_before if tangent is None else tangent, way, earlier, extrapolation)
    run.evaluation = converged.evaluation.without_tangent()
    return converged


def _along_tangent(run: Run, newton: Newton, converged: Converged, by: Mapping[Control, float]) -> Floats | None:
    """The same changes of the controls again, along the tangent: in stable elastic sheets without contact; else None.

    The iterations have left their last factors, which are near those of the tangent. eq. (5.133)
    """
    system = run.model.system
    elastic = newton.mixed and system.smooth and not system.unknowns
    if newton.options.extrapolate != 1 or not (elastic and run.statistics.stable):
        return None
    if converged.linear or len(converged.iterations) == 1:  # the increment itself is as good
        return None
    return newton.along_last_factors(system.rate(system.state, by))


def _within_allowed(increment: Increment) -> tuple[Converged, Floats | None]:
    """Equilibrium with penalties that keep the allowed penetration; if they grew, the displacement before."""
    model, goal, yields = increment.model, increment.goal, increment.statistics.yields
    try:
        converged = equilibrium(increment)
    except Failed:
        if not (yields and relaxed(model)):
            raise
        model.system.prepare(goal)  # perhaps grown penalties are too stiff for this increment
        converged = equilibrium(increment)
    if not model.system.too_deep(converged.evaluation):
        return converged, None
    x_soft = converged.x.copy()
    again = lambda: equilibrium(replace(increment, guess=x_soft - model.system.x, grows=False))  # noqa: E731
    return within_allowed(model, increment.newton, converged, again, yields), x_soft


def _multipliers_stay(run: Run, goal: State, failure: Failed | None) -> None:
    """Mark the pairs whose multipliers stay constant because an augmentation failed, and warn of it."""
    pairs = run.model.system.multiplied
    for pair in pairs:
        pair.multipliers_stay = failure is not None
    if failure is not None:
        columns = ", ".join(f"{pair.name}_multipliers_stay" for pair in pairs)
        run.result.warn(
            f"step {run.number}, time {goal.time:.4f}: {failure.reason} in a pass of the multipliers: they stay "
            f"what they were, and more penetration is left (columns {columns}); smaller increments, or a softer penalty"
        )


def _counted(run: Run) -> AbstractContextManager[None]:
    """Number of augmentations, if there are multipliers."""
    return run.newton.timing.attempts.trying("multipliers") if run.model.system.multiplied else nullcontext()


def no_convergence(run: Run, failure: Failed, controls: Sequence[Control], values: Sequence[float]) -> NoConvergence:
    """Error for the present step, in which the controls did not reach the values."""
    goal = ", ".join(f"{c.name} = {v:.6g}" for c, v in zip(controls, values, strict=True))
    cause, remedy = (
        failure.reason,
        (
            "look at the last converged state (it is kept): buckling, a pinched sheet, folded elements; "
            "else take more steps, fewer contact jumps (more contact points), or a softer penalty"
        ),
    )
    loose = diagnosis(run.model.system) if failure.cause is Cause.SINGULAR else None
    if loose is not None:
        cause, remedy = f"{cause}: {loose[0]}", loose[1]
    elif failure.motion is not None and failure.cause is Cause.SINGULAR:
        cause = f"{cause}: {loose_part(run.model.system, failure.motion)}"
        remedy = (
            "hold what moves with fix(), symmetry() or hinge(), or join its nodes to those of the rest; at a limit "
            "point prescribe displacements instead of forces"
        )
    elif failure.motion is not None:  # of a very thin sheet, eq. (5.99)
        slenderness = float(f"{run.model.system.extent / run.model.system.thickness:.2g}")
        cause = (
            f"{cause}; the sheet is {slenderness:.0f} times as long as thick, and bending resists less than round-off"
        )
        remedy = f"hold the sheet in more places, or take a thicker or a shorter one; else {remedy}"
    limit = limit_load(run, controls) if loose is None else None
    burst = thinned(run)
    if limit is not None:
        cause, remedy = limit
    elif burst is not None:
        cause, remedy = f"{cause}; {burst[0]}", burst[1]
    remedy += own_parts(run.model)
    pressed = pressed_tools(run)
    if pressed:
        cause = f"{cause}; at the last converged state {'; '.join(pressed)}"
        remedy = f"{remedy}; a force that the sheet does not answer: less of it, a spring, a stop, or drive the tool"
    deep = crushed(run)
    if deep and burst is None:
        cause = f"{cause}; at the last converged state {'; '.join(deep)}"
        remedy = (
            "a smaller force: a force or pressure is probably in another unit, or that of the whole part on a piece of "
            "it; if the forces are right, a stiffer penalty"
        )
    return NoConvergence(
        "Newton's method did not converge at the smallest increment",
        where=f"step {run.number}, on the way to {goal}",
        value=last_residuals(failure.iterations),
        cause=cause,
        remedy=remedy,
    )


def pressed_tools(run: Run) -> list[str]:
    """Number of points in contact of each force-driven tool at the last converged state, as text."""
    ranks, found, words = run.model.system.ranks, run.evaluation.found, []
    for press in (press for tool in run.model.tools for press in tool.presses if not press.held):
        pairs = [found[pair].active for tool in press.way.tools for pair in tool.pairs]
        touching = int(ranks.sum(float(sum(active.sum() for active in pairs))))
        held = f"holds the sheet at {touching} points" if touching else "does not touch the sheet"
        words.append(f"tool {press.way.tool.name}, pressed with {press.force.name} = {press.force.value:.6g}, {held}")
    return words


def last_residuals(iterations: Sequence[Iteration]) -> str:
    """Residuals of the last iterations as text."""
    tail = [f"{record.residual:.1e}" for record in iterations[-4:]]
    return "last residuals " + ", ".join(tail) if tail else "no iteration"
