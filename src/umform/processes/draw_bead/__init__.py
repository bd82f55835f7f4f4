"""A draw bead modelled in full: a strip is closed between bead and groove, and drawn through.

`drawn_through` runs one bead, `extrapolated` several meshes of it; `DrawBead` holds the parameters, `Drawn` the
results: restraint, uplift, thinning.
"""

from umform.processes.draw_bead.case import drawn_through, extrapolated
from umform.processes.draw_bead.measures import Drawn
from umform.processes.draw_bead.parameters import DrawBead

__all__ = ["DrawBead", "Drawn", "drawn_through", "extrapolated"]
