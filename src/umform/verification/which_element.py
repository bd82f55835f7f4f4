"""The page "Which element should I take?": how fine a mesh each element needs, read off the studies of all cases."""

from __future__ import annotations

from collections.abc import Mapping

from umform.verification.page import StudyRecord
from umform.verification.writing import Outcome, markdown_table

#: Error that counts as good enough, as a fraction.
ENOUGH = 0.05

_ADVICE = (
    ("a sheet over a tool, radius many times the thickness", "`ANS3DEAS`, `tie_E33=True`, two elements over the width"),
    ("the same on few elements", "`MI9K3DEAS`, `tie_E33=True`, 3 x 3 contact points at least"),
    (
        "a sharp bend, radius below some ten thicknesses",
        "`BEND8` (length h/2, two elements over the width) or `BEND18` (length h to 2 h), 12 `split` points: "
        "[advice](bend-hinge.md), [small cylinders](bend-small-cylinders.md), [meshes](bend-meshes.md)",
    ),
    ("a sheet squeezed hard through its thickness", "`tie_E33=False`: see [stability](bend-stability.md)"),
    ("a sheet that bends in its own plane, elastic", "`EAS3DEAS`, `tie_E33=True`"),
    (
        "plastic flow in plane strain, strains above 0.1",
        "`MI9K3DEAS`; `EAS3DEAS` is not stable there, `ANS3DEAS` is stiff",
    ),
    ("locking, to see what it is", "`DISP3D`, `DISP9K3D`"),
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
        markdown_table(("you compute", "take"), _ADVICE),
        "Tie E_33 wherever the sheet is curved or becomes so: on coarse curved meshes it decides.",
        "## How fine a mesh each element needs",
        f"Intervals between nodes along an edge from which on the error stays below {100 * ENOUGH:g} %, over the "
        "meshes of each case (`> 32`: not even with 32). 18-node elements have half as many elements as intervals.",
        markdown_table(("problem", *labels), rows),
        "[All cases](README.md)",
    ]
    return "\n\n".join(parts) + "\n"


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
