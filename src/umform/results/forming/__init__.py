"""What forming users read of a part: strains, limits, ears, draw-in, sections, springback, distance from a tool.

All of it follows from the mesh and the displacement, so it can be asked for any frame of any run.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.results.forming.ears import EarProfile, ear_profile
    from umform.results.forming.gauge import Laid, lay_by_best_fit, lay_on_three_points
    from umform.results.forming.limits import FormingLimit, KeelerBrazier, LimitTable, limit_margin
    from umform.results.forming.outline import Outline, draw_in
    from umform.results.forming.sections import Section, section
    from umform.results.forming.strains import SheetStrains, add_forming_fields, forming_fields, sheet_strains
    from umform.results.forming.tool_distance import distance_from
    from umform.results.forming.u_bend import UBendAngles, u_bend_angles

__all__ = [
    "EarProfile",
    "FormingLimit",
    "KeelerBrazier",
    "Laid",
    "LimitTable",
    "Outline",
    "Section",
    "SheetStrains",
    "UBendAngles",
    "add_forming_fields",
    "distance_from",
    "draw_in",
    "ear_profile",
    "forming_fields",
    "lay_by_best_fit",
    "lay_on_three_points",
    "limit_margin",
    "section",
    "sheet_strains",
    "u_bend_angles",
]

_HOME = {
    "EarProfile": "ears",
    "FormingLimit": "limits",
    "KeelerBrazier": "limits",
    "Laid": "gauge",
    "LimitTable": "limits",
    "Outline": "outline",
    "Section": "sections",
    "SheetStrains": "strains",
    "UBendAngles": "u_bend",
    "add_forming_fields": "strains",
    "distance_from": "tool_distance",
    "draw_in": "outline",
    "ear_profile": "ears",
    "forming_fields": "strains",
    "lay_by_best_fit": "gauge",
    "lay_on_three_points": "gauge",
    "limit_margin": "limits",
    "section": "sections",
    "sheet_strains": "strains",
    "u_bend_angles": "u_bend",
}

__getattr__ = at_first_use(__name__, _HOME)
