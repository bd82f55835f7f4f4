"""``--timing``: table of the time of the parts of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.root import console

if TYPE_CHECKING:
    from umform.attempts import Attempts
    from umform.timing import Timing

Timed = Annotated[bool, typer.Option("--timing", help="Show the time of each part.")]


def show_timing(timing: Timing, title: str = "Where the time went") -> None:
    """Print seconds, shares and calls of the parts."""
    from rich import box
    from rich.table import Table

    from umform import threads
    from umform.processors import available

    count, processors = threads(), available()
    used = f"{count} thread{'s' if count > 1 else ''}, {processors} processor{'s' if processors > 1 else ''}"
    table = Table("part", title=f"{title}: {used}", box=box.SIMPLE_HEAD)
    for name in ("s", "%", "calls", "ms a call"):
        table.add_column(name, justify="right")
    for name, seconds, share, calls in timing.rows():
        each = "" if calls is None else f"{1e3 * seconds / calls:.3f}"
        table.add_row(name, f"{seconds:.3f}", f"{100 * share:.1f}", "" if calls is None else str(calls), each)
    table.add_section()
    runs = f"{timing.run.calls} run{'s' if timing.run.calls > 1 else ''}"
    table.add_row("all", f"{timing.total:.3f}", "100.0", runs, "")
    console().print(table)
    _show_attempts(timing.attempts)


def _show_attempts(attempts: Attempts) -> None:
    """Print how often each strategy was tried and succeeded, and the causes of failed attempts."""
    from rich import box
    from rich.table import Table

    from umform.attempts import HARMLESS

    table = Table("strategy", title=attempts.summary, caption=HARMLESS, box=box.SIMPLE_HEAD)
    for name in ("tried", "won"):
        table.add_column(name, justify="right")
    for name, tried, won in attempts.rows():
        table.add_row(name, str(tried), str(won))
    if attempts.causes:
        table.add_section()
    for cause, count in attempts.causes.most_common():
        table.add_row(f"given up: {cause}", str(count), "")
    if attempts.staged:
        table.add_row("return maps in stages", str(attempts.staged), "")
    console().print(table)
