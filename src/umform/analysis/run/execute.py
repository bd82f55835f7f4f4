"""Run a sequence of steps: `solve` starts, `resume` continues a stopped run; both share the code."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run.checked import checked, needs_model
from umform.analysis.run.flush import touch_flush_sheet
from umform.analysis.run.loose import carry_loose_sheet
from umform.analysis.run.result import Result
from umform.analysis.run.run_steps import checkpoints_of, go_on, loop_for, ready
from umform.analysis.steps import Step
from umform.analysis.steps.run_state import Follower, Run
from umform.model import Model
from umform.progress import Show
from umform.results.cells import tell_of_cells
from umform.results.history import FRAMES
from umform.spec import check_arguments
from umform.timing import new_timing

#: Called with the result so far.
OnIncrement = Callable[[Result], object]
_Work = Callable[[Model, Sequence[Step]], Result]


def solve(
    model: Model | None,
    steps: Sequence[Step] | Step,
    *,
    solver: str = "auto",
    options: NewtonOptions | None = None,
    frames: int = FRAMES,
    progress: Show = None,
    checkpoint: str | PathLike[str] | None = None,
    every: float = 60.0,
    note: Mapping[str, Any] | None = None,
    on_increment: OnIncrement | None = None,
) -> Result:
    """Solve a model step by step.

    Parameters
    ----------
    model : Model or None
        The model; it is always left at its last converged state. With the solver "petsc" all ranks but the first may
        pass None, and no steps: they receive their parts from it.
    steps : Step or sequence of Step
        Sequence of steps.
    solver : str
        Sparse solver, see :mod:`umform.solvers`; "petsc" runs on all ranks started by mpiexec (docs/parallel.md).
    options : NewtonOptions, optional
        Tolerances, line search, predictor.
    frames : int
        Approximate number of states kept for pictures in each step (the history has all of them); 0 keeps none.
    progress : bool or callable, optional
        Show a progress bar; default: only on a terminal. A callable takes name, fraction and detail instead.
    checkpoint : str or PathLike, optional
        File for the complete state of the run, written at intervals, at Ctrl-C and at the end; :func:`resume` continues
        from it.
    every : float
        Least seconds between two checkpoints; 0 writes one after each increment.
    note : mapping of str to object, optional
        Texts and numbers to keep in the checkpoint, see :func:`umform.analysis.run.checkpoint.read_checkpoint`: a deck.
    on_increment : callable, optional
        Called with the :class:`Result` so far after each increment; its model is in the converged state. An exception
        in it ends the run. On ranks the first one calls it.

    Returns
    -------
    Result
        History, frames and iterations.

    Raises
    ------
    NoConvergence
        If an increment fails at its smallest size.
    RigidBodyMotion, ToolSwallowsSheet
        If the model cannot be solved.
    FileProblem
        If no checkpoint can be written in its folder. A later failure to write is a warning of the result.

    Notes
    -----
    Any exception that ends the run, including Ctrl-C, carries the results so far as its attribute ``result``. The first
    Ctrl-C ends the run after the present increment, the second one immediately.

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
    return solve_followed(
        model,
        steps,
        None,
        solver=solver,
        options=options,
        frames=frames,
        progress=progress,
        checkpoint=checkpoint,
        every=every,
        note=note,
        on_increment=on_increment,
    )


