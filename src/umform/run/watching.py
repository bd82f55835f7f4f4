"""Somebody who looks at a run between two increments: a page that draws the curve while it grows."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from umform.steps.loop import Run

#: Is called with the run, which it must leave as it is.
Watcher = Callable[["Run"], None]
_watcher: ContextVar[Watcher | None] = ContextVar("umform_watcher", default=None)


@contextmanager
def watching(watcher: Watcher) -> Iterator[None]:
    """Have a function called between any two increments of the runs in the block."""
    before = _watcher.set(watcher)
    try:
        yield
    finally:
        _watcher.reset(before)


def show(run: Run) -> None:
    """Call who is watching."""
    watcher = _watcher.get()
    if watcher is not None:
        watcher(run)
