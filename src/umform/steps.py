"""Run steps of all kinds in a row: `solve` begins, `resume` takes up a run that was stopped; both go the same way."""

from __future__ import annotations

import time as clock
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from os import PathLike
from typing import Any

from umform.arc import Arc, Following
from umform.checkpoint import Checkpoints, read_checkpoint, take_up
from umform.contact.augmentation import refuse_on_an_arc, warn_of_penetration
from umform.errors import InvalidValue
from umform.fingerprint import fingerprint
from umform.increment import Run
from umform.interrupt import Interrupt, gentle_interrupt
from umform.model import Model
from umform.move import Move, Moving
from umform.newton import Newton, NewtonOptions
from umform.progress import Tick, progress_bar
from umform.release import Release, Releasing
from umform.results import Result
from umform.timing import Timing, new_timing

__all__ = ["Arc", "Move", "Release", "Step", "resume", "solve"]

Step = Move | Release | Arc
_LOOPS: dict[type, Any] = {Move: Moving, Release: Releasing, Arc: Following}


def solve(
    model: Model,
    steps: Sequence[Step] | Step,
    *,
    solver: str = "auto",
    options: NewtonOptions | None = None,
    frames: int = 60,
    progress: bool | None = None,
    checkpoint: str | PathLike[str] | None = None,
    every: float = 60.0,
    note: Mapping[str, Any] | None = None,
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
    checkpoint : str or PathLike, optional
        File that the whole state of the run is written to now and then, at Ctrl-C and at the end; :func:`resume` takes
        the run up from it.
    every : float
        Seconds between two checkpoints, at least; 0 writes one after each increment.
    note : mapping of str to object, optional
        Texts and numbers that are kept in the checkpoint, see :func:`umform.checkpoint.read_checkpoint`: a deck.

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
    FileProblem
        If no checkpoint can be written in its folder. One that fails later is a warning of the result.

    Notes
    -----
    Any exception that ends the run, Ctrl-C too, carries all that was reached as its attribute ``result``. The first
    Ctrl-C ends the run after the present increment, the second one at once.
    """
    timing = new_timing()
    with timing.run:
        run, sequence = _ready(model, steps, solver, options, frames, timing)
        checkpoints = None
        if checkpoint is not None:
            checkpoints = Checkpoints(checkpoint, every, fingerprint(model, sequence, run.newton, frames), note)
        run.history = model.block.state
        run.result.add(model.evaluate(model.u).residual, [], frame=frames > 0)
        return _go_on(run, sequence, progress_bar(progress), checkpoints)


def resume(
    path: str | PathLike[str],
    model: Model,
    steps: Sequence[Step] | Step,
    *,
    solver: str = "auto",
    options: NewtonOptions | None = None,
    frames: int = 60,
    progress: bool | None = None,
    every: float = 60.0,
) -> Result:
    """Take up a run from its checkpoint; what comes out is what the run would have given, to the last bit.

    Parameters
    ----------
    path : str or PathLike
        The checkpoint, which the run goes on to write.
    model, steps, solver, options, frames
        Those that :func:`solve` was called with, built again.
    progress, every
        See :func:`solve`; they may differ.

    Returns
    -------
    Result
        History, frames and iterations from the very beginning on.

    Raises
    ------
    FileProblem
        If the file cannot be read, or belongs to another run.
    NoConvergence
        If an increment fails at its smallest size.

    Notes
    -----
    The bits are the same on the same machine with the same versions of Python's packages, see docs/long-runs.md.
    """
    timing = new_timing()
    with timing.run:
        run, sequence = _ready(model, steps, solver, options, frames, timing)
        tree = read_checkpoint(path)
        checkpoints = Checkpoints(path, every, fingerprint(model, sequence, run.newton, frames), tree["note"])
        memory = take_up(run, path, tree, checkpoints.fingerprint)
        if memory is not None:
            step = sequence[run.number - 1]
            run.loop = _LOOPS[type(step)].recall(run, step, memory)
        return _go_on(run, sequence, progress_bar(progress), checkpoints)


def _ready(
    model: Model,
    steps: Sequence[Step] | Step,
    solver: str,
    options: NewtonOptions | None,
    frames: int,
    timing: Timing,
) -> tuple[Run, list[Step]]:
    """Refuse what cannot be run, and make the run that has not begun."""
    sequence = [steps] if isinstance(steps, Step) else list(steps)
    for number, step in enumerate(sequence, start=1):
        if isinstance(step, Arc):
            refuse_on_an_arc(model, f"step {number}")
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
    model.timing = timing
    model.check()
    run = Run(model, Newton(model, options, solver, timing), Result(model, timing), frames)
    run.result.solver = run.newton.solver
    return run, sequence


def _go_on(
    run: Run, steps: Sequence[Step], bar: AbstractContextManager[Tick], checkpoints: Checkpoints | None
) -> Result:
    """Go on to the end from wherever the run stands."""
    result = run.result
    start = clock.perf_counter() - result.seconds
    with bar as tick, gentle_interrupt() as stop:
        run.tick, run.pause = tick, lambda: _pause(run, start, checkpoints, stop)
        try:
            while run.number <= len(steps):
                _finish(run, steps[run.number - 1])
                run.number, run.loop = run.number + 1, None
            warn_of_penetration(run.model, result)
            _pause(run, start, checkpoints, stop, last=True)
        except BaseException as error:  # whatever ends the run: what was reached is kept with the error
            result.seconds = clock.perf_counter() - start
            error.result = result  # type: ignore[attr-defined]
            raise
    return result


def _finish(run: Run, step: Step) -> None:
    """Take a step to its end, from its beginning or from where it stands."""
    if run.loop is None:
        run.loop = _LOOPS[type(step)].begin(run, step)
    while not run.loop.done:
        run.pause()
        run.loop.advance(run, step)


def _pause(run: Run, start: float, checkpoints: Checkpoints | None, stop: Interrupt, *, last: bool = False) -> None:
    """Between two increments: write a checkpoint if it is time to, and stop if somebody has asked to."""
    run.result.seconds = clock.perf_counter() - start
    if checkpoints is not None and (last or stop.asked or checkpoints.due()):
        with run.result.timing.output:
            checkpoints.write(run)
    if stop.asked:
        how = ""
        if checkpoints is not None and not checkpoints.problem:
            how = f"; umform.resume({str(checkpoints.path)!r}, ...) goes on"
        raise KeyboardInterrupt(f"stopped between two increments{how}")
