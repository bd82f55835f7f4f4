"""Key of a deck that moves a tool out of the sheet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.problem.contents import Contents
from umform.problem.placeable import ORIGIN

#: Keys that place a tool.
_PLACES = ("origin", "centre", "point")


def out_of_the_sheet(contents: Contents, contact: str, shift: NDArray[np.float64]) -> str:
    """Key and value of the tool of a contact after a shift (3,)."""
    name = contents.contacts[contact].tool
    tool = contents.tools[name]
    places = [key for key in _PLACES if hasattr(tool, key)]
    key = places[0] if places and tool.rotation == ORIGIN and not tool.other_side else "translation"
    place = np.asarray(getattr(tool, key), dtype=float)
    moved = ", ".join(f"{x:.5g}" for x in np.round(place + shift, 9) + 0.0)
    old = ", ".join(f"{x:.5g}" for x in place + 0.0)
    return f"tools.{name}.{key} = [{moved}] instead of [{old}]"
