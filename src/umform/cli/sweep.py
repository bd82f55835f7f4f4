"""``umform sweep``: run a deck over values of some of its keys."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.check import Changes, DeckFile, Force, Trust, deck_errors, read
from umform.cli.folders import out_option
from umform.cli.outcome_screen import print_table
from umform.cli.root import Debug, Overwrite, Verbose, app, console, say
from umform.cli.warnings import print_warnings_once
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.studies.sweep import Sweep


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
            help="Column of the history, such as punch_force:max (or last, min, peak, sum), springback, or a quantity, "
            "such as hat.theta1.released; repeatable.",
        ),
    ] = None,
    changes: Changes = None,
    out: Annotated[str | None, out_option("table, plot and jobs", "results/DECK-sweep")] = None,
    processes: Annotated[int | None, typer.Option(help="Jobs at a time; default: as many as processors.")] = None,
    files: Annotated[bool, typer.Option("--files", help="Write all files of the deck for each job.")] = False,
    retry: Annotated[bool, typer.Option("--retry", help="Repeat jobs that were refused or did not converge.")] = False,
    force: Force = False,
    trust: Trust = False,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Run a deck over all combinations of values of some of its keys: one table, one plot.

    Name keys as in `--set`, or by their last part if that is unique. The same command continues a stopped sweep; with
    more values it runs only the new jobs. A failure is a row with its reason.
    """
    from umform.studies.sweep import sweep as run_sweep

    print_warnings_once()
    with deck_errors("measure", "jobs", "processes", "vary"):
        problem = read(deck, changes or (), trust)
        found = run_sweep(
            problem,
            _axes(vary or []),
            jobs=jobs,
            changes=problem.source.changes,
            measures=measure or (),
            out=out,
            processes=processes,
            files=files,
            retry=retry,
            force=force,
            overwrite=overwrite,
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
        if key.strip() in axes:
            raise InvalidValue("a key is varied twice", where="--vary", value=text, remedy="all its values at once")
        axes[key.strip()] = values
    return axes


def _say(row: dict[str, Any]) -> None:
    """One line for each finished job, if there is no terminal for a progress bar."""
    say(f"{row['folder']}: {row['outcome']} {row['reason'][:100]}".rstrip())


def _show(found: Sweep) -> None:
    """The table with the first measures, the causes of failures, and the files."""
    from umform.studies.sweep.measures import heading
    from umform.studies.sweep.table import telling

    screen, measures = console(), telling(found.rows, found.measures)
    counts = Counter(row["outcome"] for row in found.rows)
    title = ", ".join(f"{count} {outcome}" for outcome, count in counts.items())
    header = [*found.varied, "outcome", *(heading(found.rows, name) for name in measures)]
    rows = [
        [*(_cell(row[name]) for name in (*found.varied, "outcome")), *(_measured(row, name) for name in measures)]
        for row in found.rows
    ]
    print_table([header, *rows], f"{len(found.rows)} jobs: {title}")
    for reason, count in Counter(row["reason"] for row in found.rows if row["reason"]).items():
        screen.print(f"{count} x {reason}", soft_wrap=True, markup=False)
    names = ", ".join(file.name for file in found.files)
    screen.print(f"Written to {found.files[0].parent}: {names}", soft_wrap=True, markup=False)


def _measured(row: dict[str, Any], name: str) -> str:
    """A measure of a job, red beyond its limit."""
    one = row["quantities"][name]
    return "" if one is None or one.value is None else one.text


def _cell(value: Any) -> str:
    return "" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)
