"""Warnings on standard error: each one once, repetitions are counted at the end."""

from __future__ import annotations

import logging
import re
from collections.abc import Iterable

from umform.cli.root import say
from umform.report.repeats import counted, without_place

#: The bend of a part, which the log does not name.
_BEND = re.compile(r"^bend \d+: ")


class _Warnings(logging.Handler):
    """Prints each warning of the log at its first occurrence; those that differ only in step and time are the same."""

    def __init__(self, *, prints: bool) -> None:
        super().__init__(logging.WARNING)
        self.prints = prints
        self.known: set[str] = set()

    def emit(self, record: logging.LogRecord) -> None:
        text = without_place(record.getMessage())
        if self.prints and text not in self.known:
            try:
                say(record.getMessage())
            except OSError:  # standard error is closed: no reason to end a run
                self.handleError(record)
        self.known.add(text)


def print_warnings_once() -> None:
    """Print warnings of the log from now on; with ``--verbose`` the log does so itself."""
    logger = logging.getLogger("umform")
    others = [handler for handler in logger.handlers if not isinstance(handler, _Warnings)]
    logged = any(isinstance(handler, logging.StreamHandler) for handler in others)
    logger.handlers[:] = [*others, _Warnings(prints=not logged)]


def echo_warnings(warnings: Iterable[str]) -> None:
    """Print the remaining warnings of a result, and the number of repetitions."""
    known = {text for handler in logging.getLogger("umform").handlers for text in getattr(handler, "known", ())}
    for warning in counted(warnings):
        if without_place(_BEND.sub("", warning)) not in known:
            say(warning)
