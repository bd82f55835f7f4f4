"""(w) The strip of (a) with its free edges: a quarter, so many cells over half of its width of 10."""

from __future__ import annotations

from bent_strip import GOALS, deviations, entry, forces, same_mesh
from entries import Entry
from ratios import Comparison, Found, as_good

TITLE = "(w) The same strip, 10 wide with free edges"
#: Code, element, cells along, layers, cells across.
MESHES = (
    ("umform", "BEND8", 48, 1, 4),
    ("umform", "BEND8", 48, 1, 3),
    ("umform", "BEND8", 24, 1, 2),
    ("umform", "BEND18", 24, 1, 2),
    ("CalculiX", "C3D8I", 48, 1, 4),
    ("CalculiX", "C3D8I", 48, 2, 4),
    ("CalculiX", "C3D20R", 60, 2, 2),
)
FINEST = ("umform", "EAS3DEAS", 96, 4, 4)
#: The model has half of the width.
HALVES = 2.0


def entries(short: bool) -> list[Entry]:
    """Runs of the comparison; none that are short."""
    if short:
        return []
    loose = [entry(*mesh, loose=1e-4) for mesh in MESHES if mesh[1] == "BEND8"]
    loose.append(entry("umform", "BEND18", 24, 1, 2, loose=1e-4, points=6))
    return [*loose, *(entry(*mesh) for mesh in (*MESHES, FINEST))]


def measures(found: Found) -> dict[str, dict[str, float]]:
    """Deviations from the finest stack of umform."""
    finest = entry(*FINEST).key
    references = {"umform": forces(found, HALVES)[finest]} if finest in found else {}
    return deviations(found, HALVES, references)


def comparisons(found: Found) -> list[Comparison]:
    """On the same mesh; and, for each run of CalculiX, the cheapest run of umform that is no further off."""
    rows = measures(found)
    error = {key: row["off umform, %"] for key, row in rows.items() if key != entry(*FINEST).key}
    return same_mesh(found) + as_good(found, error, GOALS)
