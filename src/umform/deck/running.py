"""Run a deck, or take its run up, and write what comes out; what was reached is written whatever ends the run."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from umform.deck.check import before_run
from umform.deck.deck import Deck
from umform.deck.findings import accept
from umform.deck.kept import Kept
from umform.deck.problem import Problem, Solving
from umform.processes.bending.staging import Staging, staging
from umform.run import Result

log = logging.getLogger("umform")

#: The deck as it was run, beside what came of it.
COPY = "as-run.toml"
#: Where the state of a run is kept unless another file is asked for; taken away when the run has ended by itself.
CHECKPOINT = "checkpoint.h5"
_FILES = ("history.csv", "fields.vtkhdf", "report.html", "curve.png", "shape.png", COPY)


@dataclass(frozen=True)
class Outcome:
    """What came of a run.

    Attributes
    ----------
    result : Result
        All that was reached.
    files : list of Path
        What was written.
    ended_by : BaseException or None
        What ended the run early.
    checkpoint : Path or None
        File that the run can be taken up from; None if there is none.
    """

    result: Result
    files: list[Path]
    ended_by: BaseException | None
    checkpoint: Path | None = None


def folder_of(deck: Deck) -> Path:
    """Where the files of a deck go unless another folder is asked for."""
    folder = deck.contents.output.folder
    return Path(folder) if folder else Path("results") / Path(deck.source.name).stem


def prepared(deck: Deck, solver: str, check: Callable[[Problem], None] = lambda problem: None) -> Solving:
    """Build what a deck describes; on many ranks the first one does so, and the others get their shares from it.

    Parameters
    ----------
    deck : Deck
        The deck.
    solver : str
        The sparse solver that will be used.
    check : callable
        May refuse what was built, :func:`refuse_implausible` for one; called in one process only.

    Returns
    -------
    Solving
        On the first rank, or in one process, the :class:`Problem`.

    Raises
    ------
    UmformError
        On all ranks, with all that does not fit.
    """

    def built() -> Problem:
        problem = deck.build(solver)
        check(problem)
        return problem

    if solver != "petsc":
        return built()
    from umform.parallel.mpi_ranks import world

    problem = world().on_first(built)
    if problem is not None:
        return problem
    return Solving(options=deck.contents.solution.build(), solver=solver, frames=deck.contents.output.frames)


def refuse_implausible(deck: Deck, problem: Problem, *, force: bool = False) -> None:
    """Refuse numbers that cannot be meant, and log warnings of what is unusual, before time is spent on a run.

    Parameters
    ----------
    deck : Deck
        The deck.
    problem : Problem
        What was built from it; its model is left as it was.
    force : bool
        Warn only.

    Raises
    ------
    DeckError
        With all that a check calls an error.
    """
    for message in accept(before_run(deck, problem), force=force):
        log.warning(message)


def run(
    deck: Deck,
    problem: Solving,
    out: str | Path | None = None,
    *,
    solver: str | None = None,
    progress: bool | None = None,
    checkpoint: str | Path | None = None,
    every: float = 60.0,
) -> Outcome:
    """Solve the problem of a deck and write its files, each of them whole or not at all.

    Parameters
    ----------
    deck : Deck
        The deck.
    problem : Solving
        What was :func:`prepared` from it.
    out : str or Path, optional
        Folder; default that of the deck.
    solver : str, optional
        Another sparse solver than that of the deck.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.
    checkpoint : str or Path, optional
        File that the state of the run is kept in, with the deck; default checkpoint.h5 in the folder, which is taken
        away when the run has ended by itself.
    every : float
        Seconds between two checkpoints, at least; 0 writes one after each increment.

    Returns
    -------
    Outcome
        Also if the run was ended by Ctrl-C, or did not converge: then with what was reached.

    Raises
    ------
    UmformError
        If the model cannot be solved as it stands, or the folder cannot be written.
    """
    place = out if out is not None else folder_of(deck)
    kept = Kept(deck, Path(place), solver)
    path = Path(checkpoint) if checkpoint is not None else kept.out / CHECKPOINT
    if path.is_file():
        log.warning("a run was stopped here, and %s will be written over; umform resume would go on with it", path)

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
) -> Outcome:
    """Take up the run of a deck from its checkpoint, and write its files as if it had never been stopped.

    Parameters
    ----------
    checkpoint : str or Path
        The file, which the run goes on to write.
    kept : Kept
        What it keeps of the deck.
    out : str or Path, optional
        Folder; default that of the run.
    progress, every
        See :func:`run`.

    Returns
    -------
    Outcome
        See :func:`run`.

    Raises
    ------
    FileProblem
        If the file cannot be read, has no deck, or does not fit what the deck builds now.
    UmformError
        If nothing can be built from the deck any more, a mesh file that is gone for one.
    """
    path = Path(checkpoint)
    problem = prepared(kept.deck, kept.chosen_solver)

    def solve() -> Result:
        return problem.resume(path, solver=kept.solver, progress=progress, every=every)

    place = out if out is not None else kept.out
    return _finish(kept, problem, place, path, solve, kept.solver or problem.solver)


def _finish(
    kept: Kept, problem: Solving, out: str | Path, checkpoint: Path, solve: Callable[[], Result], solver: str
) -> Outcome:
    """Solve, and write what came of it; on many ranks the first one writes for all."""
    if solver != "petsc":
        return _written(kept, problem, out, checkpoint, solve)
    from umform.parallel.mpi_ranks import world
    from umform.parallel.together import together

    ranks = world()
    with together(ranks):
        if ranks.rank == 0:
            return _written(kept, problem, out, checkpoint, solve)
        result, ended_by = _solved(solve)
        return Outcome(result, [], ended_by)


def _written(kept: Kept, problem: Solving, out: str | Path, checkpoint: Path, solve: Callable[[], Result]) -> Outcome:
    """Solve, write what came of it, and take the checkpoint away if nobody has asked for it or needs it."""
    assert isinstance(problem, Problem)  # one process, or the first of many
    with staging(out, _FILES) as stage:
        result, ended_by = _solved(solve)
        with result.timing.files:
            files = write(kept.deck, problem, result, stage)
        stopped = isinstance(ended_by, KeyboardInterrupt)
        if not stopped and checkpoint.resolve() == (kept.out / CHECKPOINT).resolve():
            checkpoint.unlink(missing_ok=True)
    return Outcome(result, files, ended_by, checkpoint if stopped and checkpoint.exists() else None)


def _solved(solve: Callable[[], Result]) -> tuple[Result, BaseException | None]:
    """What was reached, and what ended it early."""
    try:
        return solve(), None
    except BaseException as error:
        reached: Result | None = getattr(error, "result", None)
        if reached is None or not reached.rows:
            raise
        return reached, error


def write(deck: Deck, problem: Problem, result: Result, stage: Staging) -> list[Path]:
    """Write the files that the deck asks for; numbers get their names before pictures are drawn."""
    wanted, waiting, text = deck.contents.output, stage.waiting, as_run(deck)
    (waiting / COPY).write_text(text, encoding="utf-8")
    if wanted.csv:
        result.write(waiting / "history.csv")
    if wanted.vtkhdf:
        result.write(waiting / "fields.vtkhdf")
    files = stage.commit([COPY, "history.csv", "fields.vtkhdf"])
    if wanted.pictures:
        from umform.deck.pictures import draw_curve, draw_shape  # matplotlib takes time to load

        draw_curve(problem, result, waiting / "curve.png")
        draw_shape(result, waiting / "shape.png")
    if wanted.report:
        from umform.report.page import write_report

        write_report(result, waiting / "report.html", deck=text, title=deck.contents.title)
    return [*files, *stage.commit(["report.html", "curve.png", "shape.png"])]


def as_run(deck: Deck) -> str:
    """Text of a deck, after lines that say which keys had other values."""
    changes = (f"# run with --set {key}={value}\n" for key, value in deck.source.changes.items())
    return "".join([*changes, deck.source.text])