def solve_followed(
    model: Model | None,
    steps: Sequence[Step] | Step,
    follower: Callable[[Run], Follower] | None,
    *,
    solver: str = "auto",
    options: NewtonOptions | None = None,
    frames: int = FRAMES,
    progress: Show = None,
    checkpoint: str | PathLike[str] | None = None,
    every: float = 60.0,
    note: Mapping[str, Any] | None = None,
    on_increment: OnIncrement | None = None,
) -> Result:
    """Solve a model, with runs that follow it; parameters of :func:`solve`, and a function that makes these runs."""

    def work(model: Model, steps: Sequence[Step]) -> Result:
        timing = new_timing()
        with timing.run:
            result = Result(model, timing)
            run = ready(result, solver, options, frames, steps)
            run.follower = None if follower is None else follower(run)
            run.call(on_increment)
            if checkpoint is not None:
                from umform.analysis.run.checkpoint import other_file  # imported late: few runs need it

                ranks = model.system.ranks
                ranks.agree(other_file(Path(checkpoint)) if ranks.rank == 0 else None)
            checkpoints = checkpoints_of(run, steps, checkpoint, every, note)
            tell_of_cells(model, result)
            result.add(run.evaluation, [], frame=frames > 0)
            go_on(run, steps, progress, checkpoints)
            return result

    return _where(solver)(model, partial(prepared_steps, model, steps), work)


def resume(
    path: str | PathLike[str],
    model: Model | None,
    steps: Sequence[Step] | Step,
    *,
    solver: str = "auto",
    options: NewtonOptions | None = None,
    frames: int = FRAMES,
    progress: Show = None,
    every: float = 60.0,
    on_increment: OnIncrement | None = None,
) -> Result:
    """Continue a run from its checkpoint; the result equals that of an uninterrupted run, to the last bit.

    Parameters
    ----------
    path : str or PathLike
        The checkpoint, which the run continues to write.
    model, steps, solver, options, frames
        Those of the call of :func:`solve`, built again.
    progress, every, on_increment
        See :func:`solve`; they may differ.

    Returns
    -------
    Result
        History, frames and iterations from the beginning of the run.

    Raises
    ------
    FileProblem
        If the file cannot be read, or belongs to another run.
    NoConvergence
        If an increment fails at its smallest size.

    Notes
    -----
    The bits are the same on the same machine with the same versions of Python packages, see docs/long-runs.md.

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
    return resume_followed(
        path,
        model,
        steps,
        None,
        solver=solver,
        options=options,
        frames=frames,
        progress=progress,
        every=every,
        on_increment=on_increment,
    )


def resume_followed(
    path: str | PathLike[str],
    model: Model | None,
    steps: Sequence[Step] | Step,
    follower: Callable[[Run], Follower] | None,
    *,
    solver: str = "auto",
    options: NewtonOptions | None = None,
    frames: int = 60,
    progress: Show = None,
    every: float = 60.0,
    on_increment: OnIncrement | None = None,
) -> Result:
    """Continue a run and those that follow it; parameters of :func:`resume`, and a function that makes these."""
    from umform.analysis.run.checkpoint import take_up  # imported late: few runs need it

    check_arguments(resume, path=path)

    def work(model: Model, steps: Sequence[Step]) -> Result:
        timing = new_timing()
        with timing.run:
            result = Result(model, timing)
            run = ready(result, solver, options, frames, steps)
            run.follower = None if follower is None else follower(run)
            run.call(on_increment)
            checkpoints = checkpoints_of(run, steps, path, every)
            assert checkpoints is not None
            memory = take_up(run, checkpoints)
            if memory is not None:
                step = steps[run.number - 1]
                run.loop = loop_for(step).recall(run, step, memory)
            go_on(run, steps, progress, checkpoints)
            return result

    return _where(solver)(model, partial(prepared_steps, model, steps), work)


def prepared_steps(model: Model | None, steps: Sequence[Step] | Step) -> list[Step]:
    """The steps, if they are valid for the model; pressed tools touch the sheet, weak springs support a loose one."""
    sequence = checked(model, steps)
    assert model is not None
    touch_flush_sheet(model)
    carry_loose_sheet(model, sequence)
    return sequence


def _where(solver: str) -> Callable[[Model | None, Callable[[], Sequence[Step]], _Work], Result]:
    """Run in this process, or on all ranks started by mpiexec."""
    if solver == "petsc":
        from umform.analysis.ranks.run import on_ranks  # MPI starts only on demand

        return on_ranks
    return _here


def _here(model: Model | None, steps: Callable[[], Sequence[Step]], work: _Work) -> Result:
    needs_model(model)
    assert model is not None
    return work(model, steps())
