"""Parameters and measures of a draw bead as text: for the terminal, the report and files."""

from __future__ import annotations

from typing import Any

from umform.elements import element
from umform.processes.draw_bead.measures import QUANTITIES, Drawn


def parameters(drawn: Drawn) -> dict[str, Any]:
    """Parameters with their defaults; the material as text."""
    case = drawn.case
    found = {"groove": case.width, "gap": case.air, "draw": case.way}
    return case.record() | found | {"element": element(case.element).name, "material": repr(case.material)}


def summary(drawn: Drawn) -> list[list[str]]:
    """Rows of all measures: label, value, unit; forces first, extrapolated if possible."""
    of_mesh = "" if drawn.limits is None else ", finest mesh"
    rows = []
    if drawn.limits is not None:
        for name, limit in (("restraint", drawn.limits.restraint), ("uplift", drawn.limits.uplift)):
            label, unit, digits = QUANTITIES[name]
            rows.append([label, f"{limit.value:.{digits}f}", unit])
            if limit.error is not None:
                rows.append(["its estimated error", f"{limit.error:.{digits}f}", unit])
    for name, (label, unit, digits) in QUANTITIES.items():
        of = of_mesh if name in ("restraint", "uplift") else ""
        rows.append([label + of, f"{getattr(drawn, name):.{digits}f}", unit])
    return rows
