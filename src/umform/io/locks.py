"""Locks of open files between processes; the system releases them when their process ends, however it ends."""

from __future__ import annotations

import os
import sys
from typing import IO, Any

if sys.platform == "win32":
    import msvcrt

    #: Windows locks bytes, and those of others cannot be read: a byte beyond all content.
    _BEYOND = 1 << 30

    def try_lock(file: IO[Any], *, shared: bool = False) -> bool:
        """Lock a file if no other process has locked it. A shared lock is a lock here."""
        del shared
        os.lseek(file.fileno(), _BEYOND, os.SEEK_SET)
        try:
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        except OSError:
            return False
        finally:
            os.lseek(file.fileno(), 0, os.SEEK_SET)
        return True

else:
    import fcntl

    def try_lock(file: IO[Any], *, shared: bool = False) -> bool:
        """Lock a file until it is closed, if no other process has locked it.

        Parameters
        ----------
        file : file
            An open file.
        shared : bool, optional
            Others may share this lock.

        Returns
        -------
        bool
            False if another process has a lock that excludes this one.
        """
        try:
            fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
        except OSError:
            return False
        return True
