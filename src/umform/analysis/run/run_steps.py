"""Execution of a run: preparation, steps, actions between increments."""

from __future__ import annotations

import time as clock
from collections.abc import Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run.early_end import Stopped, ended_early
from umform.analysis.run.interrupt import Interrupt, gentle_interrupt
from umform.analysis.run.loose import note_springs
from umform.analysis.run.observers import show
from umform.analysis.run.result import Result
from umform.analysis.steps import Step
from umform.analysis.steps.arc_length.arc import Arc, Following
from umform.analysis.steps.close import Close, Closing
from umform.analysis.steps.free import Free, Freeing
from umform.analysis.steps.move import Move
from umform.analysis.steps.moving import loop_of
from umform.analysis.steps.release import Release, Releasing
from umform.analysis.steps.run_state import Run
from umform.errors import InvalidValue, NoConvergence
from umform.progress import Show, Tick, progress_bar
from umform.results.bottoming import warn_of_bottoming
from umform.results.drift import warn_of_drift
from umform.results.imbalance import warn_of_imbalance
from umform.results.penetration import warn_of_contact
from umform.results.rest_springs import tell_of_rest
from umform.results.shared_faces import warn_of_shared_faces
from umform.results.untouched import warn_of_untouched
from umform.results.volume_warning import warn_of_volume
from umform.solvers.one_thread import one_thread
from umform.spec import check_value
from umform.spec.types import Frames

if TYPE_CHECKING:
    from umform.analysis.run.checkpoint import Checkpoints

_LOOPS: dict[type, Any] = {Release: Releasing, Arc: Following, Free: Freeing, Close: Closing}


def ready(
    result: Result, solver: str, options: NewtonOptions | None, frames: Frames, steps: Sequence[Step] = ()
) -> Run:
    """Refuse an invalid model, and make the run at its first state; a first step may hold the sheet."""
    check_value(ready, "frames", frames)
    if not isinstance(options, NewtonOptions | None):
        raise InvalidValue(
            "options are those of Newton's method",
            where="options",
            value=options,
            cause="a mapping, or a class in place of its options",
            remedy="NewtonOptions(residual=1e-9)",
        )
    model, timing = result.model, result.timing
    model.system.timing = timing
    first = steps[0] if steps else None
    model.system.check(first.on if isinstance(first, Free) else None)
    evaluation = model.system.evaluate(model.system.x, tangent=False)  # history and frames need forces only
    model.system.begin(evaluation)
    run = Run(model, Newton(model.system, options, solver, timing), result, evaluation, frames=frames)
    run.result.solver = run.newton.solver
    note_springs(model, result)
    return run


def begun(result: Result, solver: str, options: NewtonOptions | None, frames: int) -> Run:
    """A run at its first state, which is in the result."""
    run = ready(result, solver, options, frames)
    result.add(run.evaluation, [], frame=frames > 0)
    return run


def checkpoints_of(
    run: Run,
    steps: Sequence[Step],
    path: str | PathLike[str] | None,
    every: float,
    note: Mapping[str, Any] | None = None,
) -> Checkpoints | None:
    """The checkpoints of a run; None without a path."""
    if path is None:
        return None
    from umform.analysis.run.checkpoint import Checkpoints  # imported late: few runs need it
    from umform.analysis.run.fingerprint import fingerprint

    whole = run.model.system.whole.described  # the first rank writes and compares
    marks = {} if whole is None else fingerprint(whole, steps, run.newton, run.frames)
    if run.follower is not None:
        marks["shadows"] = run.follower.mark()
    return Checkpoints(path, every, marks, note, run.model.system.ranks)


def go_on(run: Run, steps: Sequence[Step], progress: Show, checkpoints: Checkpoints | None) -> None:
    """Continue to the end from the present state."""
    talks = run.model.system.ranks.rank == 0
    with progress_bar(progress if talks else False) as tick:
        taken(run, steps, tick, checkpoints, last=True)


def taken(
    run: Run, steps: Sequence[Step], tick: Tick, checkpoints: Checkpoints | None = None, *, last: bool = False
) -> None:
    """Execute the steps from ``run.number``; after the last one, add the final notes and warnings."""
    result = run.result
    start = clock.perf_counter() - result.seconds
    with gentle_interrupt() as stop, one_thread():
        run.tick, run.pause = tick, lambda: _pause(run, start, checkpoints, stop)
        try:
            while run.number <= len(steps):
                _finish(run, steps[run.number - 1])
                warn_of_bottoming(run.model, result, run.number, run.evaluation.found)
                warn_of_shared_faces(run.model, result, run.evaluation.found)
                run.number, run.loop = run.number + 1, None
            if last:
                warn_of_contact(run.model, result)
                warn_of_untouched(run.model, result)
                warn_of_drift(run.model, result)
                warn_of_imbalance(result, run.newton.options.residual)
                warn_of_volume(run.model, result)
                tell_of_rest(run.model, result)
            _pause(run, start, checkpoints, stop, last=last)
        except BaseException as error:  # whatever ends the run, the error carries the results so far
            result.seconds = clock.perf_counter() - start
            if isinstance(error, NoConvergence):
                warn_of_bottoming(run.model, result, run.number, run.evaluation.found)
                warn_of_shared_faces(run.model, result, run.evaluation.found)
                warn_of_contact(run.model, result)
                warn_of_drift(run.model, result)
                warn_of_imbalance(result, run.newton.options.residual)
            ended_early(run, checkpoints, error)
            error.result = result  # type: ignore[attr-defined]
            raise


def loop_for(step: Step) -> Any:
    """The loop of a step."""
    return loop_of(step) if isinstance(step, Move) else _LOOPS[type(step)]


def _finish(run: Run, step: Step) -> None:
    """Execute a step to its end, from its beginning or a restored state."""
    if run.loop is None:
        if not isinstance(step, Move):
            run.trail = None  # only a move continues the trail of the previous step
        run.loop = loop_for(step).begin(run, step)
    while not run.loop.done:
        run.pause()
        run.loop.advance(run, step)


def _pause(run: Run, start: float, checkpoints: Checkpoints | None, stop: Interrupt, *, last: bool = False) -> None:
    """Between two increments: write a checkpoint if it is due, and stop on request."""
    run.result.seconds, ranks = clock.perf_counter() - start, run.model.system.ranks
    show(run)
    asked = ranks.any(stop.asked)
    if checkpoints is not None and (last or asked or ranks.any(checkpoints.due())):
        with run.result.timing.output:
            checkpoints.write(run)
    if asked:
        how = ""
        if checkpoints is not None and not checkpoints.problem:
            how = f"; umform.resume({str(checkpoints.path)!r}, ...) goes on"
        raise Stopped(f"stopped between two increments{how}")
