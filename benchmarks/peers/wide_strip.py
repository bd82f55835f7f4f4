"""(w) The strip of (a) with its free edges: a quarter, so many cells over half of its width of 10."""

from __future__ import annotations

from bent_strip import GOAL, deviations, entry, forces
from entries import Entry
from ratios import Comparison, Found

TITLE = "(w) The same strip, 10 wide with free edges"
#: Code, element, cells along, layers, cells across.
MESHES = (
    ("umform", "BEND8", 48, 1, 4),
    ("umform", "BEND18", 24, 1, 2),
    ("CalculiX", "C3D8I", 48, 1, 4),
    ("CalculiX", "C3D20R", 48, 1, 4),
    ("CalculiX", "C3D20R", 48, 2, 4),
)
FINEST = ("umform", "EAS3DEAS", 96, 4, 4)
#: The model has half of the width.
HALVES = 2.0


def entries(short: bool) -> list[Entry]:
    """Runs of the comparison; none that are short."""
    if short:
        return []
    return [entry(*MESHES[0], loose=True), *(entry(*mesh) for mesh in (*MESHES, FINEST))]


def measures(found: Found) -> dict[str, dict[str, float]]:
    """Deviations from the finest stack of umform."""
    finest = entry(*FINEST).key
    references = {"umform": forces(found, HALVES)[finest]} if finest in found else {}
    return deviations(found, HALVES, references)


def comparisons(found: Found) -> list[Comparison]:
    """Each run of CalculiX against BEND8 on the same mesh but one layer."""
    own = [key for key, (e, _) in found.items() if e.element == "BEND8"]
    rows = [(mine, key) for mine in own for key, (e, _) in found.items() if e.peer == "CalculiX"]
    return [Comparison("48 x 4 cells", mine, key, GOAL) for mine, key in rows]
