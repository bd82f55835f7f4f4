"""Run steps of all kinds in a row: `solve` begins, `resume` takes up a run that was stopped; both go the same way."""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from os import PathLike
from typing import TYPE_CHECKING, Any

from umform.errors import InvalidValue, NoConvergence
from umform.model import Model
from umform.progress import Tick, progress_bar
from umform.results.bottoming import warn_of_bottoming
from umform.results.cells import tell_of_cells
from umform.results.penetration import warn_of_contact
from umform.results.rest import tell_of_rest
from umform.run.checked import checked
from umform.run.interrupt import Interrupt, gentle_interrupt
from umform.run.loose import carry_loose_sheet, note_springs
from umform.run.result import Result
from umform.run.watching import show
from umform.solution.newton import Newton
from umform.solution.options import NewtonOptions
from umform.steps import Step
from umform.steps.arc_length.arc import Arc, Following
from umform.steps.close import Close, Closing
from umform.steps.free import Free, Freeing
from umform.steps.loop import Run
from umform.steps.move import Move
from umform.steps.moving import loop_of
from umform.steps.release import Release, Releasing
from umform.timing import new_timing

if TYPE_CHECKING:
    from umform.run.checkpoint import Checkpoints

_Work = Callable[[Model, Sequence[Step]], Result]
_LOOPS: dict[type, Any] = {Release: Releasing, Arc: Following, Free: Freeing, Close: Closing}


