"""Air bending with the metals, thicknesses, dies and punches of a shop: to a stroke, or to an angle."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import umform as uf
from jobs.drawing import Drawing
from umform import sheet_metals
from umform.processes.air_bending import AirBending, air_bending, find_stroke

THICKNESSES = (0.5, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
OPENINGS = (6, 8, 10, 12, 16, 20, 24, 32, 40, 50, 63, 80, 100)
ANGLES = (30, 60, 75, 80, 84, 85, 86, 88, 90)
ELEMENTS = (*["BEND18"] * 5, *["BEND8"] * 3, "ANS3DEAS", "EAS3DEAS", "MI9K3DEAS", "DISP9K3DEAS")
#: Degrees that the wanted angle stays above those of the tools, for springback.
_ROOM = 15.0
_TOLERANCE = 0.05


def draw(drawing: Drawing) -> dict[str, Any]:
    """A bend in plane strain."""
    thickness = drawing.one_of(THICKNESSES)
    wanted = drawing.between(6.0, 12.0) * thickness
    opening = min(OPENINGS, key=lambda known: abs(known - wanted))
    die = drawing.one_of(ANGLES)
    keys = {
        "metal": drawing.one_of(sheet_metals.names()),
        "thickness": thickness,
        "opening": float(opening),
        "die_angle": float(die),
        "die_radius": drawing.ratio(0.06, 0.3) * opening,
        "punch_angle": float(drawing.one_of([angle for angle in ANGLES if angle <= die])),
        "punch_radius": drawing.ratio(0.3, 3.0) * thickness,
        "element": drawing.one_of(ELEMENTS),
        "layers": drawing.one_of((1, 1, 2)),
        "thickness_points": drawing.one_of((5, 6, 6, 8)),
        "elements_per_thickness": drawing.one_of((1.0, 1.5, 2.0, 3.0)),
        "contact_points": drawing.one_of(("auto", "auto", "auto", 2, 3, 4, 5)),
        "increment": drawing.one_of((0.00625, 0.00625, 0.0125, 0.02, 0.03, 0.05)),
        "part": drawing.between(0.15, 0.97),
    }
    if die < 70:  # a long way, which would take minutes
        keys |= {"layers": 1, "increment": max(0.0125, keys["increment"])}
    if keys["layers"] == 2 and keys["element"] != "BEND8":
        keys["elements_per_thickness"] = min(1.5, keys["elements_per_thickness"])
    if drawing.chance(0.3):
        keys["penetration"] = thickness / drawing.one_of((50, 100, 500, 1000))
    elif drawing.chance(0.2):
        keys["penalty"] = drawing.ratio(0.03, 3.0) * sheet_metals.get(keys["metal"]).young / thickness
    return keys


def draw_wide(drawing: Drawing) -> dict[str, Any]:
    """A bend of a sheet of some width, with a free edge, on a coarse mesh."""
    keys = draw(drawing) | {"layers": 1, "elements_per_thickness": drawing.one_of((1.0, 1.0, 1.5))}
    keys["element"] = drawing.one_of(("BEND8", "BEND8", "ANS3DEAS", "EAS3DEAS", "BEND18"))
    keys["increment"] = drawing.one_of((0.0125, 0.02, 0.03))
    return keys | {"width": drawing.ratio(2.0, 30.0) * keys["thickness"], "width_elements": drawing.whole(2, 4)}


def draw_search(drawing: Drawing) -> dict[str, Any]:
    """A bend whose angle after unloading is given."""
    keys = draw(drawing) | {"layers": 1, "element": drawing.one_of(("BEND8", "BEND8", "BEND18"))}
    keys["increment"] = drawing.one_of((0.00625, 0.0125, 0.02))
    least = max(keys["die_angle"], keys["punch_angle"]) + _ROOM
    return keys | {"angle": drawing.between(least, 165.0)}


def case(keys: dict[str, Any]) -> AirBending:
    """The parameters; the stroke is a part of the largest one."""
    own = {key: value for key, value in keys.items() if key not in ("metal", "part", "angle")}
    bend = AirBending(**own, material=sheet_metals.get(keys["metal"]).law)
    return replace(bend, stroke=keys["part"] * bend.largest_stroke)


def run(keys: dict[str, Any]) -> tuple[list[uf.Result], dict[str, tuple[float, float]]]:
    """Load and unload; the punch must feel what the die does."""
    bend = air_bending(case(keys), frames=1, progress=False)
    return [bend.result], {"punch against die": (bend.force_balance, 1e-6)}


def search(keys: dict[str, Any]) -> tuple[list[uf.Result], dict[str, tuple[float, float]]]:
    """Find the stroke, and bend once more to it."""
    found = find_stroke(case(keys), keys["angle"], tolerance=_TOLERANCE, progress=False)
    bend = air_bending(found.case, frames=1, progress=False)
    deviations = {
        "the angle found": (abs(found.measures.angle - keys["angle"]), _TOLERANCE),
        "the angle of the same stroke at once": (abs(bend.measures.angle - found.measures.angle), 0.2),
    }
    return [bend.result], deviations
