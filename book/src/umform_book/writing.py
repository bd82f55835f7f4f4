"""The page of a case as Markdown: verdict and picture first, then problem, reference, results, checks, balance."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TypeVar

from umform.io.atomic import PendingFile
from umform_book.balance_tables import balance_line, balance_table
from umform_book.case import Case
from umform_book.checks import Check, Verdict
from umform_book.markdown import folded, markdown_table
from umform_book.outcome import CheckRecord
from umform_book.page import Comparison, Page

Judged = TypeVar("Judged", Check, CheckRecord)


def write_text(path: Path, text: str) -> None:
    """Write a whole file or none."""
    with PendingFile(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def page_text(page: Page) -> str:
    """Markdown of a page."""
    case = page.case
    parts = [
        f"# {case.title}",
        f"**{page.verdict.mark}** · {counted(page.checks)} · `umform verify {case.name}`",
        worst_sentence(page.checks),
        page.main,
        "## Problem",
        case.problem.strip(),
        "## Reference",
        case.reference.strip(),
        f"**Own reference:** {case.own}." if case.own else "",
        *compared(page),
        *(["## Results", *page.blocks] if page.blocks else []),
        "## Checks",
        *_checks(page.checks),
    ]
    if page.balances:
        parts += [
            "## Balance",
            balance_line(page.balances),
            folded("Balance of each run", balance_table(page.balances)),
        ]
    return "\n\n".join(part for part in parts if part) + "\n\n[All cases](README.md)\n"


def compared(page: Page) -> list[str]:
    """The numbers of a page beside their measurements."""
    if not page.comparisons:
        return []
    return ["## Beside measurements", markdown_table(Comparison.COLUMNS, [one.row for one in page.comparisons])]


def failed_text(case: Case, message: str) -> str:
    """Markdown of the page of a case that could not be run to its end."""
    return f"# {case.title}\n\n**{Verdict.RED.mark}** · `umform verify {case.name}` failed:\n\n```\n{message}\n```\n"


def counted(checks: Sequence[Check]) -> str:
    """How many checks hold, and how many fail as theory predicts."""
    expected = sum(check.verdict is Verdict.EXPECTED for check in checks)
    green = sum(check.verdict is Verdict.GREEN for check in checks)
    failures = f", {expected} expected failure{'s' * (expected > 1)}" if expected else ""
    return f"{green} of {len(checks) - expected} checks hold{failures}"


def worst(checks: Iterable[Judged]) -> Judged | None:
    """The check that misses most, or is nearest to its limit; expected failures count only if nothing else is there.

    Round-off does not choose: of checks far inside of their limits, the first one counts.
    """

    def badness(check: Judged) -> tuple[bool, Verdict, float]:
        return check.verdict is not Verdict.EXPECTED, check.verdict, max(round(check.share, 3), 0.01)

    return max(checks, key=badness, default=None)


def worst_sentence(checks: Sequence[Check]) -> str:
    """The check that misses most, or is nearest to its limit."""
    check = worst(checks)
    if check is None:
        return "There is no check."
    what = f"{check.what}: {check.miss}, limit {check.limit}"
    if check.verdict is Verdict.GREEN:
        return f"Nearest to its limit: {what}."
    begin = {Verdict.EXPECTED: "Fails as expected", Verdict.AMBER: "Misses most"}.get(check.verdict, "Fails")
    cause = f" Cause: {check.note}." if check.note else ""
    return f"{begin}: {what}.{cause}"


def _checks(checks: Sequence[Check]) -> list[str]:
    """Checks that miss, expected failures, checks that hold, causes; long tables are folded."""
    notes = list(dict.fromkeys(check.note for check in checks if check.note))
    groups = {
        "Checks that miss": (Verdict.RED, Verdict.AMBER),
        "Expected failures": (Verdict.EXPECTED,),
        "Checks that hold": (Verdict.GREEN,),
    }
    parts = []
    for title, verdicts in groups.items():
        group = [check for check in checks if check.verdict in verdicts]
        if group:
            rows = 0 if Verdict.AMBER in verdicts else len(group)
            parts.append(folded(f"{title}: {len(group)}", _check_table(group, notes), rows))
    if notes:
        causes = "\n".join(f"{number}. {note}" for number, note in enumerate(notes, 1))
        parts.append(f"**Causes**\n\n{causes}")
    return parts


def _check_table(checks: Sequence[Check], notes: Sequence[str]) -> str:
    """Checks as a table; a number in brackets names the cause."""
    rows = [
        (
            *check.cells()[:-1],
            f"{check.verdict.mark} ({notes.index(check.note) + 1})" if check.note else check.cells()[-1],
        )
        for check in checks
    ]
    return markdown_table(("what", "reference", "found", "deviation", "limit", "verdict"), rows)
