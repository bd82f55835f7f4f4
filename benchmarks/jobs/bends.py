"""The kinds of the random bends."""

from __future__ import annotations

from jobs import air_bends, plates, profiles, strips
from jobs.lot import Kind, Lot

BENDS = Lot(
    "umform 1",
    300,
    {
        "air bend": Kind(8, air_bends.draw, air_bends.run, air_bends.case),
        "air bend with free edges": Kind(3, air_bends.draw_wide, air_bends.run, air_bends.case),
        "stroke for an angle": Kind(2, air_bends.draw_search, air_bends.search, air_bends.case),
        "strip over a cylinder": Kind(7, strips.draw, strips.run, strips.case),
        "wide sheet with free edges": Kind(3, strips.draw_wide, strips.run_wide),
        "sections of users": Kind(4, profiles.draw, profiles.run, profiles.tools),
        "plate under a tool": Kind(3, plates.draw, plates.run),
    },
)
