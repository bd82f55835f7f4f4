"""Tools that stay where they are while a sweep varies the thickness of the sheet between them."""

from __future__ import annotations

from umform.errors import UmformError
from umform.model.contact.encounter import sheet_thickness
from umform.problem import Problem
from umform.studies.sweep.plan import Plan

#: Change of a gap over the thickness that is worth a warning.
_LITTLE = 0.01


def tools_stay(plan: Plan) -> str:
    """A warning if the gaps between tools and sheet differ between the thinnest and the thickest sheet; or nothing."""
    name = next((name for name in plan.varied if name.split(".")[-1] == "thickness"), None)
    if name is None:
        return ""
    by_thickness = sorted(plan.jobs, key=lambda number: float(plan.values[number][name]))
    try:
        (thin, least), (thick, most) = (_gaps(plan.jobs[by_thickness[end]].deck) for end in (0, -1))
    except UmformError:  # the job says so itself
        return ""
    changed = [
        f"that of {contact} is {gap:.4g} and {most[contact]:.4g}"
        for contact, gap in least.items()
        if contact in most and abs(gap - most[contact]) > _LITTLE * thick
    ]
    if not changed:
        return ""
    return (
        f"places of tools do not follow the thickness: at {thin:.4g} and {thick:.4g} the gap to the sheet changes, "
        f"{', '.join(changed)}; strokes count from there: vary the places too, as columns of --jobs"
    )


def _gaps(deck: Problem) -> tuple[float, dict[str, float]]:
    """Thickness of the sheet, and the smallest gap of each contact at the start; negative: an overlap."""
    model = deck.build().model
    gaps = {pair.name: float(pair.locate(model.u, pair.pose).gap.min()) for pair in model.contacts}
    return sheet_thickness(model.mesh), {name: round(gap, 9) + 0.0 for name, gap in gaps.items()}
