"""What forming users read of a part: strains, limits, ears, draw-in, forces, sections, springback, tool distances.

All of it follows from the mesh and the displacement, so it can be asked for any frame of any run.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.results.forming.ears import NUMBER_OF_EARS, EarProfile, ear_profile
    from umform.results.forming.gauge import Laid, lay_by_best_fit, lay_on_three_points
    from umform.results.forming.limits import FormingLimit, KeelerBrazier, LimitTable, limit_margin
    from umform.results.forming.outline import Outline, draw_in
    from umform.results.forming.passage import LargestForce, largest_force, longest_element
    from umform.results.forming.sections import Section, section
    from umform.results.forming.strains import SheetStrains, add_forming_fields, forming_fields, sheet_strains
    from umform.results.forming.tool_distance import distance_from
    from umform.results.forming.u_bend import UBendAngles, u_bend_angles

__all__ = [
    "NUMBER_OF_EARS",
    "EarProfile",
    "FormingLimit",
    "KeelerBrazier",
    "Laid",
    "LargestForce",
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
    "largest_force",
    "lay_by_best_fit",
    "lay_on_three_points",
    "limit_margin",
    "longest_element",
    "section",
    "sheet_strains",
    "u_bend_angles",
]

_HOME = {
    "NUMBER_OF_EARS": "ears",
    "EarProfile": "ears",
    "FormingLimit": "limits",
    "KeelerBrazier": "limits",
    "Laid": "gauge",
    "LargestForce": "passage",
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
    "largest_force": "passage",
    "lay_by_best_fit": "gauge",
    "lay_on_three_points": "gauge",
    "limit_margin": "limits",
    "longest_element": "passage",
    "section": "sections",
    "sheet_strains": "strains",
    "u_bend_angles": "u_bend",
}

__getattr__ = at_first_use(__name__, _HOME)
