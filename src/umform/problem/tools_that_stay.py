"""Tools that stay where they are while the thickness of the sheet between them changes."""

from __future__ import annotations

from collections.abc import Iterator

from umform.errors import UmformError
from umform.model.contact.encounter import sheet_thickness
from umform.problem.findings import Finding, warning
from umform.problem.problem import Problem

#: Change of a gap over the thickness that is worth a warning.
_LITTLE = 0.01


def tools_stay(one: Problem, other: Problem) -> str:
    """Gaps between tools and sheet that differ in two decks of other thickness, as text; empty without any.

    Parameters
    ----------
    one, other : Problem
        The decks; if one of them cannot be built, nothing is said.
    """
    try:
        (thin, before), (thick, after) = _gaps(one), _gaps(other)
    except UmformError:  # its own check or run says so
        return ""
    changed = [
        f"that of {contact} is {gap:.4g} and {after[contact]:.4g}"
        for contact, gap in before.items()
        if contact in after and abs(gap - after[contact]) > _LITTLE * thick
    ]
    if thin == thick or not changed:
        return ""
    return (
        f"places of tools do not follow the thickness: at {thin:.4g} and {thick:.4g} the gap to the sheet changes, "
        f"{', '.join(changed)}; strokes count from there"
    )


def changed_thickness(deck: Problem) -> Iterator[Finding]:
    """Warn if a changed thickness of a deck leaves its tools behind."""
    changes = deck.source.changes
    thickness = {key for key in changes if key.split(".")[-1] == "thickness"}
    if not thickness:
        return
    source = deck.source
    others = {key: value for key, value in changes.items() if key not in thickness and key.split(".")[0] != "tools"}
    written = Problem.read(source.text, source.name, source.folder, others, source.trust)
    if text := tools_stay(written, deck):
        yield warning("thickness", text, "change the places of the tools too")


def _gaps(deck: Problem) -> tuple[float, dict[str, float]]:
    """Thickness of the sheet, and for each contact its smallest gap at the start (negative: overlap)."""
    model = deck.build().model
    gaps = {pair.name: float(pair.locate(model.u, pair.pose).gap.min()) for pair in model.contacts}
    return sheet_thickness(model.mesh), {name: round(gap, 9) + 0.0 for name, gap in gaps.items()}
