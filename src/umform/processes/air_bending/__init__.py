"""Air bending: a sheet in a V-die, bent by a punch and unloaded.

`air_bending` runs one bend with a given stroke, `find_stroke` finds the stroke for an angle, `bending_table` gives the
angles for several strokes; `AirBending` holds the parameters.
"""

from umform.processes.air_bending.bend import AirBend
from umform.processes.air_bending.case import air_bending
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.parameters import AirBending
from umform.processes.air_bending.search import Found, bending_table, find_stroke

__all__ = ["AirBend", "AirBending", "Found", "Measures", "air_bending", "bending_table", "find_stroke"]
