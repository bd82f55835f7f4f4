"""The summary of the book: measurements first, then what misses, then a folded table of cases per chapter."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from textwrap import shorten

from umform_book.case import Case, Chapter
from umform_book.checks import Verdict
from umform_book.markdown import folded, markdown_table
from umform_book.outcome import CheckRecord, Outcome
from umform_book.page import Comparison
from umform_book.writing import worst

#: Characters of the phrase for the worst check, and for the cause of a miss.
_PHRASE, _CAUSE = 45, 110
#: A deviation above so many times its limit is printed as such.
_FAR = 10.0
_COLUMNS = ("case", "", "of limit", "worst check")
_ORDER = (Verdict.GREEN, Verdict.AMBER, Verdict.RED)
_SIGNS = [verdict.mark.split()[0] for verdict in _ORDER]

_INTRODUCTION = """\
Every number comes from a run. `make verification` runs all cases, `umform verify NAME` one of them.

* 🟢 All checks are within their limits. Failures that the theory of an element predicts are expected.
* 🟠 A check misses by a known amount; the page names the cause.
* 🔴 A check misses.

*Of limit*: deviation of the worst check over its limit.

Then: [which element should I take?](which-element.md) · [known defects](errata.md) ·
[balance of all nonlinear runs](balance.md)"""


def summary_text(chapters: Sequence[Chapter], outcomes: Mapping[str, Outcome]) -> str:
    """Markdown of the summary."""
    verdicts = [outcome.verdict for outcome in outcomes.values()]
    counts = ", ".join(f"{verdicts.count(verdict)} {verdict.mark}" for verdict in _ORDER)
    checks = [check for outcome in outcomes.values() for check in outcome.checks]
    expected = sum(check.verdict is Verdict.EXPECTED for check in checks)
    green = sum(check.verdict is Verdict.GREEN for check in checks)
    parts = [
        "# Verification book",
        f"**{_number(chapters, outcomes)}: {counts}.** {green} of {len(checks) - expected} checks hold; "
        f"{expected} more fail as theory predicts.",
        _INTRODUCTION,
    ]
    misses = _misses(chapters, outcomes)
    for chapter in chapters:
        found = {case: outcomes[case.name] for case in chapter.cases if case.name in outcomes}
        if found:
            table = markdown_table(_COLUMNS, [_row(case, outcome) for case, outcome in found.items()])
            title = f"{_counts(found.values())}: all cases"
            parts += [
                f"## {chapter.title}",
                chapter.about,
                *_measured(chapter, outcomes),
                folded(title, table),
                *misses,
            ]
            misses = []  # behind the first chapter
    used = "; ".join(dict.fromkeys(outcome.versions for outcome in outcomes.values() if outcome.versions))
    parts += ["\\* umform computed the reference or a part of it; the page names the part."]
    parts += [f"Made with {used}."] if used else []
    return "\n\n".join(parts) + "\n"


def _counts(outcomes: Iterable[Outcome]) -> str:
    """Counts of the verdicts that there are."""
    signs = [outcome.verdict.mark.split()[0] for outcome in outcomes]
    return ", ".join(f"{signs.count(sign)} {sign}" for sign in dict.fromkeys(sorted(signs, key=_SIGNS.index)))


def _misses(chapters: Sequence[Chapter], outcomes: Mapping[str, Outcome]) -> list[str]:
    """Rows of the cases that are not green, with their causes, the farthest from its limit first."""
    cases = [case for chapter in chapters for case in chapter.cases if case.name in outcomes]
    missed = [case for case in cases if outcomes[case.name].verdict is not Verdict.GREEN]
    if not missed:
        return []
    checks = {case.name: worst(outcomes[case.name].checks) for case in missed}
    missed.sort(key=lambda case: -(check.share if (check := checks[case.name]) else math.inf))
    rows = [
        (*_row(case, outcomes[case.name]), shorten(check.note if check else "", _CAUSE, placeholder=" ..."))
        for case, check in ((case, checks[case.name]) for case in missed)
    ]
    return ["## What misses", markdown_table((*_COLUMNS, "cause"), rows)]


def _measured(chapter: Chapter, outcomes: Mapping[str, Outcome]) -> list[str]:
    """The numbers of a chapter beside their measurements."""
    rows = [
        ("" if number else f"[{case.title}]({case.name}.md)", *one.row)
        for case in chapter.cases
        if case.name in outcomes
        for number, one in enumerate(outcomes[case.name].comparisons)
    ]
    return [markdown_table(("case", *Comparison.COLUMNS), rows)] if rows else []


def _number(chapters: Sequence[Chapter], outcomes: Mapping[str, Outcome]) -> str:
    """How many cases there are, and how many of them have been run."""
    number = sum(len(chapter.cases) for chapter in chapters)
    cases = f"{number} case{'s' * (number > 1)}"
    return cases if len(outcomes) == number else f"{len(outcomes)} of {cases}"


def _row(case: Case, outcome: Outcome) -> tuple[str, str, str, str]:
    name = f"[{case.title}]({case.name}.md)" + (" \\*" if case.own else "")
    sign = outcome.verdict.mark.split()[0]
    if outcome.failure:
        return name, sign, "-", outcome.failure.splitlines()[0]
    check = worst(outcome.checks)
    if check is None:
        return name, sign, "-", "no check"
    return name, sign, _share(check), shorten(check.what, _PHRASE, placeholder=" ...").replace("|", "/")


def _share(check: CheckRecord) -> str:
    """Deviation over its limit."""
    if check.share > _FAR:
        return f"> {100 * _FAR:.0f} %"
    return f"{100 * check.share:.0f} %" if check.share >= 0.01 else "< 1 %"
