"""``umform plot``: histories of several runs in one picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.root import Debug, app

if TYPE_CHECKING:
    from umform.io.histories import History


@app.command()
def plot(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN...", help="history.csv of runs, or their folders.")],
    x: Annotated[str, typer.Option("--x", help="Column along the horizontal axis.")] = "time",
    y: Annotated[list[str] | None, typer.Option("--y", help="Column along the vertical axis; repeatable.")] = None,
    out: Annotated[Path, typer.Option(metavar="FILE", help="Picture: .png, .svg or .pdf.")] = Path("comparison.png"),
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
    compare_histories(histories, x, y, out)
    typer.echo(f"Written to {out}")


def _list_columns(histories: dict[str, History]) -> None:
    """Columns of each run."""
    for name, columns in histories.items():
        typer.echo(f"{name}: {', '.join(columns)}")
