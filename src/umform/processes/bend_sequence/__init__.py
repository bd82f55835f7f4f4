"""Several bends in one part, each from the state after the previous bend.

`bend_sequence` runs a `BendSequence` of `Bend`; the result is a `Part`.
"""

from umform.processes.bend_sequence.parameters import Bend, BendSequence, Bodies
from umform.processes.bend_sequence.part import BendDone, Part
from umform.processes.bend_sequence.run import bend_sequence

__all__ = ["Bend", "BendDone", "BendSequence", "Bodies", "Part", "bend_sequence"]
