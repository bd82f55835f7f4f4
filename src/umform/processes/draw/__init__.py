"""Deep drawing: a round cup, and a U-bend; each is drawn, released from its tools and measured.

`draw` runs a `Cup` or a `UBend`, `extrapolated` a `UBend` on three meshes; `Drawn` is what comes out, `write_files`
writes all that is known of it.
"""

from umform.processes.draw.case import draw
from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.endings import Ending
from umform.processes.draw.files import write_files
from umform.processes.draw.three_meshes import extrapolated
from umform.processes.draw.u_bend import UBend

__all__ = ["Cup", "Drawn", "Ending", "UBend", "draw", "extrapolated", "write_files"]
