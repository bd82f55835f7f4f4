"""A progress bar on a terminal; no output elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol


class Tick(Protocol):
    """Takes the completed fraction, and a short text on the state."""

    def __call__(self, name: str, fraction: float, detail: str = "", /) -> None:
        """Move the bar of a name."""


@contextmanager
def progress_bar(show: bool | None = None) -> Iterator[Tick]:
    """Yield ``tick(name, fraction, detail)``; one bar per name, on a terminal only unless ``show`` overrides it."""
    if show is None:
        show = sys.stderr is not None and sys.stderr.isatty()
    if not show:
        yield silent
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        TextColumn("{task.fields[detail]}", markup=False),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        tasks: dict[str, int] = {}

        def tick(name: str, fraction: float, detail: str = "", /) -> None:
            if name not in tasks:  # work before the first call does not count for the speed
                tasks[name] = progress.add_task(name, total=1.0, completed=fraction, detail=detail)  # type: ignore[arg-type]
            progress.update(tasks[name], completed=fraction, detail=detail)  # type: ignore[arg-type]

        yield tick


def silent(name: str, fraction: float, detail: str = "", /) -> None:
    """Show nothing."""
