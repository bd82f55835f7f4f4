"""The bends of a part as rows of text: for the terminal and the report."""

from __future__ import annotations

from umform.processes.air_bending.measures import QUANTITIES
from umform.processes.air_bending.remarks import coarse_mesh, extrapolated, tools_text
from umform.processes.bend_sequence.part import Part

_SHOWN = ("stroke", "loaded_angle", "angle", "springback", "largest_force", "radius", "k_factor", "bend_deduction")


def bend_rows(part: Part) -> list[list[str]]:
    """A header and a row for each quantity: name, the bends, unit."""
    bends = part.bends
    return [
        ["bend", *map(str, range(1, len(bends) + 1)), "unit"],
        ["position", *(f"{done.bend.position:g}" for done in bends), "mm"],
        ["direction", *(done.bend.direction for done in bends), ""],
        *(
            [QUANTITIES[name].label]
            + [f"{getattr(done.measures, name):.{QUANTITIES[name].decimals}f}" for done in bends]
            + [QUANTITIES[name].unit]
            for name in _SHOWN
        ),
        ["angle after the last bend", *(f"{angle:.2f}" for angle in part.angles), "deg"],
    ]


def flanges(part: Part) -> str:
    """The outer lengths of the flanges."""
    return "outer lengths of the flanges: " + ", ".join(f"{length:.3f}" for length in part.flanges) + " mm"


def remarks(part: Part) -> list[str]:
    """Tools of each bend, mesh, extrapolated flow curve."""
    cases = [part.sequence.case(done.bend) for done in part.bends]
    strain = max(done.measures.outer_strain for done in part.bends)
    tools = dict.fromkeys(tools_text(case) for case in cases)
    return [*tools, *coarse_mesh(part.sequence.sheet), *extrapolated(part.sequence.sheet, strain)]
