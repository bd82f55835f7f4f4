"""Write the files of a run of a deck, and keep the run if writing fails."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

from umform.analysis.run import Result
from umform.errors import UmformError
from umform.io.atomic import write_problem
from umform.io.staging import Staging
from umform.problem.deck_in_checkpoint import Kept
from umform.problem.deck_text import toml
from umform.problem.forming import Forming
from umform.problem.measured import TABLE, Taken, data_files, picture_files
from umform.problem.prepared import Prepared
from umform.problem.previous_operation import write_state
from umform.problem.problem import Problem
from umform.results.outcome import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: The deck of the run, beside its results.
COPY = "as-run.toml"
#: Default file of the checkpoint; removed when the run has ended normally.
CHECKPOINT = "checkpoint.h5"
#: Final state, with which the deck of the next operation begins.
STATE = "state.h5"
_DATA = ("history.csv", "fields.vtkhdf", "fields.csv", STATE, TABLE, QUANTITIES)
_PAGE = ("report.html", "curve.png", "shape.png", "limits.png")
FILES = (*_DATA, *_PAGE, COPY)
#: Files that mark a folder as that of a run.
RESULTS = (*FILES, CHECKPOINT)


@dataclass(frozen=True)
class Written:
    """The files of a run, and its measures."""

    files: list[Path]
    taken: Taken


def write(
    deck: Problem, problem: Prepared, result: Result, stage: Staging, *, whole: bool, taken: Taken | None = None
) -> Written:
    """Write the files that the deck asks for; data files are complete before pictures are drawn.

    With ``whole`` False the run ended early: its state is not written, since no operation may begin with it. ``taken``
    are its measures, if they are known.
    """
    wanted, waiting, text = deck.contents.output, stage.waiting, as_run(deck)
    if taken is None:
        taken = Taken.of(deck, problem, result, complete=whole)
    (waiting / COPY).write_text(text, encoding="utf-8")
    forming = Forming.of(deck, result, taken.ends)
    if forming is not None:
        forming.warn(result)
    if forming is not None and wanted.csv:
        forming.write(waiting / "fields.csv", result)
    if wanted.csv:
        result.write(waiting / "history.csv")
        taken.write(waiting)
    if wanted.vtkhdf:
        result.write(waiting / "fields.vtkhdf")
    if wanted.state and whole:
        note = Kept(deck, stage.folder).note(stage.folder / STATE)
        write_state(problem.model, waiting / STATE, deck.source.data, note)
    files = stage.commit([COPY, *_DATA, *data_files(waiting, stage.folder)])
    drawn: dict[str, Figure] = {}
    if wanted.pictures:
        from umform.plotting import save
        from umform.problem.pictures import curve, shape  # matplotlib loads slowly

        drawn = {"curve": curve(problem, result), "shape": shape(result)}
        for name, figure in drawn.items():
            save(figure, waiting / f"{name}.png")
        if forming is not None:
            save(forming.diagram, waiting / "limits.png", dpi=120)
        taken.draw(waiting)
    if wanted.report:
        from umform.report.looks import Units
        from umform.report.page import write_report

        metal = getattr(deck.contents.material, "note", "")
        more = chain(taken.parts(), () if forming is None else forming.parts())
        page = waiting / "report.html"
        names = deck.contents.units
        write_report(
            result,
            page,
            deck=text,
            title=deck.contents.title,
            note=metal,
            more=more,
            drawn=drawn,
            numbers=taken.leading,
            units=Units(names.length, names.force),
        )
    return Written([*files, *stage.commit([*_PAGE, *picture_files(waiting, stage.folder)])], taken)


def as_run(deck: Problem) -> str:
    """Text of a deck, after comment lines with the changed keys."""
    changes = (f"# run with --set {key}={toml(value)}\n" for key, value in deck.source.changes.items())
    return "".join([*changes, deck.source.written])


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
