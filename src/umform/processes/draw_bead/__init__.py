"""A draw bead modelled in full: a strip is closed between bead and groove, and drawn through.

`drawn_through` runs one bead, `extrapolated` several meshes of it; `DrawBead` holds the parameters, `Drawn` the
results: restraint, uplift, thinning.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.processes.draw_bead.case import drawn_through, extrapolated
    from umform.processes.draw_bead.measures import Drawn
    from umform.processes.draw_bead.spec import DrawBead

__all__ = ["DrawBead", "Drawn", "drawn_through", "extrapolated"]

_HOME = {"DrawBead": "spec", "Drawn": "measures", "drawn_through": "case", "extrapolated": "case"}

# The command line reads the parameters without the run.
__getattr__ = at_first_use(__name__, _HOME)
