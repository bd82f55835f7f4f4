"""What an operation that ends early leaves in its folder: its history and its states, and those of bends before it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from umform.analysis.run import Result

HISTORY = "history.csv"
#: Histories of the finished bends of a part.
_OF_BENDS = re.compile(r"bend\d+\.csv")


@contextmanager
def what_was_reached(out: Path, states: str, otherwise: Result | None = None) -> Iterator[None]:
    """Write the histories and the states of a run that ends early; a whole run removes the histories of such a one.

    Parameters
    ----------
    out : Path
        Folder of the run.
    states : str
        File of the states, if the run keeps any.
    otherwise : Result, optional
        The result for errors that have none.
    """
    try:
        yield
    except (Exception, KeyboardInterrupt) as stop:
        reached: Result | None = getattr(stop, "result", otherwise)
        bends = {f"bend{number}.csv": done.result for number, done in enumerate(getattr(stop, "bends", ()), start=1)}
        if reached is not None and len(reached) > 1:
            bends |= {HISTORY: reached} | ({states: reached} if reached.frames else {})
        if bends:
            say_kept(stop, [result.write(out / name) for name, result in bends.items()])
        raise
    for path in out.iterdir():
        if path.name == HISTORY or _OF_BENDS.fullmatch(path.name):
            path.unlink()


@contextmanager
def on_mesh(number: int, count: int) -> Iterator[None]:
    """Say in the message of an early end which of several meshes, the coarsest first, was run."""
    try:
        yield
    except (Exception, KeyboardInterrupt) as stop:
        stop.add_note(f"  on mesh {number} of {count}, the coarsest first")
        raise


def say_kept(stop: BaseException, files: Sequence[Path]) -> None:
    """Add the names of files to the message of an early end."""
    stop.add_note(f"  results so far are in {files[0].parent}: {', '.join(file.name for file in files)}")
