"""The page of known defects: checks that miss, by page and cause; expected failures; limits that no check shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from umform_book.checks import Verdict
from umform_book.markdown import folded
from umform_book.outcome import CheckRecord, Outcome
from umform_book.writing import worst

_LIMITS = """\
## Limits that no check shows

* Tools are rigid. A model has one type of element.
* Statics only: no mass, no inertia.
* Penalty contact: a sheet penetrates a tool by pressure / penalty. With a penalty of 1000 E/h and more a run may be
  cut into a hundred increments and more; the automatic penalty is softer.
* A strip 10000 times as long as thick has a condition number above 1e16: Newton's method needs two to three times as
  many iterations, and thinner strips may not converge.
* Air bending: one layer of elements bends more sharply than two or more at the same stroke. Take two layers; their
  angle is some 0.6 degrees smaller than that of a stack of eight ([cause](air-bend-mesh.md)).
* After the onset of necking, or of a plastic hinge without hardening, results depend on the mesh: the laws have no
  internal length.
"""


def errata_text(outcomes: Mapping[str, Outcome]) -> str:
    """Markdown of the page."""
    expected = _by_page(outcomes, (Verdict.EXPECTED,))
    failed = ", ".join(outcome.name for outcome in outcomes.values() if outcome.failure)
    parts = [
        "# Known defects",
        "All checks of the last runs that miss, by page and cause, with the worst of each cause.",
        "## Misses",
        _by_page(outcomes, (Verdict.AMBER, Verdict.RED)) or "None.",
        f"Without a result, because the run failed: {failed}." if failed else "",
        "## Expected failures",
        "Theory predicts that these elements fail these tests. They count as green, and a pass would be amber.",
        folded("All expected failures", expected) if expected else "None.",
        _LIMITS.strip(),
        "[All cases](README.md)",
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def _by_page(outcomes: Mapping[str, Outcome], verdicts: Sequence[Verdict]) -> str:
    """A list of pages; below each, a line for each cause."""
    lines = []
    for outcome in outcomes.values():
        causes: dict[str, list[CheckRecord]] = {}
        for check in outcome.checks:
            if check.verdict in verdicts:
                causes.setdefault(check.note, []).append(check)
        if causes:
            lines.append(f"* [{outcome.name}]({outcome.name}.md)")
            lines += [f"  * {_line(cause, checks)}" for cause, checks in causes.items()]
    return "\n".join(lines)


def _line(cause: str, checks: Sequence[CheckRecord]) -> str:
    """The worst check of a cause, how many there are, and the cause."""
    check = worst(checks)
    assert check is not None
    number = f" (worst of {len(checks)})" if len(checks) > 1 else ""
    return f"{check.what}: {check.miss}, limit {check.limit}{number}." + (
        f" {cause[0].upper()}{cause[1:]}." if cause else ""
    )
