"""The page "Which element should I take?": recommendations, and how fine a mesh each element needs."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from umform_book.checks import Verdict
from umform_book.markdown import folded, markdown_table
from umform_book.outcome import Outcome
from umform_book.page import StudyRecord

#: Error that counts as good enough, as a fraction.
ENOUGH = 0.05


@dataclass(frozen=True)
class Advice:
    """A recommendation and its evidence.

    Attributes
    ----------
    purpose, take : str
        What is computed, and with what.
    labels : sequence of str
        Elements to compare: the recommended one first.
    speaks : callable
        Whether a study is evidence.
    cases : sequence of str
        Pages whose checks are evidence.
    """

    purpose: str
    take: str
    labels: Sequence[str] = ()
    speaks: Callable[[StudyRecord], bool] = lambda study: False
    cases: Sequence[str] = ()


_SHELLS = ("circular-plate", "scordelis-lo", "pinched-cylinder", "linear-hemisphere")


def _of_shells(study: StudyRecord) -> bool:
    return study.case in _SHELLS or study.case.startswith("nonlinear-")


def _in_the_plane(study: StudyRecord) -> bool:
    return study.case == "cook-membrane" or "in-plane" in study.title


def _plastic_in_plane_strain(study: StudyRecord) -> bool:
    return study.case in ("plastic-tube", "plastic-cook")


ADVICE = (
    Advice(
        "a sheet over a tool, radius many times the thickness",
        "`ANS3DEAS`, `tie_E33=True`, two elements over the width",
        ("ANS3DEAS, E_33 tied", "ANS3DEAS"),
        _of_shells,
    ),
    Advice(
        "the same on few elements",
        "`MI9K3DEAS`, `tie_E33=True`, at least 3 x 3 contact points",
        ("MI9K3DEAS, E_33 tied", "ANS3DEAS, E_33 tied"),
        _of_shells,
    ),
    Advice(
        "a sharp bend, radius below some ten thicknesses",
        "`BEND18` (length h to 2 h) or `BEND8` (length h/2, two elements over the width)",
        cases=("bend-hinge", "bend-small-cylinders", "bend-meshes"),
    ),
    Advice(
        "springback, above all of a mild bend",
        "any element with its defaults (complete order, `staggered` points); `thickness_order=1` or 5 points err by "
        "20 to 100 %",
        cases=("bend-springback", "material-bending"),
    ),
    Advice(
        "a sheet under high pressure through its thickness",
        "`tie_E33=False`",
        cases=("bend-stability",),
    ),
    Advice(
        "elastic bending in the plane of the sheet",
        "`EAS3DEAS`, `tie_E33=True`",
        ("EAS3DEAS, E_33 tied", "ANS3DEAS, E_33 tied"),
        _in_the_plane,
    ),
    Advice(
        "plastic flow in plane strain, strains above 0.1",
        "`MI9K3DEAS`; `EAS3DEAS` is unstable there, `ANS3DEAS` too stiff",
        ("MI9K3DEAS", "ANS3DEAS"),
        _plastic_in_plane_strain,
        ("plastic-necking",),
    ),
    Advice("locking, as a demonstration", "`DISP3D`, `DISP9K3D`", ("DISP3D", "DISP9K3D"), _of_shells),
)

#: What a researcher takes for a problem of their own.
_RESEARCHER = "MI9K3DEAS, E_33 tied"

_ENGINEER = """\
**Process engineer:** keep the element of the command. `umform bend` takes `BEND18` in two layers, for mild and sharp
bends and their springback ([air bending](air-bend-mesh.md))."""


def which_element_text(outcomes: Mapping[str, Outcome]) -> str:
    """Markdown of the page."""
    studies = [study for outcome in outcomes.values() for study in outcome.studies]
    labels = list(dict.fromkeys(label for study in studies for label in study.values))
    rows = [
        (f"[{study.case}]({study.case}.md): {study.title}", *(_needed(study, label) for label in labels))
        for study in studies
    ]
    rows.append(("**problems met / tried**", *(_met(studies, label) for label in labels)))
    advice = [(advice.purpose, advice.take, _because(advice, studies, outcomes)) for advice in ADVICE]
    legend = (
        f"*Because*: in how many of the problems below an element comes within {100 * ENOUGH:g} %, and the median of "
        "the intervals that it needs. Tie E_33 wherever the sheet is or becomes curved: it decides on coarse meshes."
    )
    meshes = (
        f"Intervals between nodes along an edge from which on the error stays below {100 * ENOUGH:g} % (`> 32`: not "
        "with 32). 18-node elements have half as many elements as intervals."
    )
    parts = [
        "# Which element should I take?",
        _ENGINEER,
        f"**Researcher:** take `MI9K3DEAS` with `tie_E33=True`. It comes within {100 * ENOUGH:g} % in "
        f"{_met(studies, _RESEARCHER).replace('/', 'of')} problems, on coarse meshes, and it is stable in plastic "
        "flow.",
        "## For a particular problem",
        folded("Element by problem", f"{markdown_table(('you compute', 'take', 'because'), advice)}\n\n{legend}"),
        "## How fine a mesh each element needs",
        folded("All problems, all elements", f"{meshes}\n\n{markdown_table(('problem', *labels), rows)}"),
        "[All cases](README.md)",
    ]
    return "\n\n".join(parts) + "\n"


def _because(advice: Advice, studies: Sequence[StudyRecord], outcomes: Mapping[str, Outcome]) -> str:
    """How many problems each element meets, and from how many intervals on; how many checks of pages hold."""
    parts = []
    speaking = [s for s in studies if advice.speaks(s) and all(s.values.get(label) for label in advice.labels)]
    for label in advice.labels:
        needed = [_needed(study, label) for study in speaking]
        met = [int(intervals) for intervals in needed if not intervals.startswith(">")]
        if needed:
            intervals = f", {statistics.median(met):g} intervals" if met else ""
            parts.append(f"{label}: {len(met)} of {len(needed)}{intervals}")
    for case in (case for case in advice.cases if case in outcomes):
        checks = [check for check in outcomes[case].checks if check.verdict is not Verdict.EXPECTED]
        green = sum(check.verdict is Verdict.GREEN for check in checks)
        parts.append(f"[{case}]({case}.md): {green} of {len(checks)} checks hold")
    return "; ".join(parts)


def _needed(study: StudyRecord, label: str) -> str:
    """The coarsest mesh from which on all errors are small."""
    row = study.values.get(label)
    if not row:
        return "-"
    needed: int | None = None
    for divisions in sorted(row, reverse=True):
        if not abs(row[divisions] - 1.0) <= ENOUGH:
            break
        needed = divisions
    return f"> {max(row)}" if needed is None else str(needed)


def _met(studies: list[StudyRecord], label: str) -> str:
    asked = [_needed(study, label) for study in studies if label in study.values]
    return f"{sum(not needed.startswith('>') for needed in asked)} / {len(asked)}"
