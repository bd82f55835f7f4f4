"""Air bending: a sheet in a V-die, bent by a punch and unloaded.

`air_bending` runs one bend with a given stroke, `find_stroke` finds the stroke for an angle, `bending_table` gives the
angles for several strokes, `angle_table` the strokes for several angles; `AirBending` holds the parameters.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.processes.air_bending.bend import AirBend
    from umform.processes.air_bending.case import air_bending
    from umform.processes.air_bending.measures import Measures
    from umform.processes.air_bending.search import Found, angle_table, bending_table, find_stroke
    from umform.processes.air_bending.spec import AirBending
    from umform.processes.air_bending.stack import StackedSheet

__all__ = [
    "AirBend",
    "AirBending",
    "Found",
    "Measures",
    "StackedSheet",
    "air_bending",
    "angle_table",
    "bending_table",
    "find_stroke",
]

_HOME = {
    "AirBend": "bend",
    "AirBending": "spec",
    "Found": "search",
    "Measures": "measures",
    "StackedSheet": "stack",
    "air_bending": "case",
    "angle_table": "search",
    "bending_table": "search",
    "find_stroke": "search",
}

# The command line reads the parameters without the run.
__getattr__ = at_first_use(__name__, _HOME)
