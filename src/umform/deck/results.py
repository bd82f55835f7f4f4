"""Write the files of a run of a deck, and keep the run if writing fails."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from umform.deck.before import write_state
from umform.deck.deck import Deck
from umform.deck.problem import Problem
from umform.errors import UmformError
from umform.io.atomic import write_problem
from umform.io.staging import Staging
from umform.processes.decks import toml
from umform.run import Result

#: The deck of the run, beside its results.
COPY = "as-run.toml"
#: Default file of the checkpoint; removed when the run has ended normally.
CHECKPOINT = "checkpoint.h5"
#: Final state, with which the deck of the next operation begins.
STATE = "state.h5"
FILES = ("history.csv", "fields.vtkhdf", "report.html", "curve.png", "shape.png", STATE, COPY)
#: Files that mark a folder as that of a run.
RESULTS = (*FILES, CHECKPOINT)


def write(deck: Deck, problem: Problem, result: Result, stage: Staging, *, whole: bool) -> list[Path]:
    """Write the files that the deck asks for; data files are complete before pictures are drawn.

    With ``whole`` False the run ended early: its state is not written, since no operation may begin with it.
    """
    wanted, waiting, text = deck.contents.output, stage.waiting, as_run(deck)
    (waiting / COPY).write_text(text, encoding="utf-8")
    if wanted.forming or wanted.forming_limit is not None:
        _add_forming(result, wanted.forming_limit)
    if wanted.csv:
        result.write(waiting / "history.csv")
    if wanted.vtkhdf:
        result.write(waiting / "fields.vtkhdf")
    if wanted.state and whole:
        write_state(problem.model, waiting / STATE, deck.source.data)
    files = stage.commit([COPY, "history.csv", "fields.vtkhdf", STATE])
    if wanted.pictures:
        from umform.deck.pictures import draw_curve, draw_shape  # matplotlib loads slowly

        draw_curve(problem, result, waiting / "curve.png")
        draw_shape(result, waiting / "shape.png")
    if wanted.report:
        from umform.report.page import write_report

        metal = getattr(deck.contents.material, "note", "")
        write_report(result, waiting / "report.html", deck=text, title=deck.contents.title, note=metal)
    return [*files, *stage.commit(["report.html", "curve.png", "shape.png"])]


def _add_forming(result: Result, points: list[tuple[float, float]] | None) -> None:
    """Add the fields of forming to the frames; warn of elements beyond the limit."""
    from umform.results.forming import LimitTable, add_forming_fields, forming_fields
    from umform.results.forming.strains import beyond_limit

    limit = None if points is None else LimitTable(*zip(*points, strict=True))
    add_forming_fields(result, limit)
    if limit is not None:
        mesh = result.model.mesh
        text = beyond_limit(mesh, forming_fields(mesh, result.model.u, limit))
        if text is not None:
            result.warn(f"the sheet tears: {text}")


def as_run(deck: Deck) -> str:
    """Text of a deck, after comment lines with the changed keys."""
    changes = (f"# run with --set {key}={toml(value)}\n" for key, value in deck.source.changes.items())
    return "".join([*changes, deck.source.text])


@contextmanager
def says_what_is_kept(stage: Staging, checkpoint: Path, before: float) -> Iterator[None]:
    """Add to an error of writing the available files, and how to continue the run."""
    try:
        try:
            yield
        except UmformError:
            raise
        except OSError as error:
            raise write_problem(stage.folder / (Path(error.filename or "").name or COPY), error) from error
    except BaseException as error:
        if stage.named:
            error.add_note(f"  kept:   {', '.join(file.name for file in stage.named)} in {stage.folder}")
        if checkpoint.is_file() and written_at(checkpoint) != before:
            error.add_note(f"  go on with: umform resume {shlex.quote(str(checkpoint))}")
        elif not stage.named:
            error.add_note("  nothing of this run could be kept")
        raise


def written_at(file: Path) -> float:
    """Time of the last change of a file; 0 if there is none."""
    try:
        return file.stat().st_mtime
    except OSError:
        return 0.0
