"""A spare process, which has loaded its modules and waits for the folder of its job."""

from __future__ import annotations

import subprocess
from pathlib import Path


class SpareProcess:
    """Keeps one spare process; it ends with this one.

    Parameters
    ----------
    command : list of str
        Command of a process that reads the folder of its job.
    log : Path
        File of its output.
    """

    def __init__(self, command: list[str], log: Path) -> None:
        self.command, self.log = command, log
        self._process: subprocess.Popen[bytes] | None = None

    def start_if_needed(self) -> subprocess.Popen[bytes]:
        """Start the process if there is none."""
        if self._process is None or self._process.poll() is not None:
            self.end()
            with self.log.open("ab") as text:
                self._process = subprocess.Popen(
                    self.command, stdin=subprocess.PIPE, stdout=text, stderr=text, start_new_session=True
                )
        return self._process

    def take(self) -> subprocess.Popen[bytes]:
        """Return the process; the next call starts another one."""
        process, self._process = self.start_if_needed(), None
        return process

    def end(self) -> None:
        """End the spare process."""
        if self._process is not None:
            self._process.kill()  # it has no job
            self._process.wait()
            if self._process.stdin is not None:
                self._process.stdin.close()
            self._process = None
