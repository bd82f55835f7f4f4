"""What a run that ends early leaves in its folder: its history and its states."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from umform.errors import UmformError

if TYPE_CHECKING:
    from umform.analysis.run import Result

HISTORY = "history.csv"


@contextmanager
def what_was_reached(out: Path, states: str) -> Iterator[None]:
    """Write the history and the states of a run that ends early; a whole run removes the history of such a one.

    Parameters
    ----------
    out : Path
        Folder of the run.
    states : str
        File of the states.
    """
    try:
        yield
    except (UmformError, KeyboardInterrupt) as stop:
        reached: Result | None = getattr(stop, "result", None)
        if reached is not None and reached.frames:
            say_kept(stop, [reached.write(out / name) for name in (HISTORY, states)])
        raise
    (out / HISTORY).unlink(missing_ok=True)


def say_kept(stop: BaseException, files: Sequence[Path]) -> None:
    """Add the names of files to the message of an early end."""
    stop.add_note(f"  results so far are in {files[0].parent}: {', '.join(file.name for file in files)}")
