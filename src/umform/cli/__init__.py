"""The command line, one command a file; what fails says so in a few lines."""

import os
import sys

from umform.cli import bend, check, demo, elements, new, plot, resume, run, view
from umform.cli.plugins import add_plugins
from umform.cli.root import app

__all__ = ["app", "bend", "check", "demo", "elements", "main", "new", "plot", "resume", "run", "view"]

add_plugins(app)

#: What a shell reports of a program that is ended by SIGPIPE: 128 + 13.
CLOSED_PIPE = 141


def main() -> None:
    """Start the command line; it ends quietly if nobody reads on, as in ``umform new | head -1``."""
    try:
        app(prog_name="umform")
    except SystemExit as end:
        if not isinstance(end.__context__, BrokenPipeError):  # of which typer and rich make an end with code 1
            raise
        _drop_output()
        sys.exit(CLOSED_PIPE)


def _drop_output() -> None:
    """Lead what is still in the buffers to nowhere, lest Python complain at its end that nobody takes it."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for descriptor in (1, 2):  # standard output, standard error
        os.dup2(nowhere, descriptor)
