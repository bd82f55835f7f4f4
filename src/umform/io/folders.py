"""Which folder a run writes to: never over the results of another one unless that is asked for."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from itertools import count
from pathlib import Path

from umform.errors import FileProblem
from umform.io.staging import check_name, is_taken


def folder_for(
    out: str | Path | None, default: Path, names: Sequence[str], *, overwrite: bool, say: Callable[[str], object]
) -> Path:
    """The folder that a run writes to.

    Parameters
    ----------
    out : str, Path or None
        What somebody has named.
    default : Path
        What is taken if nobody has.
    names : sequence of str
        Files that will be written there.
    overwrite : bool
        Whether they may take the place of others.
    say : callable
        Is called with a sentence if it is neither of the two.

    Raises
    ------
    FileProblem
        The folder that was named holds results, and they may not be overwritten.
    """
    if out is not None:
        return chosen_folder(out, names, overwrite=overwrite)
    folder, message = free_folder(default, names, overwrite=overwrite)
    if message:
        say(message)
    return folder


def chosen_folder(out: str | Path, names: Sequence[str], *, overwrite: bool) -> Path:
    """The folder that somebody has named.

    Parameters
    ----------
    out : str or Path
        The folder.
    names : sequence of str
        Files that will be written there.
    overwrite : bool
        Whether they may take the place of others.

    Raises
    ------
    InvalidValue
        Its name is empty.
    FileProblem
        It holds results, and they may not be overwritten.
    """
    check_name(out)
    folder = Path(out)
    there = [] if overwrite else _results(folder, names)
    if there:
        raise FileProblem(
            "the folder holds the results of another run",
            where=str(folder),
            value=_listed(there),
            cause="they would be overwritten",
            remedy=f"choose another folder, or --overwrite{_going_on(there)}",
        )
    return folder


def free_folder(default: Path, names: Sequence[str], *, overwrite: bool) -> tuple[Path, str]:
    """The folder of a run for which nobody has named one, and what is to be said of it.

    Parameters
    ----------
    default : Path
        The folder; if it holds results or another run is writing to it, one with a number is taken.
    names : sequence of str
        Files that will be written there.
    overwrite : bool
        Whether they may take the place of others.

    Returns
    -------
    folder : Path
        The folder.
    message : str
        Why it is another one; empty if it is not.
    """
    if overwrite:
        return default, ""
    message = ""
    for folder in _numbered(default):
        there = _results(folder, names)
        if not there and not is_taken(folder):
            break
        if folder == default:
            message = f"holds {_listed(there)}" if there else "belongs to a run that has not ended"
    return folder, message and f"{default} {message}; this run writes to {folder}"


def _numbered(folder: Path) -> Iterator[Path]:
    yield folder
    for number in count(2):
        yield folder.with_name(f"{folder.name}-{number}")


def _results(folder: Path, names: Sequence[str]) -> list[Path]:
    """Files that a run has left in a folder."""
    try:
        return [folder / name for name in names if (folder / name).is_file()]
    except OSError:  # it must not be looked into: whoever writes there will say so
        return []


def _going_on(files: Sequence[Path]) -> str:
    """How a run goes on that has left a checkpoint."""
    return "".join(f"; umform resume {file} goes on with that run" for file in files if file.suffix == ".h5")


def _listed(files: Sequence[Path]) -> str:
    """Names of files, and when the last of them was written."""
    last = time.strftime("%Y-%m-%d %H:%M", time.localtime(max(file.stat().st_mtime for file in files)))
    return f"{', '.join(file.name for file in files)} of {last}"
