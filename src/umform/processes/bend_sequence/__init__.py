"""Several bends in one part, each from the state after the previous bend.

`bend_sequence` runs a `BendSequence` of `Bend`; the result is a `Part`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.processes.bend_sequence.part import BendDone, Part
    from umform.processes.bend_sequence.run import bend_sequence
    from umform.processes.bend_sequence.spec import Bend, BendSequence, Bodies

__all__ = ["Bend", "BendDone", "BendSequence", "Bodies", "Part", "bend_sequence"]

_HOME = {
    "Bend": "spec",
    "BendDone": "part",
    "BendSequence": "spec",
    "Bodies": "spec",
    "Part": "part",
    "bend_sequence": "run",
}

# The command line reads the parameters without the run.
__getattr__ = at_first_use(__name__, _HOME)
