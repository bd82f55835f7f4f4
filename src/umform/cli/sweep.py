"""``umform sweep``: run a deck over values of some of its keys."""

from __future__ import annotations

import csv
import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.check import Changes, DeckFile, Force, deck_errors, read
from umform.cli.root import Debug, Verbose, app, console
from umform.cli.warnings import print_warnings_once
from umform.errors import FileProblem, InvalidValue

if TYPE_CHECKING:
    from umform.studies.sweep import Sweep
    from umform.studies.sweep.values import Written


@app.command()
def sweep(
    deck: DeckFile,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=VALUES", help="thickness=0.8:1.2:0.1 (first:last:step) or material=DC04,1.4301; repeatable."
        ),
    ] = None,
    jobs: Annotated[
        Path | None, typer.Option(metavar="FILE", help="CSV file: keys in its header, a job in each row.")
    ] = None,
    measure: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Column of the history, such as punch_force:max (or last, min, peak, sum), or springback; repeatable.",
        ),
    ] = None,
    changes: Changes = None,
    out: Annotated[
        str | None, typer.Option(metavar="FOLDER", help="Folder for table, plot and jobs; default: results/DECK-sweep.")
    ] = None,
    processes: Annotated[int | None, typer.Option(help="Jobs at a time; default: as many as processors.")] = None,
    files: Annotated[bool, typer.Option("--files", help="Write all files of the deck for each job.")] = False,
    retry: Annotated[bool, typer.Option("--retry", help="Repeat jobs that were refused or did not converge.")] = False,
    force: Force = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Run a deck over all combinations of values of some of its keys: one table, one plot.

    Name keys as in `--set`, or by their last part if that is unique. The same command continues a stopped sweep; with
    more values it runs only the new jobs. A failure is a row with its reason.
    """
    from umform.studies.sweep import sweep as run_sweep

    print_warnings_once()
    with deck_errors():
        found = run_sweep(
            read(deck, changes or ()),
            _axes(vary or []),
            jobs=None if jobs is None else _jobs(jobs),
            measures=measure or (),
            out=out,
            processes=processes,
            files=files,
            retry=retry,
            force=force,
            on_job=_say if sys.stderr is None or not sys.stderr.isatty() else lambda row: None,
        )
    _show(found)
    if not any(row["outcome"] == "done" for row in found.rows):
        raise typer.Exit(1)


def _axes(texts: list[str]) -> dict[str, str]:
    """Values by key."""
    axes: dict[str, str] = {}
    for text in texts:
        key, sign, values = text.partition("=")
        if not sign or not key.strip():
            raise InvalidValue(
                "this varies no key",
                where="--vary",
                value=text,
                cause="the sign = is missing, or nothing stands before it",
                remedy="write key=0.8:1.2:0.1 (first:last:step) or key=0.8,0.9",
            )
        axes[key.strip()] = values
    return axes


def _jobs(path: Path) -> list[dict[str, Written]]:
    """Jobs of a CSV file."""
    from umform.studies.sweep.values import Written

    remedy = "a CSV file with commas: keys in the first line, the values of a job in each other line"
    try:
        with path.open(newline="", encoding="utf-8-sig") as text:
            header, *rows = [row for row in csv.reader(text) if row] or [[]]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        cause = getattr(error, "strerror", None) or "another kind of file, or text that is not UTF-8"
        raise FileProblem("the jobs cannot be read", where=str(path), cause=cause, remedy=remedy) from error
    if not rows or any(len(row) != len(header) for row in rows):
        cause = "a row with more or fewer cells than the header, or no row"
        raise FileProblem("this is no table of jobs", where=str(path), cause=cause, remedy=remedy)
    return [{key.strip(): Written(cell.strip()) for key, cell in zip(header, row, strict=True)} for row in rows]


def _say(row: dict[str, Any]) -> None:
    """One line for each finished job, if there is no terminal for a progress bar."""
    typer.echo(f"umform: {row['folder']}: {row['outcome']} {row['reason'][:100]}".rstrip(), err=True)


def _show(found: Sweep) -> None:
    """The table with the first measures, the causes of failures, and the files."""
    from rich import box
    from rich.table import Table

    from umform.studies.sweep.table import telling

    screen, measures = console(), telling(found.rows, found.measures)
    counts = Counter(row["outcome"] for row in found.rows)
    title = ", ".join(f"{count} {outcome}" for outcome, count in counts.items())
    table = Table(title=f"{len(found.rows)} jobs: {title}", box=box.SIMPLE_HEAD)
    for name in (*found.varied, "outcome", *measures):
        table.add_column(name, justify="left" if name == "outcome" else "right")
    for row in found.rows:
        table.add_row(*(_cell(row[name]) for name in (*found.varied, "outcome", *measures)))
    screen.print(table)
    for reason, count in Counter(row["reason"] for row in found.rows if row["reason"]).items():
        screen.print(f"{count} x {reason}", soft_wrap=True, markup=False)
    names = ", ".join(file.name for file in found.files)
    screen.print(f"Written to {found.files[0].parent}: {names}", soft_wrap=True, markup=False)


def _cell(value: Any) -> str:
    return "" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)
