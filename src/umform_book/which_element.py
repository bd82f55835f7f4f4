"""The page "Which element should I take?": how fine a mesh each element needs, read off the studies of all cases."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from umform_book.checks import Verdict
from umform_book.page import StudyRecord
from umform_book.writing import Outcome, markdown_table

#: Error that counts as good enough, as a fraction.
ENOUGH = 0.05


@dataclass(frozen=True)
class Advice:
    """What to take for something, and what says so.

    Attributes
    ----------
    purpose, take : str
        What is computed, and with what.
    labels : sequence of str
        Elements that are compared: the one to take, then another that one might.
    speaks : callable
        Whether a study tells something about it.
    cases : sequence of str
        Pages whose checks are about it.
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
        "`MI9K3DEAS`, `tie_E33=True`, 3 x 3 contact points at least",
        ("MI9K3DEAS, E_33 tied", "ANS3DEAS, E_33 tied"),
        _of_shells,
    ),
    Advice(
        "a sharp bend, radius below some ten thicknesses",
        "`BEND8` (length h/2, two elements over the width) or `BEND18` (length h to 2 h)",
        cases=("bend-hinge", "bend-small-cylinders", "bend-meshes"),
    ),
    Advice(
        "springback, of a mild bend above all",
        "any element with its defaults: complete order, 12 `graded` points; with `thickness_order=1` or 5 points it "
        "errs by 20 to 100 %",
        cases=("bend-springback", "material-bending"),
    ),
    Advice(
        "a sheet squeezed hard through its thickness",
        "`tie_E33=False`",
        cases=("bend-stability",),
    ),
    Advice(
        "a sheet that bends in its own plane, elastic",
        "`EAS3DEAS`, `tie_E33=True`",
        ("EAS3DEAS, E_33 tied", "ANS3DEAS, E_33 tied"),
        _in_the_plane,
    ),
    Advice(
        "plastic flow in plane strain, strains above 0.1",
        "`MI9K3DEAS`; `EAS3DEAS` is not stable there, `ANS3DEAS` is stiff",
        ("MI9K3DEAS", "ANS3DEAS"),
        _plastic_in_plane_strain,
        ("plastic-necking",),
    ),
    Advice("locking, to see what it is", "`DISP3D`, `DISP9K3D`", ("DISP3D", "DISP9K3D"), _of_shells),
)


def which_element_text(outcomes: Mapping[str, Outcome]) -> str:
    """Markdown of the page."""
    studies = [study for outcome in outcomes.values() for study in outcome.studies]
    labels = list(dict.fromkeys(label for study in studies for label in study.values))
    rows = [
        (f"[{study.case}]({study.case}.md): {study.title}", *(_needed(study, label) for label in labels))
        for study in studies
    ]
    rows.append(("**problems met / tried**", *(_met(studies, label) for label in labels)))
    parts = [
        "# Which element should I take?",
        markdown_table(
            ("you compute", "take", "because"),
            [(advice.purpose, advice.take, _because(advice, studies, outcomes)) for advice in ADVICE],
        ),
        f"*Because* counts, of the problems below that tell something about it, those in which an element comes within "
        f"{100 * ENOUGH:g} %, and the intervals that it needs for that: their median.",
        "Tie E_33 wherever the sheet is curved or becomes so: on coarse curved meshes it decides.",
        "## How fine a mesh each element needs",
        f"Intervals between nodes along an edge from which on the error stays below {100 * ENOUGH:g} %, over the "
        "meshes of each case (`> 32`: not even with 32). 18-node elements have half as many elements as intervals.",
        markdown_table(("problem", *labels), rows),
        "[All cases](README.md)",
    ]
    return "\n\n".join(parts) + "\n"


def _because(advice: Advice, studies: Sequence[StudyRecord], outcomes: Mapping[str, Outcome]) -> str:
    """How many problems each element meets, and from how many intervals on; how many checks of pages are green."""
    parts = []
    told = [s for s in studies if advice.speaks(s) and all(s.values.get(label) for label in advice.labels)]
    for label in advice.labels:
        needed = [_needed(study, label) for study in told]
        met = [int(intervals) for intervals in needed if not intervals.startswith(">")]
        if needed:
            intervals = f", {statistics.median(met):g} intervals" if met else ""
            parts.append(f"{label}: {len(met)} of {len(needed)}{intervals}")
    for case in (case for case in advice.cases if case in outcomes):
        checks = outcomes[case].checks
        green = sum(check.verdict is Verdict.GREEN for check in checks)
        parts.append(f"[{case}]({case}.md): {green} of {len(checks)} checks green")
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
