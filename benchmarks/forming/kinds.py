"""The kinds of the random jobs of drawing and forming."""

from __future__ import annotations

from forming import pairs, parts, presses, sections
from jobs.lot import Kind, Lot

FORMING = Lot(
    "umform forming 1",
    200,
    {
        "hat": Kind(2, sections.draw_hat, sections.run_hat),
        "U-bend of the process": Kind(1, presses.draw_u_bend, presses.run, presses.case),
        "four layers": Kind(1, sections.draw_layers, sections.run_hat),
        "joggle between two tools": Kind(2, pairs.draw_joggle, pairs.run, pairs.tools),
        "asymmetric rail": Kind(2, pairs.draw_rail, pairs.run, pairs.tools),
        "Z-bend with pad": Kind(1, sections.draw_z, sections.run_z),
        "L-bend with pad": Kind(1, sections.draw_l, sections.run_l),
        "wiping": Kind(1, sections.draw_wiping, sections.run_wiping),
        "stretch bending": Kind(1, sections.draw_stretch, sections.run_stretch),
        "foil": Kind(1, sections.draw_foil, sections.run_foil),
        "cup": Kind(2, presses.draw_cup, presses.run, presses.case),
        "box": Kind(1, parts.draw_box, parts.run_box),
        "hole flanging": Kind(1, parts.draw_flanging, parts.run_flanging),
        "bulge past the largest pressure": Kind(1, parts.draw_bulge, parts.run_bulge),
        "Nakajima": Kind(1, parts.draw_nakajima, parts.run_nakajima),
        "stretch forming": Kind(1, parts.draw_stretch, parts.run_stretch),
    },
)
