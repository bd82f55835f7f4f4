"""Whose a temporary file or folder is: of a process that runs, or of one that was killed."""

from __future__ import annotations

import os
import platform
import time
from pathlib import Path

#: Seconds that a process may take to write down that something is its own.
_YOUNG = 10.0


def mark() -> str:
    """Machine and number of this process, in a form that a name of a file may hold."""
    return f"{_machine()}-{os.getpid()}"


def pid_of(mark: str) -> int | None:
    """Number of a process from its mark; None if there is none in it."""
    number = mark.rpartition("-")[2]
    return int(number) if number.isdecimal() else None


def is_left_behind(path: Path, mark: str) -> bool:
    """Whether the process with this mark, which has made the file or folder, is gone.

    Parameters
    ----------
    path : Path
        The file or folder, for its age: it decides where there is no mark.
    mark : str
        What :func:`mark` gave in that process; empty if it has not written it down.

    Returns
    -------
    bool
        False also for a process of another machine, of which nothing can be known.
    """
    pid = pid_of(mark)
    try:
        age = time.time() - path.stat().st_mtime
    except OSError:  # gone meanwhile
        return False
    if pid is None:
        return age > _YOUNG
    if mark.rpartition("-")[0] != _machine() or os.name != "posix":
        return False
    return not _runs(pid)


def _runs(pid: int) -> bool:
    """Whether a process of this machine runs."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):  # it is somebody else's
        return True
    return not _has_ended(pid)


def _has_ended(pid: int) -> bool:
    """Whether only the number of a process is left, as its parent has not waited for it: often so in containers."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:  # no Linux, or gone meanwhile
        return False
    return state[:1] in (["Z"], ["X"])


def _machine() -> str:
    """Name of the machine, without what a name of a file cannot hold."""
    return "".join(letter if letter.isalnum() else "_" for letter in platform.node())[:24]
