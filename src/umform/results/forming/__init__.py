"""What forming users read of a part: strains, limits, ears, draw-in, forces, sections, springback, tool distances.

All of it follows from the mesh and the displacement, so it can be asked for any frame of any run.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.results.forming.ears import NUMBER_OF_EARS, EarProfile, ear_profile
    from umform.results.forming.effective_strain import EffectiveStrain
    from umform.results.forming.gauge import Laid, lay_by_best_fit, lay_on_three_points
    from umform.results.forming.largest import BY_PATHS, BY_STRAINS, MARGIN, THINNING, extremes
    from umform.results.forming.legs import Leg, angle_between
    from umform.results.forming.limits import FormingLimit, KeelerBrazier, LimitTable, limit_margin
    from umform.results.forming.outline import Outline, draw_in
    from umform.results.forming.passage import LargestForce, largest_force, longest_element
    from umform.results.forming.path_limits import PathFields, PathLimit
    from umform.results.forming.paths import StrainPaths, strain_paths
    from umform.results.forming.sections import Section, section
    from umform.results.forming.strains import SheetStrains, add_forming_fields, forming_fields, sheet_strains
    from umform.results.forming.tool_distance import distance_from
    from umform.results.forming.u_bend import UBendAngles, u_bend_angles

__all__ = [
    "BY_PATHS",
    "BY_STRAINS",
    "MARGIN",
    "NUMBER_OF_EARS",
    "THINNING",
    "EarProfile",
    "EffectiveStrain",
    "FormingLimit",
    "KeelerBrazier",
    "Laid",
    "LargestForce",
    "Leg",
    "LimitTable",
    "Outline",
    "PathFields",
    "PathLimit",
    "Section",
    "SheetStrains",
    "StrainPaths",
    "UBendAngles",
    "add_forming_fields",
    "angle_between",
    "distance_from",
    "draw_in",
    "ear_profile",
    "extremes",
    "forming_fields",
    "largest_force",
    "lay_by_best_fit",
    "lay_on_three_points",
    "limit_margin",
    "longest_element",
    "section",
    "sheet_strains",
    "strain_paths",
    "u_bend_angles",
]

_HOME = {
    "BY_PATHS": "largest",
    "BY_STRAINS": "largest",
    "MARGIN": "largest",
    "NUMBER_OF_EARS": "ears",
    "THINNING": "largest",
    "EarProfile": "ears",
    "EffectiveStrain": "effective_strain",
    "FormingLimit": "limits",
    "KeelerBrazier": "limits",
    "Laid": "gauge",
    "LargestForce": "passage",
    "Leg": "legs",
    "LimitTable": "limits",
    "Outline": "outline",
    "PathFields": "path_limits",
    "PathLimit": "path_limits",
    "Section": "sections",
    "SheetStrains": "strains",
    "StrainPaths": "paths",
    "UBendAngles": "u_bend",
    "add_forming_fields": "strains",
    "angle_between": "legs",
    "distance_from": "tool_distance",
    "draw_in": "outline",
    "ear_profile": "ears",
    "extremes": "largest",
    "forming_fields": "strains",
    "largest_force": "passage",
    "lay_by_best_fit": "gauge",
    "lay_on_three_points": "gauge",
    "limit_margin": "limits",
    "longest_element": "passage",
    "section": "sections",
    "sheet_strains": "strains",
    "strain_paths": "paths",
    "u_bend_angles": "u_bend",
}

__getattr__ = at_first_use(__name__, _HOME)
