"""Parameters and measures of a draw bead in words: for the terminal, the report and files."""

from __future__ import annotations

from typing import Any

from umform.elements import element
from umform.processes.draw_bead.measures import QUANTITIES, Drawn


def parameters(drawn: Drawn) -> dict[str, Any]:
    """Parameters with what follows where they were left out; the material in words."""
    case = drawn.case
    found = {"groove": case.width, "gap": case.air, "draw": case.way}
    return case.record() | found | {"element": element(case.element).name, "material": repr(case.material)}


def summary(drawn: Drawn) -> list[list[str]]:
    """Rows of all measures: label, value, unit."""
    rows = [[label, f"{getattr(drawn, name):.{digits}f}", unit] for name, (label, unit, digits) in QUANTITIES.items()]
    if drawn.limits is not None:
        for label, limit in (("restraining force", drawn.limits.restraint), ("uplift force", drawn.limits.uplift)):
            rows.append([f"{label}, extrapolated", f"{limit.value:.1f}", "N/mm"])
            rows.append(["what the mesh is above it", f"{100.0 * limit.off:.1f}", "%"])
    return rows
