"""Select the folder of a run; results of another run are not overwritten without permission."""

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
    """The folder of a run.

    Parameters
    ----------
    out : str, Path or None
        The folder given by the user.
    default : Path
        The folder used otherwise.
    names : sequence of str
        Files that will be written there.
    overwrite : bool
        Whether they may replace others.
    say : callable
        Called with a sentence if neither of the two is used.

    Raises
    ------
    FileProblem
        The given folder contains results that may not be overwritten.
    """
    if out is not None:
        return chosen_folder(out, names, overwrite=overwrite)
    folder, message = free_folder(default, names, overwrite=overwrite)
    if message:
        say(message)
    return folder


def chosen_folder(out: str | Path, names: Sequence[str], *, overwrite: bool) -> Path:
    """The folder given by the user.

    Parameters
    ----------
    out : str or Path
        The folder.
    names : sequence of str
        Files that will be written there.
    overwrite : bool
        Whether they may replace others.

    Raises
    ------
    InvalidValue
        Its name is empty.
    FileProblem
        It contains results that may not be overwritten.
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
    """The default folder of a run, and a message about it.

    Parameters
    ----------
    default : Path
        The folder; if it contains results or another run is writing to it, a numbered one is used.
    names : sequence of str
        Files that will be written there.
    overwrite : bool
        Whether they may replace others.

    Returns
    -------
    folder : Path
        The folder.
    message : str
        Why another folder is used; empty otherwise.
    """
    if overwrite:
        return default, ""
    message = ""
    for folder in numbered(default):
        there = _results(folder, names)
        if not there and not is_taken(folder):
            break
        if folder == default:
            message = f"holds {_listed(there)}" if there else "belongs to a run that has not ended"
    return folder, message and f"{default} {message}; this run writes to {folder}"


def numbered(folder: Path) -> Iterator[Path]:
    """A folder, and the same with numbers from 2 on behind its name."""
    yield folder
    for number in count(2):
        yield folder.with_name(f"{folder.name}-{number}")


def _results(folder: Path, names: Sequence[str]) -> list[Path]:
    """Files of a run in a folder."""
    try:
        return [folder / name for name in names if (folder / name).is_file()]
    except OSError:  # it cannot be read: whoever writes there reports it
        return []


def _going_on(files: Sequence[Path]) -> str:
    """How to continue a run that has left a checkpoint."""
    return "".join(f"; umform resume {file} goes on with that run" for file in files if file.suffix == ".h5")


def _listed(files: Sequence[Path]) -> str:
    """Names of files, and the time of the last change."""
    last = time.strftime("%Y-%m-%d %H:%M", time.localtime(max(file.stat().st_mtime for file in files)))
    return f"{', '.join(file.name for file in files)} of {last}"
