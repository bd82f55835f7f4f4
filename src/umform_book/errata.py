"""The errata page: every check that is known to miss in this run, and the limits that no check can show."""

from __future__ import annotations

from collections.abc import Mapping

from umform_book.checks import Verdict
from umform_book.writing import Outcome, markdown_table

_LIMITS = """\
## Limits that no check shows

* Rigid, frictionless tools; one material and one element type in a model.
* Statics: there is no mass and no inertia.
* Penalty contact: a sheet sinks into a tool by pressure / penalty.
* The plastic law is isotropic: no anisotropy of rolled sheet, no Bauschinger effect in reverse bending.
* With a penalty of 1000 E/h and more a run may be cut a hundred times and more on its way; the automatic
  penalty is softer.
* A strip that is 10000 times as long as thick, of elements 300 times as long as thick, has a condition number above
  1e16: its first touch ends as a singular matrix.
* In air bending one layer of elements bends more sharply than two or more at the same stroke: take two layers. See
  air-bend-mesh for the cause; two layers leave an angle some 0.6 degrees smaller than a stack of eight does.
* Results after the onset of necking or of a plastic hinge without hardening depend on the mesh: the law has no length.
"""


def errata_text(outcomes: Mapping[str, Outcome]) -> str:
    """Markdown of the page."""
    rows = [
        (f"[{outcome.name}]({outcome.name}.md)", check.what, check.cells()[3], check.cells()[4], check.cause)
        for outcome in outcomes.values()
        for check in outcome.checks
        if check.verdict is not Verdict.GREEN
    ]
    parts = [
        "# Known defects",
        "Every check of the last run that missed what was expected of it, with its cause where it is known. What is "
        "not in this table was within its tolerance.",
        markdown_table(("case", "what", "deviation", "expected within", "cause"), rows) if rows else "None.",
        _LIMITS,
        "[All cases](README.md)",
    ]
    return "\n\n".join(parts) + "\n"
