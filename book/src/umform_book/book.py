"""The book: its chapters, and running cases in parallel processes, each of which writes its own page."""

from __future__ import annotations

import logging
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache, partial
from importlib import import_module
from pathlib import Path

from umform.errors import InvalidValue, UmformError
from umform.io.atomic import write_problem
from umform.pool import check_processes, run_all
from umform.report.versions import versions
from umform_book.balance_tables import balance_page, worst_balance
from umform_book.case import Case, Chapter
from umform_book.checks import Verdict
from umform_book.errata import errata_text
from umform_book.outcome import CheckRecord, Outcome
from umform_book.page import Page
from umform_book.stored import RESULTS, store, stored
from umform_book.summary import summary_text
from umform_book.which_element import which_element_text
from umform_book.writing import failed_text, page_text, write_text

#: Largest resultant of the external forces over the sum of their sizes that Newton's tolerance leaves.
BALANCED = 1e-6

#: Folders of the chapters, in the order of the book.
_FOLDERS = (
    "reality",
    "quality",
    "linear",
    "nonlinear",
    "plastic",
    "material",
    "contact",
    "friction",
    "sheets_that_touch",
    "drawing",
    "free_bending",
    "sharp_bends",
    "air_bending",
    "scatter",
    "derivatives",
)


@cache
def chapters() -> tuple[Chapter, ...]:
    """All chapters."""
    return tuple(import_module(f"umform_book.{folder}").CHAPTER for folder in _FOLDERS)


def cases() -> dict[str, Case]:
    """All cases by name."""
    return {case.name: case for chapter in chapters() for case in chapter.cases}


def chosen(names: Sequence[str]) -> list[Case]:
    """Cases of the given names.

    Raises
    ------
    InvalidValue
        If there is no such case; the message has the nearest name.
    """
    known = cases()
    for name in names:
        if name not in known:
            near = get_close_matches(name, known, 1)
            raise InvalidValue(
                "there is no such verification case",
                value=name,
                remedy=f"did you mean {near[0]}?" if near else "`umform verify` lists them",
            )
    return [known[name] for name in names]


@dataclass(frozen=True)
class Order:
    """A case for a process to run."""

    name: str
    folder: Path
    short: bool


def run_case(order: Order, tick: Callable[[str, float], None] = lambda what, done: None) -> Outcome:
    """Run a case and write its page, pictures and results into a folder."""
    case = cases()[order.name]
    logging.getLogger("umform").addHandler(logging.NullHandler())  # no warnings on the console
    page = Page(case, order.folder / "images", order.short, tick)
    start = clock.perf_counter()
    case.run(page)
    if page.balances:
        largest = max(row.force for row in page.balances)
        page.at_most("resultant of the external forces over their sizes, all runs", largest, BALANCED)
    write_text(order.folder / f"{case.name}.md", page_text(page))
    outcome = Outcome(
        name=case.name,
        verdict=page.verdict,
        checks=tuple(CheckRecord.of(check) for check in page.checks),
        balance=worst_balance(page.balances) if page.balances else None,
        studies=tuple(page.studies),
        comparisons=tuple(page.comparisons),
        versions=_made_with(),
        seconds=clock.perf_counter() - start,
    )
    store(order.folder, outcome)
    return outcome


def run_cases(
    names: Sequence[str],
    folder: Path,
    *,
    short: bool = False,
    processes: int | None = None,
    tick: Callable[[str, float], None] = lambda what, done: None,
) -> dict[str, Outcome]:
    """Run cases and write their pages; then write the pages of all cases from the stored results of all runs.

    Parameters
    ----------
    names : sequence of str
        The cases.
    folder : Path
        Where the pages go.
    short : bool
        Whether only the short meshes are run.
    processes : int, optional
        How many run at a time; default: the processors.
    tick : callable
        Progress: called with a label and the fraction that is done.

    Returns
    -------
    dict of str to Outcome
        A case that fails has an outcome with the reason; the others still run.

    Raises
    ------
    InvalidValue
        If there is no such case, or the number of processes is less than 1.
    FileProblem
        If the folder cannot be made, or results in it cannot be read.
    """
    check_processes(processes)
    selected = chosen(names)
    try:
        for kind in ("images", RESULTS):
            (folder / kind).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise write_problem(folder, error, what="the folder cannot be made") from error
    orders = [Order(case.name, folder, short) for case in selected]
    alone = len(orders) == 1
    found = run_all(
        partial(run_case, tick=tick) if alone else run_case,
        orders,
        [case.cost for case in selected],
        on_failure=_failed,
        processes=1 if alone else processes,
        tick=(lambda done: None) if alone else partial(tick, "cases"),
    )
    for page, text in pages_of_all(folder).items():
        write_text(folder / page, text)
    return {outcome.name: outcome for outcome in found}


def pages_of_all(folder: Path) -> dict[str, str]:
    """The pages of all cases, by file, from the results that are stored in the folder of the book."""
    outcomes = stored(folder, cases())
    return {
        "README.md": summary_text(chapters(), outcomes),
        "balance.md": balance_page(chapters(), outcomes),
        "which-element.md": which_element_text(outcomes),
        "errata.md": errata_text(outcomes),
    }


def _failed(order: Order, error: Exception) -> Outcome:
    """A red case; its page gives the reason and replaces the old one."""
    message = str(error) if isinstance(error, UmformError) else f"{type(error).__name__}: {error}"
    write_text(order.folder / f"{order.name}.md", failed_text(cases()[order.name], message))
    outcome = Outcome(order.name, Verdict.RED, failure=message, versions=_made_with())
    store(order.folder, outcome)
    return outcome


def _made_with() -> str:
    return ", ".join(f"{name} {version}" for name, version in versions().items() if name != "platform")
