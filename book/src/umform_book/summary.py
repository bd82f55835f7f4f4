"""The summary of the book: counts of verdicts and one row per case."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from textwrap import shorten

from umform_book.case import Case, Chapter
from umform_book.checks import Verdict
from umform_book.markdown import markdown_table
from umform_book.outcome import CheckRecord, Outcome
from umform_book.writing import worst

#: Characters of the phrase for the worst check.
_PHRASE = 45
#: A deviation above so many times its limit is printed as such.
_FAR = 10.0

_INTRODUCTION = """\
Every number comes from a run. `make verification` runs all cases, `umform verify NAME` one of them.

* 🟢 All checks are within their limits. Failures that the theory of an element predicts are expected.
* 🟠 A check misses by a known amount; the page names the cause.
* 🔴 A check misses.

Then: [which element should I take?](which-element.md) · [known defects](errata.md) ·
[balance of all nonlinear runs](balance.md)"""


def summary_text(chapters: Sequence[Chapter], outcomes: Mapping[str, Outcome]) -> str:
    """Markdown of the summary."""
    verdicts = [outcome.verdict for outcome in outcomes.values()]
    counts = ", ".join(f"{verdicts.count(v)} {v.mark}" for v in (Verdict.GREEN, Verdict.AMBER, Verdict.RED))
    checks = [check for outcome in outcomes.values() for check in outcome.checks]
    expected = sum(check.verdict is Verdict.EXPECTED for check in checks)
    green = sum(check.verdict is Verdict.GREEN for check in checks)
    parts = [
        "# Verification book",
        f"**{_number(chapters, outcomes)}: {counts}.** {green} of {len(checks) - expected} checks hold; "
        f"{expected} more fail as theory predicts.",
        _INTRODUCTION,
    ]
    for chapter in chapters:
        rows = [_row(case, outcomes[case.name]) for case in chapter.cases if case.name in outcomes]
        if rows:
            table = markdown_table(("case", "", "of limit", "worst check"), rows)
            parts += [f"## {chapter.title}", chapter.about, table]
    used = "; ".join(dict.fromkeys(outcome.versions for outcome in outcomes.values() if outcome.versions))
    parts += ["\\* umform computed the reference or a part of it; the page names the part."]
    parts += [f"Made with {used}."] if used else []
    return "\n\n".join(parts) + "\n"


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
