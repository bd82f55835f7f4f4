"""Parameters of a draw bead as text, for the report and files."""

from __future__ import annotations

from typing import Any

from umform.elements import element
from umform.materials.laws import full_text
from umform.processes.draw_bead.measures import Drawn


def parameters(drawn: Drawn) -> dict[str, Any]:
    """Parameters with their defaults; the material as text."""
    case = drawn.case
    found: dict[str, Any] = {"groove": case.width, "gap": case.air, "draw": case.way}
    found |= {"element": element(case.element).name, "material": full_text(case.material)}
    return case.record() | found | {"newton": vars(case.newton), "pace": vars(case.pace)}
