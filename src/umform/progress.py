"""A progress bar on a terminal; no output elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Protocol, TypeAlias


class Tick(Protocol):
    """Takes the completed fraction, and a short text on the state."""

    def __call__(self, name: str, fraction: float, detail: str = "", /) -> None:
        """Move the bar of a name."""


#: Whether there is a bar, by default on a terminal only; or what takes the place of the bars.
Show: TypeAlias = bool | Tick | None


@contextmanager
def progress_bar(show: Show = None) -> Iterator[Tick]:
    """Yield ``tick(name, fraction, detail)``; one bar per name, on a terminal only unless ``show`` overrides it."""
    if callable(show):
        yield show
        return
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
