"""Owner of a temporary file or folder: a running process, or one that was killed."""

from __future__ import annotations

import os
import platform
import time
from pathlib import Path

#: Seconds within which a process records its ownership.
_YOUNG = 10.0


def mark() -> str:
    """Machine and number of this process, valid as part of a file name."""
    return f"{_machine()}-{os.getpid()}"


def pid_of(mark: str) -> int | None:
    """Number of a process from its mark; None without a mark."""
    number = mark.rpartition("-")[2]
    return int(number) if number.isdecimal() else None


def is_left_behind(path: Path, mark: str) -> bool:
    """Whether the process that made a file or folder, with this mark, is gone.

    Parameters
    ----------
    path : Path
        The file or folder; its age decides if there is no mark.
    mark : str
        Value of :func:`mark` in that process; empty if it was not recorded.

    Returns
    -------
    bool
        False also for a process of another machine, whose state is unknown.
    """
    pid = pid_of(mark)
    try:
        age = time.time() - path.stat().st_mtime
    except OSError:  # removed meanwhile
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
    except (PermissionError, OverflowError):  # it belongs to another user
        return True
    return not _has_ended(pid)


def _has_ended(pid: int) -> bool:
    """Whether a process is a zombie, whose parent has not waited for it: often so in containers."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
    except OSError:  # not Linux, or gone meanwhile
        return False
    return state[:1] in (["Z"], ["X"])


def _machine() -> str:
    """Name of the machine, without characters that a file name cannot have."""
    return "".join(letter if letter.isalnum() else "_" for letter in platform.node())[:24]
