"""Observers of a run between two increments: a page that draws the curve during the run."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from umform.analysis.steps.run_state import Run

#: Called with the run, which it must not change.
Watcher = Callable[["Run"], None]
_watcher: ContextVar[Watcher | None] = ContextVar("umform_watcher", default=None)


@contextmanager
def watching(watcher: Watcher) -> Iterator[None]:
    """Call a function between any two increments of the runs in the block."""
    before = _watcher.set(watcher)
    try:
        yield
    finally:
        _watcher.reset(before)


def show(run: Run) -> None:
    """Call the observers."""
    watcher = _watcher.get()
    if watcher is not None:
        watcher(run)
