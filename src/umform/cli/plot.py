"""``umform plot``: histories of several runs in one picture."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.root import Debug, app

if TYPE_CHECKING:
    from umform.io.histories import History

#: Columns along the horizontal axis of histories and of curves, the first that all runs have.
_ACROSS = ("time", "stroke", "way")


@app.command()
def plot(
    runs: Annotated[
        list[Path], typer.Argument(metavar="RUN...", help="history.csv or curve.csv of runs, or their folders.")
    ],
    x: Annotated[
        str | None, typer.Option("--x", help="Column along the horizontal axis; default: time, stroke or way.")
    ] = None,
    y: Annotated[
        list[str] | None,
        typer.Option("--y", help="Column along the vertical axis, with or without its unit; repeatable."),
    ] = None,
    out: Annotated[Path, typer.Option("--out", "-o", metavar="FILE", help="Picture: .png, .svg or .pdf.")] = Path(
        "comparison.png"
    ),
    debug: Debug = False,
) -> None:
    """Compare histories of several runs.

    Colours show runs, line styles show columns. Without --y, list all columns.
    """
    from umform.io.histories import read_histories
    from umform.plotting import compare_histories

    histories = read_histories(runs)
    if not y:
        _list_columns(histories)
        return
    across = x or next((name for name in _ACROSS if all(_column(name, [run]) for run in histories.values())), "time")
    names = [_column(name, histories.values()) or name for name in (across, *y)]
    compare_histories(histories, names[0], names[1:], out)
    typer.echo(f"Written to {out}")


def _column(name: str, runs: Iterable[History]) -> str:
    """The column of a name, or the first one that is the name with a unit behind it; empty without either."""
    columns = [column for run in runs for column in run]
    return name if name in columns else next((column for column in columns if column.startswith(f"{name} ")), "")


def _list_columns(histories: dict[str, History]) -> None:
    """Columns of each run."""
    for name, columns in histories.items():
        typer.echo(f"{name}: {', '.join(columns)}")