def solve(
    model: Model | None,
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
    model : Model or None
        The model; it is left at its last converged state, whatever happens. With the solver "petsc" all ranks but the
        first may give None, and no steps: they get their shares from there.
    steps : Step or sequence of Step
        What happens, in a row.
    solver : str
        Sparse solver, see :mod:`umform.solvers`; "petsc" runs on all ranks that mpiexec has started (docs/parallel.md).
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
        Texts and numbers that are kept in the checkpoint, see :func:`umform.run.checkpoint.read_checkpoint`: a deck.

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

    Examples
    --------
    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp = model.fix("x0")
    >>> tip = model.prescribe("x1_lower", "z", name="tip")
    >>> result = uf.solve(model, uf.Move(tip, to=-0.1, steps=2))
    >>> float(result["tip"][-1])
    -0.1
    """

    def work(model: Model, steps: Sequence[Step]) -> Result:
        timing = new_timing()
        with timing.run:
            result = Result(model, timing)
            run = _ready(result, solver, options, frames)
            checkpoints = _checkpoints(run, steps, checkpoint, every, note)
            tell_of_cells(model, result)
            result.add(run.evaluation, [], frame=frames > 0)
            _go_on(run, steps, progress, checkpoints)
            return result

    return _where(solver)(model, partial(_prepared, model, steps), work)


def resume(
    path: str | PathLike[str],
    model: Model | None,
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

    Examples
    --------
    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp = model.fix("x0")
    >>> tip = model.prescribe("x1_lower", "z", name="tip")
    >>> steps = uf.Move(tip, to=-0.1, steps=2)
    >>> result = uf.solve(model, steps, checkpoint="run.h5")  # doctest: +SKIP
    >>> result = uf.resume("run.h5", model, steps)  # doctest: +SKIP
    """
    from umform.run.checkpoint import take_up  # few runs need it

    def work(model: Model, steps: Sequence[Step]) -> Result:
        timing = new_timing()
        with timing.run:
            result = Result(model, timing)
            run = _ready(result, solver, options, frames)
            checkpoints = _checkpoints(run, steps, path, every)
            assert checkpoints is not None
            memory = take_up(run, checkpoints)
            if memory is not None:
                step = steps[run.number - 1]
                run.loop = _loop(step).recall(run, step, memory)
            _go_on(run, steps, progress, checkpoints)
            return result

    return _where(solver)(model, partial(_prepared, model, steps), work)


def _prepared(model: Model | None, steps: Sequence[Step] | Step) -> list[Step]:
    """The steps, if the model can go them; a loose sheet rests on springs then."""
    sequence = checked(model, steps)
    assert model is not None
    carry_loose_sheet(model, sequence)
    return sequence


def _where(solver: str) -> Callable[[Model | None, Callable[[], Sequence[Step]], _Work], Result]:
    """Where a run goes: through this process, or on all ranks that mpiexec has started."""
    if solver == "petsc":
        from umform.parallel.run import on_ranks  # MPI starts only where it is asked for

        return on_ranks
    return _here


def _here(model: Model | None, steps: Callable[[], Sequence[Step]], work: _Work) -> Result:
    if model is None:
        raise InvalidValue(
            "there is no model",
            where="solve() or resume()",
            cause="the first rank alone may have it only with the solver petsc",
            remedy="solver='petsc', or a model",
        )
    return work(model, steps())


def _ready(result: Result, solver: str, options: NewtonOptions | None, frames: int) -> Run:
    """Refuse a model that cannot be solved, and make the run that has not begun."""
    model, timing = result.model, result.timing
    model.timing = timing
    model.check()
    evaluation = model.evaluate(model.x, tangent=False)  # history and frames ask for forces only
    model.begin(evaluation)
    run = Run(model, Newton(model, options, solver, timing), result, evaluation, frames=frames)
    run.result.solver = run.newton.solver
    note_springs(model, result)
    return run


def begun(result: Result, solver: str, options: NewtonOptions | None, frames: int) -> Run:
    """A run at its first state, which the result has."""
    run = _ready(result, solver, options, frames)
    result.add(run.evaluation, [], frame=frames > 0)
    return run


def _checkpoints(
    run: Run,
    steps: Sequence[Step],
    path: str | PathLike[str] | None,
    every: float,
    note: Mapping[str, Any] | None = None,
) -> Checkpoints | None:
    if path is None:
        return None
    from umform.run.checkpoint import Checkpoints  # few runs need it
    from umform.run.fingerprint import fingerprint

    whole = run.model.described  # the first rank writes and compares
    marks = {} if whole is None else fingerprint(whole, steps, run.newton, run.frames)
    return Checkpoints(path, every, marks, note, run.model.ranks)


def _go_on(run: Run, steps: Sequence[Step], progress: bool | None, checkpoints: Checkpoints | None) -> None:
    """Go on to the end from wherever the run stands."""
    talks = run.model.ranks.rank == 0
    with progress_bar(progress if talks else False) as tick:
        taken(run, steps, tick, checkpoints, last=True)


def taken(
    run: Run, steps: Sequence[Step], tick: Tick, checkpoints: Checkpoints | None = None, *, last: bool = False
) -> None:
    """Take the steps from ``run.number`` on; behind the last step of a run comes what is said at its end."""
    result = run.result
    start = clock.perf_counter() - result.seconds
    with gentle_interrupt() as stop:
        run.tick, run.pause = tick, lambda: _pause(run, start, checkpoints, stop)
        try:
            while run.number <= len(steps):
                _finish(run, steps[run.number - 1])
                run.number, run.loop = run.number + 1, None
            if last:
                warn_of_contact(run.model, result)
                warn_of_bottoming(run.model, result)
                tell_of_rest(run.model, result)
            _pause(run, start, checkpoints, stop, last=last)
        except BaseException as error:  # whatever ends the run: what was reached is kept with the error
            result.seconds = clock.perf_counter() - start
            if isinstance(error, NoConvergence):
                warn_of_bottoming(run.model, result)
            error.result = result  # type: ignore[attr-defined]
            raise


def _loop(step: Step) -> Any:
    """The loop of a step."""
    return loop_of(step) if isinstance(step, Move) else _LOOPS[type(step)]


def _finish(run: Run, step: Step) -> None:
    """Take a step to its end, from its beginning or from where it stands."""
    if run.loop is None:
        if not isinstance(step, Move):
            run.trail = None  # only a move goes on from the step before
        run.loop = _loop(step).begin(run, step)
    while not run.loop.done:
        run.pause()
        run.loop.advance(run, step)


def _pause(run: Run, start: float, checkpoints: Checkpoints | None, stop: Interrupt, *, last: bool = False) -> None:
    """Between two increments: write a checkpoint if it is time to, and stop if somebody has asked to."""
    run.result.seconds, ranks = clock.perf_counter() - start, run.model.ranks
    show(run)
    asked = ranks.any(stop.asked)
    if checkpoints is not None and (last or asked or ranks.any(checkpoints.due())):
        with run.result.timing.output:
            checkpoints.write(run)
    if asked:
        how = ""
        if checkpoints is not None and not checkpoints.problem:
            how = f"; umform.resume({str(checkpoints.path)!r}, ...) goes on"
        raise KeyboardInterrupt(f"stopped between two increments{how}")
