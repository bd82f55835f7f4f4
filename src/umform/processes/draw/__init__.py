"""Deep drawing: a round cup, and a U-bend; each is drawn, released from its tools and measured.

`draw` runs a `Cup` or a `UBend`, `extrapolated` a `UBend` on two meshes; `Drawn` is what comes out, `write_files`
writes all that is known of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.processes.draw.case import draw
    from umform.processes.draw.cup import Cup
    from umform.processes.draw.drawn import Drawn
    from umform.processes.draw.endings import Ending
    from umform.processes.draw.files import write_files
    from umform.processes.draw.two_meshes import extrapolated
    from umform.processes.draw.u_bend import UBend

__all__ = ["Cup", "Drawn", "Ending", "UBend", "draw", "extrapolated", "write_files"]

_HOME = {
    "Cup": "cup",
    "Drawn": "drawn",
    "Ending": "endings",
    "UBend": "u_bend",
    "draw": "case",
    "extrapolated": "two_meshes",
    "write_files": "files",
}

# The command line reads the parameters without the run.
__getattr__ = at_first_use(__name__, _HOME)
