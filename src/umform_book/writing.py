"""The book as Markdown: a page for each case, and the summary that all pages hang on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from umform.io.atomic import PendingFile
from umform.report.versions import versions
from umform_book.balance import BalanceRow
from umform_book.case import Case, Chapter
from umform_book.checks import Check, Verdict
from umform_book.newton_order import LOW, REASONS
from umform_book.page import Page, StudyRecord


@dataclass(frozen=True)
class Outcome:
    """What is left of a page once it is written; can be sent from process to process.

    Attributes
    ----------
    name : str
        The case.
    verdict : Verdict
        Its verdict.
    checks : tuple of Check
        Its checks.
    balances : tuple of BalanceRow
        Balance of each nonlinear run.
    studies : tuple of StudyRecord
        Numbers of each element on each mesh.
    seconds : float
        How long it took.
    failure : str
        Why it has no page, or is cut short.
    """

    name: str
    verdict: Verdict
    checks: tuple[Check, ...] = ()
    balances: tuple[BalanceRow, ...] = ()
    studies: tuple[StudyRecord, ...] = ()
    seconds: float = 0.0
    failure: str = ""


def write_text(path: Path, text: str) -> None:
    """Write a file, whole or not at all."""
    with PendingFile(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def page_text(page: Page) -> str:
    """Markdown of a page."""
    case = page.case
    parts = [
        f"# {case.title}",
        f"Verdict: **{page.verdict.mark}** · made by `umform verify {case.name}`",
        "## Problem",
        case.problem.strip(),
        "## Reference",
        case.reference.strip(),
        *own_reference(case),
        "## What came out",
        *page.blocks,
        "## Checks",
        markdown_table(
            ("what", "reference", "found", "deviation", "expected within", "verdict"),
            [check.cells() for check in page.checks],
        ),
    ]
    if page.balances:
        parts += ["## Balance", _BALANCE, balance_table(page.balances)]
    return "\n\n".join(parts) + "\n\n[All cases](README.md)\n"


def own_reference(case: Case) -> list[str]:
    """The sentence that says what of the reference is umform's own."""
    return [f"**Own reference:** {case.own}."] if case.own else []


def failed_text(case: Case, said: str) -> str:
    """Markdown of the page of a case that could not be run to its end."""
    mark = Verdict.RED.mark
    return (
        f"# {case.title}\n\nVerdict: **{mark}** · the run of `umform verify {case.name}` failed:\n\n```\n{said}\n```\n"
    )


_BALANCE = (
    "External work against stored, dissipated and contact energy (largest drift over the largest energy; where a sheet "
    "begins inside of a tool, from the first equilibrium on, since it springs off the tool before); resultant "
    "of all external forces and moments over the sum of their sizes; order of Newton's method: median of the order of "
    "the last steps, over so many increments as have enough iterations to tell one (in brackets). The last column says "
    f"how many increments have an order below {LOW:g}, by what was recorded in their last two steps. Orders far above "
    "2 belong to problems that are linear but for contact: once the active set is right, one step lands on the answer. "
    "Reasons: " + "; ".join(f"*{word}*: {meaning}" for word, meaning in REASONS.items()) + "."
)


def balance_table(rows: Sequence[BalanceRow], with_case: bool = False) -> str:
    """Balances as a table."""
    columns = ("run", "increments", "iterations", "drift", "force", "moment", "order of Newton", "low, and why")
    cells = [
        (
            f"[{row.case}]({row.case}.md): {row.run}" if with_case else row.run,
            str(row.increments),
            str(row.iterations),
            f"{row.drift:.1e}",
            f"{row.force:.1e}",
            f"{row.moment:.1e}",
            "-" if row.newton.order is None else f"{row.newton.order:.2f} ({row.newton.measured})",
            row.newton.why(),
        )
        for row in rows
    ]
    return markdown_table(columns, cells)


def summary_text(chapters: Sequence[Chapter], outcomes: Mapping[str, Outcome]) -> str:
    """Markdown of the summary: the verdict of every case, and the balances of all nonlinear runs."""
    found = [outcome for outcome in outcomes.values() if not outcome.failure]
    count = {verdict: sum(outcome.verdict is verdict for outcome in outcomes.values()) for verdict in Verdict}
    parts = [
        "# Verification book",
        _INTRODUCTION,
        f"**{len(outcomes)} cases: " + ", ".join(f"{number} {v.mark}" for v, number in count.items()) + f"**; "
        f"{sum(len(outcome.checks) for outcome in found)} checks. "
        f"They took {sum(outcome.seconds for outcome in found) / 60:.0f} minutes, one after the other.",
    ]
    for chapter in chapters:
        rows = [_summary_row(case, outcomes[case.name]) for case in chapter.cases if case.name in outcomes]
        if rows:
            parts += [
                f"## {chapter.title}",
                chapter.about,
                markdown_table(("case", "verdict", "checks", "worst"), rows),
            ]
    balances = [row for outcome in found for row in outcome.balances]
    if balances:
        parts += ["## Balance of all nonlinear runs", _BALANCE, balance_table(balances, with_case=True)]
    made_with = {name: version for name, version in versions().items() if name != "platform"}
    parts += ["Made with " + ", ".join(f"{name} {version}" for name, version in made_with.items()) + "."]
    return "\n\n".join(parts) + "\n"


_INTRODUCTION = """\
Every number on these pages comes from a run: `make verification` runs all cases and writes all pages anew,
`umform verify` lists the cases, `umform verify NAME` runs one. **Green**: all checks are within what is expected of the
element on that mesh. **Amber**: a check misses by no more than is known, and the page says why. **Red**: it misses. An
amber is not a green that was talked up: read the cause before you use that element there. **Own reference**: umform has
computed the reference, or a part of it, itself, on a finer mesh or with another element; the page says which part.

[Which element should I take?](which-element.md) is drawn from these tables, [known defects](errata.md) are kept
honest."""


def _summary_row(case: Case, outcome: Outcome) -> tuple[str, ...]:
    name = f"[{case.title}]({case.name}.md)" + (" · own reference" if case.own else "")
    if outcome.failure:
        return name, Verdict.RED.mark, "-", outcome.failure.splitlines()[0]
    green = sum(check.verdict is Verdict.GREEN for check in outcome.checks)
    worst = max(outcome.checks, key=_badness, default=None)
    said = "no check" if worst is None else f"{worst.what}: {worst.cells()[3]} ({worst.cells()[4]} expected)"
    return name, outcome.verdict.mark, f"{green} of {len(outcome.checks)} green", said


def _badness(check: Check) -> tuple[Verdict, float]:
    """How far a check is off, in parts of what is expected of it; one that must be exact counts as none where it is."""
    parts = abs(check.deviation) / check.within if check.within > 0.0 else float(check.deviation != 0.0)
    return check.verdict, parts


def markdown_table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [tuple(columns), ("---",) * len(columns), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
