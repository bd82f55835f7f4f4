"""Progress bars on a terminal and in a notebook; no output elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from html import escape
from typing import Any, Protocol, TypeAlias


class Tick(Protocol):
    """Takes the completed fraction, and a short text on the state."""

    def __call__(self, name: str, fraction: float, detail: str = "", /) -> None:
        """Move the bar of a name."""


#: Seconds before a bar appears in a notebook, and between its changes.
_LATE, _OFTEN = 0.5, 0.2
#: Whether there is a bar, by default on a terminal and in a notebook only; or what takes the place of the bars.
Show: TypeAlias = bool | Tick | None


@contextmanager
def progress_bar(show: Show = None) -> Iterator[Tick]:
    """Yield ``tick(name, fraction, detail)``; one bar per name.

    There are bars on a terminal and in a notebook only, unless ``show`` overrides it.
    """
    if callable(show):
        yield show
        return
    notebook = _notebook()
    if show is None:
        show = notebook is not None or (sys.stderr is not None and sys.stderr.isatty())
    if not show:
        yield silent
        return
    if notebook is not None:
        bars = NotebookBars(notebook)
        try:
            yield bars
        finally:
            bars.remove()
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


def _notebook() -> Any:
    """The module IPython.display in a process that computes cells of a notebook; None elsewhere."""
    ipython: Any = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    if shell is None or not hasattr(shell, "kernel"):
        return None
    from IPython import display

    return display


class NotebookBars:
    """The tick of a notebook: bars in one output of the cell, which needs no widgets, and goes at the end.

    Parameters
    ----------
    display : module
        ``IPython.display``.
    """

    def __init__(self, display: Any) -> None:
        self._display = display
        self._handle: Any = None
        self._bars: dict[str, tuple[float, str]] = {}
        self._started = time.monotonic()
        self._next = self._started + _LATE

    def __call__(self, name: str, fraction: float, detail: str = "", /) -> None:
        """Move the bar of a name."""
        self._bars[name] = fraction, detail
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + _OFTEN
        shown = self._display.HTML(self._html(now - self._started))
        if self._handle is None:
            self._handle = self._display.display(shown, display_id=True)
        else:
            self._handle.update(shown)

    def _html(self, seconds: float) -> str:
        rows = (
            f"<div>{escape(name)} <progress max='1' value='{min(max(fraction, 0.0), 1.0):.3f}'></progress> "
            f"{100.0 * fraction:.0f} % {escape(detail)}</div>"
            for name, (fraction, detail) in self._bars.items()
        )
        return f"{''.join(rows)}<div>{seconds:.0f} s</div>"

    def remove(self) -> None:
        """Remove the bars from the output."""
        if self._handle is not None:
            self._handle.update(self._display.HTML(""))


def silent(name: str, fraction: float, detail: str = "", /) -> None:
    """Show nothing."""


@dataclass
class Part:
    """Tick of one of several runs that follow each other under one bar, which therefore tells the time left for all.

    Attributes
    ----------
    bar : callable
        Moves the bar.
    name, which : str
        Name of the bar, and the number of the run.
    start, share : float
        Where the run begins, and what it is of the whole.
    moves : int
        Steps of the run that take its time: moves, whose names are a number only. Others do not move the bar.
    """

    bar: Tick
    name: str
    which: str
    start: float
    share: float
    moves: int
    begun: list[str] = field(default_factory=list)

    def __call__(self, name: str, fraction: float, detail: str = "", /) -> None:
        """Move the bar by a step of the run."""
        move = ":" not in name
        if move and name not in self.begun:
            self.begun.append(name)
        part = (len(self.begun) - 1 + fraction if move else len(self.begun)) / self.moves
        self.bar(self.name, self.start + self.share * min(part, 1.0), f"{self.which}, {name}: {detail}")


def parts(bar: Tick, name: str, costs: Sequence[float], moves: int = 1) -> Iterator[Part]:
    """The ticks of runs by their estimated durations, in any unit."""
    done, total = 0.0, sum(costs)
    for number, cost in enumerate(costs, 1):
        yield Part(bar, name, f"{number} of {len(costs)}", done / total, cost / total, moves)
        done += cost
