"""The equivalent bead for a modelled one, as Python code and as a deck table."""

from __future__ import annotations

from umform.processes.draw_bead.measures import Drawn


def in_python(drawn: Drawn) -> str:
    """Call of :meth:`umform.Model.bead`."""
    restraint, uplift = drawn.forces
    forces = f"restraint={restraint:.4g}, uplift={uplift:.4g}, width={width(drawn):.4g}"
    return f"model.bead(faces, tool, curve=[...], {forces})"


def in_deck(drawn: Drawn) -> str:
    """Table of a deck."""
    restraint, uplift = drawn.forces
    keys = {"restraint": restraint, "uplift": uplift, "width": width(drawn)}
    lines = ["[beads.NAME]", 'contact = "..."', "curve = [[0, 0, 0], [100, 0, 0]]"]
    return "\n".join([*lines, *(f"{key} = {value:.4g}" for key, value in keys.items())]) + "\n"


def width(drawn: Drawn) -> float:
    """Width of the band: the extent of the bead on the flat, including the edges of the groove."""
    return 2.0 * drawn.case.reach
