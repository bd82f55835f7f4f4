"""``umform verify``: run cases of the verification book and show their pages."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.root import Debug, Verbose, console

if TYPE_CHECKING:
    from umform_book.outcome import Outcome


def verify(
    case: Annotated[list[str] | None, typer.Argument(help="Names of cases; without them, list all.")] = None,
    everything: Annotated[bool, typer.Option("--all", help="Run all cases.")] = False,
    short: Annotated[bool, typer.Option("--short", help="Run the short meshes only.")] = False,
    out: Annotated[Path, typer.Option(metavar="FOLDER", help="Folder for the pages.")] = Path("results/verification"),
    processes: Annotated[int | None, typer.Option(help="Cases at a time; default: the processors.")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Do not show the page.")] = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Run cases of the verification book, write their pages and the summary of all, and show them.

    A red verdict ends with exit code 1.
    """
    from umform.progress import progress_bar
    from umform_book.book import cases, run_cases
    from umform_book.checks import Verdict

    names = list(cases()) if everything else list(dict.fromkeys(case or ()))
    if not names:
        _list_cases()
        return
    with progress_bar() as tick:
        outcomes = run_cases(names, out, short=short, processes=processes, tick=tick)
    if len(names) == 1 and not quiet and not outcomes[names[0]].failure:
        _show_page(out / f"{names[0]}.md")
    _show_verdicts(outcomes, out)
    if any(outcome.verdict is Verdict.RED for outcome in outcomes.values()):
        raise typer.Exit(1)


def _list_cases() -> None:
    """All cases, chapter by chapter."""
    from rich import box
    from rich.table import Table

    from umform_book.book import chapters

    table = Table("name", "case", box=box.SIMPLE_HEAD)
    for chapter in chapters():
        for case in chapter.cases:
            table.add_row(case.name, case.title)
        table.add_section()
    console().print(table)


def _show_page(path: Path) -> None:
    """Show the page in the terminal."""
    from rich.markdown import Markdown

    from umform_book.markdown import unfolded

    console().print(Markdown(unfolded(path.read_text(encoding="utf-8"))))


def _show_verdicts(outcomes: dict[str, Outcome], out: Path) -> None:
    """One line per case, and the error of a failed case."""
    from rich import box
    from rich.table import Table

    table = Table("case", "verdict", "checks", "seconds", box=box.SIMPLE_HEAD)
    for outcome in outcomes.values():
        table.add_row(outcome.name, outcome.verdict.mark, str(len(outcome.checks)), f"{outcome.seconds:.1f}")
    screen = console()
    screen.print(table)
    screen.print(f"Pages written to {out}", soft_wrap=True)
    for outcome in outcomes.values():
        if outcome.failure:
            typer.echo(f"umform: {outcome.name}: {outcome.failure}", err=True)
