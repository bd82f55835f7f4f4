"""The command line, one command a file; what fails says so in a few lines.

Nothing else is imported here, so that Ctrl-C is understood from the first moment on.
"""

from __future__ import annotations

import gc
import importlib
import io
import os
import signal
import sys
from typing import Any

#: What a shell reports of a program that is ended by SIGPIPE: 128 + 13; and of one that is ended by Ctrl-C.
CLOSED_PIPE, INTERRUPTED = 141, 130
#: New objects between two searches for cycles; with Python's 700 they take a twelfth of a bend, most of it in imports.
_COLLECT_AFTER = 20_000


def __getattr__(name: str) -> Any:
    """Import the commands when they are first used."""
    if name != "app":
        raise AttributeError(f"module 'umform.cli' has no attribute {name!r}")
    return importlib.import_module("umform.cli.commands").app


def main() -> None:
    """Start the command line; it ends quietly if nobody reads on, as in ``umform new | head -1``."""
    try:
        gc.set_threshold(_COLLECT_AFTER)
        _prepare_streams()
        signal.signal(signal.SIGTERM, signal.default_int_handler)  # the end that a batch system sends: as Ctrl-C
        importlib.import_module("umform.cli.commands").app(prog_name="umform")
    except KeyboardInterrupt:  # before the first command
        print("umform: interrupted", file=sys.stderr)
        sys.exit(INTERRUPTED)
    except SystemExit as end:
        if not isinstance(end.__context__, BrokenPipeError):  # of which typer and rich make an end with code 1
            raise
        _lead_to_nowhere(1, 2)
        sys.exit(CLOSED_PIPE)


class _Closed(io.TextIOBase):
    """Standard output that was closed before the start."""

    wanted = False

    def write(self, text: str, /) -> int:
        """Refuse it, as a disk that is full does."""
        self.wanted = True
        self.flush()
        return 0

    def flush(self) -> None:
        """Fail if there was something to be written."""
        if self.wanted:
            raise OSError("it was closed before the start")


def _prepare_streams() -> None:
    """Put something in the place of closed streams, lest a file of results gets their number and what is printed."""
    if sys.stdout is None:
        _lead_to_nowhere(1)
        sys.stdout = _Closed()
    if sys.stderr is None:
        _lead_to_nowhere(2)
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123  (to the end; pathlib takes time)


def _lead_to_nowhere(*descriptors: int) -> None:
    """Lead what is still in the buffers to nowhere, lest Python complain at its end that nobody takes it."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for descriptor in descriptors:  # 1 is standard output, 2 standard error
        os.dup2(nowhere, descriptor)
