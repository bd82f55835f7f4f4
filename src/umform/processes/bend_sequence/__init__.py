"""Several bends in one part, each from the state after the previous bend.

`bend_sequence` runs a `BendSequence` of `Bend`; the result is a `Part`.
"""

from umform.processes.bend_sequence.part import BendDone, Part
from umform.processes.bend_sequence.run import bend_sequence
from umform.processes.bend_sequence.spec import Bend, BendSequence, Bodies

__all__ = ["Bend", "BendDone", "BendSequence", "Bodies", "Part", "bend_sequence"]
