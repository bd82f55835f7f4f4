"""What a process prints of its outcome: tables, notes, checks, warnings; red beyond a limit."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from umform.cli.root import console
from umform.cli.run_checks import show_checks
from umform.cli.step_table import blocks
from umform.cli.warnings import echo_warnings

if TYPE_CHECKING:
    from umform.results.outcome import Annex, Outcome

#: Columns of text: all others are numbers.
_TEXT = ("quantity", "outcome", "unit")


def show_outcome(
    outcome: Outcome, *more: str, note: str = "", everything: bool = True, without: Iterable[str] = ()
) -> None:
    """Print an outcome.

    Parameters
    ----------
    outcome : Outcome
        What a process reports.
    more : str
        Further notes; empty ones are left out.
    note : str
        Source of the material data; may be empty.
    everything : bool
        Print all numbers and checks, and the note; otherwise the leading numbers, and what is beyond a limit.
    without : iterable of str
        Warnings that are printed elsewhere.
    """
    screen = console()
    tables = outcome.tables if everything else outcome.short_tables
    for number, (title, rows) in enumerate(tables.items()):
        print_table(rows, title if number else outcome.title)
    for text in filter(None, (*outcome.all_notes, *more, note if everything else "")):
        screen.print(text, soft_wrap=True, markup=False)
    show_checks(screen, outcome.stages, everything=everything)
    echo_warnings(text for text in outcome.warnings if text not in without)
    for annex in outcome.annexes:
        show_annex(annex)
    if not everything:
        screen.print(
            "all numbers, the source of the metal, penetrations and balance: --all, or the report", style="dim"
        )


def show_annex(annex: Annex) -> None:
    """Print a study of the results."""
    print_table(annex.table, annex.title)
    for note in annex.notes:
        console().print(note, soft_wrap=True, markup=False)
    echo_warnings(annex.warnings)


def print_table(rows: Sequence[Sequence[str]], title: str | None = None) -> None:
    """Print a header and rows of cells; cells beyond a limit are red.

    Cells wrap between words. A table whose words are too wide for the screen is printed in parts of whole columns: rich
    would shorten the numbers.
    """
    from rich import box
    from rich.table import Table
    from rich.text import Text

    from umform.results.quantity import Bad

    screen, (header, *cells) = console(), rows
    words = [max(len(word) for row in rows for word in row[number].split() or [""]) for number in range(len(header))]
    for columns in blocks([max(len(row[0]) for row in rows), *words[1:]], screen.width):
        table = Table(title=title, box=box.SIMPLE_HEAD, min_width=len(title or ""))
        for number in (0, *columns):
            text = number == 0 or header[number] in _TEXT
            table.add_column(header[number], justify="left" if text else "right", no_wrap=number == 0)
        for row in cells:
            shown = [row[number] for number in (0, *columns)]
            table.add_row(*(Text(cell, style="bold red" if isinstance(cell, Bad) else "") for cell in shown))
        screen.print(table)
        title = None
