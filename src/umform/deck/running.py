"""Run a deck and write what comes out; what was reached is written whatever ends the run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from umform.deck.deck import Deck
from umform.deck.problem import Problem
from umform.processes.bending.staging import Staging, staging
from umform.results import Result

#: The deck as it was run, beside what came of it.
COPY = "as-run.toml"
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
    """

    result: Result
    files: list[Path]
    ended_by: BaseException | None


def folder_of(deck: Deck) -> Path:
    """Where the files of a deck go unless another folder is asked for."""
    folder = deck.contents.output.folder
    return Path(folder) if folder else Path("results") / Path(deck.source.name).stem


def run(
    deck: Deck,
    problem: Problem,
    out: str | Path | None = None,
    *,
    solver: str | None = None,
    progress: bool | None = None,
) -> Outcome:
    """Solve the problem of a deck and write its files, each of them whole or not at all.

    Parameters
    ----------
    deck : Deck
        The deck.
    problem : Problem
        What was built from it.
    out : str or Path, optional
        Folder; default that of the deck.
    solver : str, optional
        Another sparse solver than that of the deck.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.

    Returns
    -------
    Outcome
        Also if the run was ended by Ctrl-C, or did not converge: then with what was reached.

    Raises
    ------
    UmformError
        If the model cannot be solved as it stands, or the folder cannot be written.
    """
    solver = solver or problem.solver
    if solver != "petsc":
        return _run(deck, problem, folder_of(deck) if out is None else out, solver, progress)
    from umform.distributed.mpi_ranks import world
    from umform.distributed.together import together

    ranks = world()
    with together(ranks):
        if ranks.rank > 0:  # the first rank writes for all
            result, ended_by = _solved(problem, solver, False)
            return Outcome(result, [], ended_by)
        return _run(deck, problem, folder_of(deck) if out is None else out, solver, progress)


def _run(deck: Deck, problem: Problem, out: str | Path, solver: str, progress: bool | None) -> Outcome:
    with staging(out, _FILES) as stage:
        result, ended_by = _solved(problem, solver, progress)
        return Outcome(result, write(deck, problem, result, stage), ended_by)


def _solved(problem: Problem, solver: str, progress: bool | None) -> tuple[Result, BaseException | None]:
    """What was reached, and what ended it early."""
    try:
        return problem.solve(solver=solver, progress=progress), None
    except BaseException as error:
        reached: Result | None = getattr(error, "result", None)
        if reached is None or not reached.rows:
            raise
        return reached, error


def write(deck: Deck, problem: Problem, result: Result, stage: Staging) -> list[Path]:
    """Write the files that the deck asks for; numbers get their names before pictures are drawn."""
    wanted, waiting = deck.contents.output, stage.waiting
    (waiting / COPY).write_text("".join(_as_run(deck)), encoding="utf-8")
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
        result.report(waiting / "report.html")
    return [*files, *stage.commit(["report.html", "curve.png", "shape.png"])]


def _as_run(deck: Deck) -> Iterator[str]:
    for key, value in deck.source.changes.items():
        yield f"# run with --set {key}={value}\n"
    yield deck.source.text
