"""Contact as a user may ask for it: penalty or penetration, points, multipliers."""

from __future__ import annotations

from typing import Any

from jobs.drawing import Drawing

#: By how much tools overlap the sheet at the start, in thicknesses, so that they hold it.
HAIR = 1e-6


def draw_contact(drawing: Drawing, thickness: float, young: float, nodes: int = 8) -> dict[str, Any]:
    """Keys of ``Model.contact``; facets of 18-node cells take three points at least."""
    keys: dict[str, Any] = {
        "points": drawing.one_of(("auto", "auto", 2, 2, 3, 4, 5, "nodes", 1) if nodes == 8 else ("auto", 3, 4, 5)),
        "augmented": drawing.chance(0.25),
    }
    if drawing.chance(0.4):
        keys["penalty"] = drawing.ratio(3e-4, 3.0) * young / thickness
    elif drawing.chance(0.5):
        keys["penetration"] = thickness / drawing.one_of((50, 100, 200, 500))
    return keys
