"""A draw bead of real geometry: a strip is closed between bead and groove, and drawn through.

`drawn_through` runs one bead, `extrapolated` two meshes of it; `DrawBead` are its parameters, `Drawn` is what comes
out: restraint, uplift, thinning.
"""

from umform.processes.draw_bead.case import drawn_through, extrapolated
from umform.processes.draw_bead.measures import Drawn
from umform.processes.draw_bead.parameters import DrawBead

__all__ = ["DrawBead", "Drawn", "drawn_through", "extrapolated"]
