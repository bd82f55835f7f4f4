"""Warnings on standard error: each of them once, when it comes; what came again is counted at the end."""

from __future__ import annotations

import logging
from collections.abc import Iterable

import typer

from umform.report.repeats import counted, without_place


class _Warnings(logging.Handler):
    """Prints each warning of the log when it comes first; what differs only in step and time is the same."""

    def __init__(self, *, prints: bool) -> None:
        super().__init__(logging.WARNING)
        self.prints = prints
        self.known: set[str] = set()

    def emit(self, record: logging.LogRecord) -> None:
        text = without_place(record.getMessage())
        if self.prints and text not in self.known:
            try:
                typer.echo(f"umform: {record.getMessage()}", err=True)
            except OSError:  # nobody reads it: no reason to end a run
                self.handleError(record)
        self.known.add(text)


def print_warnings_once() -> None:
    """Print warnings of the log from now on; with ``--verbose`` the log does so itself."""
    logger = logging.getLogger("umform")
    others = [handler for handler in logger.handlers if not isinstance(handler, _Warnings)]
    logged = any(isinstance(handler, logging.StreamHandler) for handler in others)
    logger.handlers[:] = [*others, _Warnings(prints=not logged)]


def echo_warnings(warnings: Iterable[str]) -> None:
    """Print the warnings of a result that were not printed when they came, and how often others came."""
    known = {text for handler in logging.getLogger("umform").handlers for text in getattr(handler, "known", ())}
    for warning in counted(warnings):
        if without_place(warning) not in known:
            typer.echo(f"umform: {warning}", err=True)
