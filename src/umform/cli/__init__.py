"""The command line, one file per command.

Nothing else is imported here, so that Ctrl-C is handled from the first moment.
"""

from __future__ import annotations

import gc
import importlib
import io
import os
import signal
import sys
from typing import Any

#: Exit codes for a program that is ended by SIGPIPE (128 + 13), and by Ctrl-C.
CLOSED_PIPE, INTERRUPTED = 141, 130
#: New objects between two searches for cycles: with Python's 700 they cost some per cent of a bend, mostly in imports.
_COLLECT_AFTER = 200_000


def __getattr__(name: str) -> Any:
    """Import the commands when they are first used."""
    if name != "app":
        raise AttributeError(f"module 'umform.cli' has no attribute {name!r}")
    return importlib.import_module("umform.cli.commands").application()


def main() -> None:
    """Start the command line; it ends quietly if the reader of its output stops, as in ``umform new | head -1``."""
    try:
        gc.set_threshold(_COLLECT_AFTER)
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # more threads would only wait, actively
        os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # of MKL, the same
        _prepare_streams()
        signal.signal(signal.SIGTERM, signal.default_int_handler)  # the signal of batch systems: handled as Ctrl-C
        importlib.import_module("umform.cli.drawing").without_help_texts()
        importlib.import_module("umform.cli.help_pages").without_markdown()
        importlib.import_module("umform.cli.commands").application(sys.argv[1:])(prog_name="umform")
    except KeyboardInterrupt:  # before the first command
        print("umform: interrupted", file=sys.stderr)
        sys.exit(INTERRUPTED)
    except SystemExit as end:
        if not isinstance(end.__context__, BrokenPipeError):  # for which typer and rich exit with code 1
            raise
        _lead_to_nowhere(1, 2)
        sys.exit(CLOSED_PIPE)
    finally:
        gc.freeze()  # the end of the process frees its memory: a last search for cycles costs some per cent of a bend


class _Closed(io.TextIOBase):
    """Substitute for a standard output that was closed before the start."""

    wanted = False

    def write(self, text: str, /) -> int:
        """Refuse it, as a full disk does."""
        self.wanted = True
        self.flush()
        return 0

    def flush(self) -> None:
        """Fail if there was data to write."""
        if self.wanted:
            raise OSError("it was closed before the start")


def _prepare_streams() -> None:
    """Replace closed streams, so that a file of results cannot get their number and receive printed text."""
    if sys.stdout is None:
        _lead_to_nowhere(1)
        sys.stdout = _Closed()
    if sys.stderr is None:
        _lead_to_nowhere(2)
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123  (to the end; pathlib takes time)


def _lead_to_nowhere(*descriptors: int) -> None:
    """Redirect the data in the buffers to the null device, so that Python does not report a broken pipe at exit."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for descriptor in descriptors:  # 1 is standard output, 2 standard error
        os.dup2(nowhere, descriptor)
