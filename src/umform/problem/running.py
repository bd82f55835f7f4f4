"""Run a deck, or resume its run, and write the results, also after an early end."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TypeVar

import numpy as np

from umform.analysis.run import Result
from umform.analysis.run.checkpoint import other_file
from umform.errors import UmformError
from umform.io.atomic import remove_left_behind
from umform.io.folders import chosen_folder, folder_for
from umform.io.staging import staging
from umform.problem.check import before_run
from umform.problem.deck_in_checkpoint import Kept
from umform.problem.findings import accept
from umform.problem.measured import Taken
from umform.problem.prepared import Prepared, Solving
from umform.problem.problem import Problem
from umform.problem.resolution import coarse
from umform.problem.results import CHECKPOINT, FILES, RESULTS, says_what_is_kept, write, written_at
from umform.results.outcome import Outcome
from umform.results.quantity import Quantity

_Answer = TypeVar("_Answer")
log = logging.getLogger("umform")

_LAST = "the numbers are those of its last converged state"


@dataclass(frozen=True, repr=False)
class ProblemOutcome(Outcome):
    """Outcome of a run.

    Attributes
    ----------
    result : Result
        The results so far.
    files : list of Path
        The files.
    ended_by : BaseException or None
        Cause of an early end; None otherwise.
    checkpoint : Path or None
        File to resume the run from; None if there is none.
    taken : Taken
        The measures that the deck asks for.
    """

    result: Result
    files: list[Path]
    ended_by: BaseException | None
    checkpoint: Path | None = None
    taken: Taken = field(default_factory=Taken)

    @property
    def title(self) -> str:
        """Heading of tables."""
        return "Measures"

    @property
    def quantities(self) -> list[Quantity]:
        """The numbers of the measures."""
        return self.taken.quantities

    @property
    def tables(self) -> dict[str, list[list[str]]]:
        """The measures, a column for each state of the part; with an error budget a column for each change."""
        return {"Measures": self.taken.table} if self.taken.quantities else {}

    @property
    def stages(self) -> dict[str, Result]:
        """The run."""
        return {"run": self.result}

    @property
    def warnings(self) -> list[str]:
        """Warnings of the run."""
        return self.result.warnings

    @property
    def length(self) -> str:
        """Unit of lengths."""
        return self.taken.length


def folder_of(deck: Problem) -> Path:
    """Default folder of the files of a deck."""
    folder = deck.contents.output.folder
    return Path(folder) if folder else Path("results") / Path(deck.source.name).stem


def prepared(deck: Problem, solver: str, check: Callable[[Prepared], None] = lambda problem: None) -> Solving:
    """Build a deck; with several ranks the first one does so, and the others receive their shares.

    Parameters
    ----------
    deck : Problem
        The deck.
    solver : str
        The sparse solver.
    check : callable
        May refuse the problem, for instance :func:`refuse_implausible`; called in one process only.

    Returns
    -------
    Solving
        On the first rank, or in one process, the :class:`Prepared`.

    Raises
    ------
    UmformError
        On all ranks, with all mistakes.
    """

    def built() -> Prepared:
        problem = deck.build(solver)
        check(problem)
        return problem

    problem = _on_first(solver, built)
    if problem is not None:
        return problem
    return Solving(options=deck.contents.solution.build(), solver=solver, frames=deck.contents.output.frames)


def _on_first(solver: str, work: Callable[[], _Answer]) -> _Answer | None:
    """Call a function in this process, or on the first of several ranks; None on the others."""
    if solver != "petsc":
        return work()
    from umform.parallel.mpi_ranks import world

    return world().on_first(work)


def refuse_folder(solver: str, out: str | Path | None, *, overwrite: bool = False) -> None:
    """Refuse a given folder with results of another run, before the problem is built and its warnings are logged.

    Raises
    ------
    InvalidValue, FileProblem
        See :func:`umform.io.folders.chosen_folder`.
    """
    if out is not None:
        _on_first(solver, partial(chosen_folder, out, RESULTS, overwrite=overwrite))


def refuse_implausible(deck: Problem, problem: Prepared, *, force: bool | None = None) -> None:
    """Refuse numbers that are certainly wrong, and log warnings of unusual ones, before the run.

    Parameters
    ----------
    deck : Problem
        The deck.
    problem : Prepared
        The problem of the deck; its model is unchanged.
    force : bool, optional
        Warn only; None where no option --force does it.

    Raises
    ------
    DeckError
        With all errors of the check.
    """
    for message in accept(before_run(deck, problem), force=force):
        log.warning(message)


def run(
    deck: Problem,
    problem: Solving,
    out: str | Path | None = None,
    *,
    solver: str | None = None,
    progress: bool | None = None,
    checkpoint: str | Path | None = None,
    every: float = 60.0,
    overwrite: bool = False,
    budget: bool = False,
) -> ProblemOutcome:
    """Solve the problem of a deck and write its files, each of them atomically.

    Parameters
    ----------
    deck : Problem
        The deck.
    problem : Solving
        Result of :func:`prepared`.
    out : str or Path, optional
        Folder; default that of the deck, with a number if it contains the results of another run.
    solver : str, optional
        Another sparse solver than that of the deck.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.
    checkpoint : str or Path, optional
        File for the state of the run, with the deck; default checkpoint.h5 in the folder, which is removed when the run
        has ended normally.
    every : float
        Least seconds between two checkpoints; 0 writes one after each increment.
    overwrite : bool
        Whether results of another run, and its checkpoint, may be overwritten.
    budget : bool
        Whether coarser variants are run, too, for the errors of all numbers: see
        :func:`umform.problem.error_budget.error_budget`. In one process only.

    Returns
    -------
    ProblemOutcome
        Also after Ctrl-C or without convergence, then with the results so far.

    Raises
    ------
    UmformError
        If the model cannot be solved, or the folder cannot be written, or contains other results.
    """
    default = folder_of(deck)
    choose = partial(folder_for, out, default, RESULTS, overwrite=overwrite, say=log.warning)
    place = _on_first(solver or problem.solver, choose) or default
    kept = Kept(deck, place, solver, budget)
    path = Path(checkpoint) if checkpoint is not None else kept.out / CHECKPOINT
    if path.is_file():
        if (problem_of_file := other_file(path)) is not None:
            raise problem_of_file
        log.warning("a run was stopped here, and %s will be overwritten; umform resume would continue it", path)

    def solve() -> Result:
        note = kept.note(path)
        return problem.solve(solver=solver, progress=progress, checkpoint=path, every=every, note=note)

    return _finish(kept, problem, place, path, solve, solver or problem.solver)


def resume(
    checkpoint: str | Path,
    kept: Kept,
    out: str | Path | None = None,
    *,
    progress: bool | None = None,
    every: float = 60.0,
    overwrite: bool = False,
) -> ProblemOutcome:
    """Resume the run of a deck from its checkpoint, and write its files as after an uninterrupted run.

    Parameters
    ----------
    checkpoint : str or Path
        The file, which the run continues to write.
    kept : Kept
        Its note.
    out : str or Path, optional
        Folder; default that of the run.
    progress, every, overwrite
        See :func:`run`; the folder of the run itself is always written to.

    Returns
    -------
    ProblemOutcome
        See :func:`run`.

    Raises
    ------
    FileProblem
        If the file cannot be read, has no deck, or does not belong to the problem that the deck builds now.
    UmformError
        If the deck can no longer be built, for instance because a mesh file is missing.
    """
    path = Path(checkpoint)
    problem = prepared(kept.deck, kept.chosen_solver)

    def solve() -> Result:
        return problem.resume(path, solver=kept.solver, progress=progress, every=every)

    place = kept.out if out is None else Path(out)
    if place.resolve() != kept.out.resolve():
        _on_first(kept.chosen_solver, lambda: chosen_folder(place, RESULTS, overwrite=overwrite))
    return _finish(kept, problem, place, path, solve, kept.solver or problem.solver)


def _finish(
    kept: Kept,
    problem: Solving,
    out: Path,
    checkpoint: Path,
    solve: Callable[[], Result],
    solver: str,
) -> ProblemOutcome:
    """Solve and write the results; with several ranks the first one writes for all."""
    if solver != "petsc":
        return _written(kept, problem, out, checkpoint, solve)
    from umform.parallel.mpi_ranks import world
    from umform.parallel.together import together

    ranks = world()
    with together(ranks):
        if ranks.rank == 0:
            return _written(kept, problem, out, checkpoint, solve)
        result, ended_by = _solved(solve)
        return ProblemOutcome(result, [], ended_by)


def _written(kept: Kept, problem: Solving, out: Path, checkpoint: Path, solve: Callable[[], Result]) -> ProblemOutcome:
    """Solve, write the results, and remove the checkpoint unless the user asked for it or it is needed."""
    assert isinstance(problem, Prepared)  # one process, or the first of several
    before = written_at(checkpoint)
    with np.errstate(all="ignore"):  # points of the sheet on the axis of a tool
        cautions = coarse(kept.deck, problem)
    with staging(out, FILES) as stage:
        remove_left_behind(checkpoint)
        result, ended_by = _solved(solve)
        taken, stop = _taken(kept.deck, problem, result) if kept.budget and ended_by is None else (None, None)
        with result.timing.files, says_what_is_kept(stage, checkpoint, before):
            if stage.make_again():
                result.warn(f"the folder {out} was removed during the run; it was made again")
            for caution in cautions:
                result.warn(caution)
            early = [] if ended_by is None else [f"the run ended early, {_why(ended_by)}: {_LAST}"]
            result.warnings += early  # in the files alone: on the screen the error itself follows
            written = write(kept.deck, problem, result, stage, whole=ended_by is None, taken=taken)
            result.warnings[:] = [warning for warning in result.warnings if warning not in early]
        over = ended_by is None or isinstance(ended_by, UmformError)
        if over and checkpoint.resolve() == (kept.out / CHECKPOINT).resolve():
            checkpoint.unlink(missing_ok=True)
    left = None if over or not checkpoint.exists() else checkpoint
    return ProblemOutcome(result, written.files, ended_by or stop, left, written.taken)


def _why(error: BaseException) -> str:
    """The cause of an early end, for the pages of what was reached."""
    return "interrupted" if isinstance(error, KeyboardInterrupt) else str(getattr(error, "what", "") or repr(error))


def _taken(deck: Problem, problem: Prepared, result: Result) -> tuple[Taken, KeyboardInterrupt | None]:
    """The measures with the bands of an error budget; without them if Ctrl-C stops it."""
    from umform.problem.error_budget import error_budget

    taken = Taken.of(deck, problem, result, complete=True)
    try:
        return error_budget(deck, problem, result, taken), None
    except KeyboardInterrupt as stop:
        result.warn("the error budget was interrupted: the numbers have no errors")
        return taken, stop


def _solved(solve: Callable[[], Result]) -> tuple[Result, BaseException | None]:
    """The results so far, and the cause of an early end."""
    try:
        return solve(), None
    except BaseException as error:
        reached: Result | None = getattr(error, "result", None)
        if reached is None or not reached.rows:
            raise
        return reached, error
