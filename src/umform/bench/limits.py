"""Limits: memory of a process, and size of the folder of the bench."""

from __future__ import annotations

import os
import shutil
import time
from contextlib import suppress
from pathlib import Path

from umform.errors import UmformError

#: Share of the memory of the machine for a job: a mesh that is far too fine fails with a message.
_MEMORY = 0.8
#: Bytes that stay free on the disk, and seconds for which a measured size is valid.
_MIN_FREE, _MAX_AGE = 200e6, 5.0


class DiskFull(UmformError):
    """The folder of the bench has reached its limit, or the disk is full."""

    id = "bench.disk"


def limit_memory() -> None:
    """Limit the memory of this process: a mesh that needs more raises an error. Windows has no such limit."""
    try:
        import resource
    except ModuleNotFoundError:
        return
    with suppress(ValueError, OSError):
        most = int(_MEMORY * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
        resource.setrlimit(resource.RLIMIT_AS, (most, resource.getrlimit(resource.RLIMIT_AS)[1]))


class Disk:
    """Disk space of the bench.

    Parameters
    ----------
    folder : Path
        Folder of the bench.
    most : float
        Limit of all its files in bytes.
    """

    def __init__(self, folder: Path, most: float) -> None:
        self.folder, self.most = folder, most
        self._found: UmformError | None = None
        self._next = 0.0

    def problem(self) -> UmformError | None:
        """Why another job has no space; None if it has. The disk is checked every few seconds at most."""
        now = time.monotonic()
        if now >= self._next:
            self._found = self._measure()
            self._next = time.monotonic() + max(_MAX_AGE, 20.0 * (time.monotonic() - now))
        return self._found

    def expire(self) -> None:
        """Measure again at the next call: files were deleted."""
        self._next = 0.0

    def _measure(self) -> UmformError | None:
        taken, free = _size(self.folder), shutil.disk_usage(self.folder).free
        if taken >= self.most:
            return DiskFull(
                "the folder of the bench is full",
                where=str(self.folder),
                value=f"{taken / 1e9:.2f} of {self.most / 1e9:.2f} GB",
                cause="many jobs, or a deck that writes many frames",
                remedy="delete jobs in the list, or start umform bench with a larger --disk",
            )
        if free < _MIN_FREE:
            return DiskFull(
                "the disk is nearly full",
                where=str(self.folder),
                value=f"{free / 1e6:.0f} MB are free",
                cause="other files on the same disk",
                remedy="make room on the disk, or choose a --folder on another one",
            )
        return None


def _size(folder: Path) -> int:
    """Bytes of all files in a folder."""
    total = 0
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            with suppress(OSError):
                if entry.is_dir(follow_symlinks=False):
                    total += _size(Path(entry.path))
                else:
                    total += entry.stat(follow_symlinks=False).st_size
    return total
