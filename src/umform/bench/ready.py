"""A process that has loaded all it needs and waits for the folder of its job."""

from __future__ import annotations

import subprocess
from pathlib import Path


class Ready:
    """Keeps one process ready; it ends if this one does.

    Parameters
    ----------
    command : list of str
        Starts a process that reads the folder of its job.
    log : Path
        Takes what such processes print.
    """

    def __init__(self, command: list[str], log: Path) -> None:
        self.command, self.log = command, log
        self._process: subprocess.Popen[bytes] | None = None

    def keep(self) -> subprocess.Popen[bytes]:
        """Start the process, unless it is there."""
        if self._process is None or self._process.poll() is not None:
            self.let_go()
            with self.log.open("ab") as text:
                self._process = subprocess.Popen(
                    self.command, stdin=subprocess.PIPE, stdout=text, stderr=text, start_new_session=True
                )
        return self._process

    def take(self) -> subprocess.Popen[bytes]:
        """Hand the process on; another one is started when it is next wanted."""
        process, self._process = self.keep(), None
        return process

    def let_go(self) -> None:
        """End the process that waits."""
        if self._process is not None:
            self._process.kill()  # it has no job
            self._process.wait()
            if self._process.stdin is not None:
                self._process.stdin.close()
            self._process = None
