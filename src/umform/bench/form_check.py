"""Check of a form before a run: outlines of the tools, errors, warnings, expected values."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from umform.bench.draws import facts, follow, sketch
from umform.bench.errors_as_json import problems_of
from umform.bench.forces import largest, rule_forces
from umform.bench.library import ROOM, tools_for
from umform.bench.parts import Parts
from umform.bench.shelf import Shelf
from umform.bench.values import Mistakes
from umform.bench.wanted import Wanted
from umform.errors import UmformError
from umform.processes.air_bending.formulas import INNER_RADIUS, shop_forces, strength
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.collisions import die_body, punch_body
from umform.processes.bend_sequence.foreseen_collisions import foreseen_collisions
from umform.processes.bend_sequence.spec import Bodies

#: Openings over the thickness that are usual on a press brake.
_NARROW, _WIDE = 5.0, 16.0


def look(values: object, shelf: Shelf | None = None, parts: Parts | None = None) -> dict[str, Any]:
    """Check the values of a form.

    Parameters
    ----------
    values : object
        The request of the page; any JSON.
    shelf : Shelf, optional
        Drawn tools.
    parts : Parts, optional
        Parts to unfold.

    Returns
    -------
    dict
        ``problems`` (errors, which prevent a run) and ``warnings``; for valid tools ``drawing``, ``expected`` and
        ``change`` (suitable tools).
    """
    try:
        wanted = Wanted.read(values)
    except Mistakes as error:
        return {"problems": problems_of(error), "warnings": []}
    try:
        if wanted.choices.work == "flat":
            return _look_at_part(wanted, parts)
        if wanted.is_drawn:
            return _look_at_draw(wanted)
        case = wanted.case() if wanted.choices.work == "table" else wanted.at_tools(shelf)
    except UmformError as error:
        return {"problems": problems_of(error), "warnings": [], "change": tools_for(wanted)}
    found: dict[str, Any] = {
        "problems": [],
        "warnings": _warnings(wanted, case),
        "drawing": drawing(case, bodies=wanted.of_strip),
        "follow": {},
    }
    if wanted.choices.work == "table":
        middle = wanted.values["angles"][len(wanted.values["angles"]) // 2]
        return found | {
            "shown": {"angle": middle, "stroke": None, "thickness": case.thickness, "opening": case.opening}
        }
    found["expected"] = _expected(wanted, case)
    angles = {"bottom": case.die_angle, "hem": wanted.values.get("first_angle")}  # a bottomed sheet has that of the die
    if wanted.choices.work in angles:
        found["shown"] = {"angle": angles[wanted.choices.work], "stroke": None}
    found["measured"] = {name: round(value, 4) for name, value in case.drawn_sizes.items()}
    try:
        wanted.case(shelf)
    except UmformError as error:
        found |= {"problems": problems_of(error), "change": tools_for(wanted)}
    else:
        if wanted.choices.work == "outside":
            developed = _developed(wanted, case)
            found |= {"expected": found["expected"] | {"flat": developed["flat"]}, "shown": developed["shown"]}
        if wanted.choices.work == "hem":
            hem = wanted.hem(case)
            found["follow"] = {"gap": hem.gap, "elements_per_thickness": case.elements_per_thickness}
        found["change"] = tools_for(wanted) if any(row["kind"] == "close" for row in found["warnings"]) else None
    return found


def _look_at_part(wanted: Wanted, parts: Parts | None) -> dict[str, Any]:
    """Data of a part that are known before it is unfolded."""
    row = (parts or Parts(Path())).row(wanted.values["part"])
    wanted.tooling(row["thickness"])
    return {"problems": [], "warnings": [], "part": row}


def _look_at_draw(wanted: Wanted) -> dict[str, Any]:
    """Tools and blank of a drawn part, its ratios, and what is unusual."""
    case = wanted.draw()
    warnings = [{"where": "work", "kind": "said", "what": text, "bounds": {}} for text in case.warnings]
    found = {"problems": [], "warnings": warnings, "drawing": sketch(case), "follow": follow(case)}
    return found | {"expected": {"draw": facts(case)}}


def _developed(wanted: Wanted, case: AirBending) -> dict[str, Any]:
    """Flat length and bend lines of outside dimensions, and what the drawing needs of them."""
    found = wanted.developed_at_once(case)
    sequence = found.sequence(case)
    bends = [{"position": one.position, "angle": one.angle, "direction": one.direction} for one in sequence.bends]
    computed = all(one.source.startswith("computed") for one in found.deductions)
    return {
        "flat": {"length": found.length, "lines": sorted(found.positions), "computed": computed},
        "shown": {"strip_length": found.length, "bends": bends, "flanges": list(found.part.flanges)},
    }


def drawing(case: AirBending, *, bodies: bool = False) -> dict[str, Any]:
    """Outlines of die and punch in mm, the punch where it touches the sheet; half of the sheet's length.

    ``bodies``: with the bodies that a part of several bends may collide with.
    """
    far = 2.0 * case.half_length
    chord = 2e-3 * case.opening
    die, punch = case.die.profile, case.punch.profile
    if bodies and case.die_section is None:
        die = die_body(case, Bodies())
    if bodies and case.punch_section is None:
        punch = punch_body(case, Bodies())
    return {
        "die": die.points(chord, far).tolist(),
        "punch": np.add(punch.points(chord, far), (0.0, case.height)).tolist(),
        "closed": {"die": die.closed, "punch": punch.closed},
        "depth": case.depth,
        "sizes": {"die": case.sizes("die"), "punch": case.sizes("punch")},
        "half_length": case.half_length,
        "largest_stroke": case.largest_stroke,
        "thickness": case.height,
        "shoulder": case.shoulder,
        "radii": case.radii,
    }


def _expected(wanted: Wanted, case: AirBending) -> dict[str, Any]:
    """Expected values by workshop rules."""
    forces = rule_forces(wanted, case)
    return {
        "tensile_strength": strength(case),
        "force": list(shop_forces(case)),
        "forces": [{"operation": one.operation, "force": [one.low, one.high], "beyond": one.beyond} for one in forces],
        "press": largest(forces).over(wanted.choices.length),
        "radius": INNER_RADIUS * case.opening,
        "ratio": case.opening / case.thickest,
    }


def _collisions(wanted: Wanted, case: AirBending) -> list[dict[str, Any]]:
    """Expected collisions of several bends; only the run decides."""
    if wanted.choices.work not in ("outside", "sequence"):
        return []
    try:
        sequence = wanted.sequence(case)
    except UmformError:
        return []  # an error, which `look` reports
    found = []
    for number, hits in foreseen_collisions(sequence).items():
        for hit in hits:
            bounds = {"stroke": round(max(hit.stroke, 0.0), 1)}
            found.append({"where": f"bend {number}", "kind": f"collides_{hit.tool}", "bounds": bounds, "level": "bad"})
    return found


def _warnings(wanted: Wanted, case: AirBending) -> list[dict[str, Any]]:
    """Warnings by kind and numbers; the page has their texts."""
    ratio = case.opening / case.thickest
    found = _collisions(wanted, case)
    if not _NARROW <= ratio <= _WIDE:
        found.append({"where": "opening", "kind": "ratio", "bounds": {"ratio": round(ratio, 1)}})
    sharpest = max(case.die_angle, case.punch_angle)
    angle, length = wanted.goal.angle, wanted.choices.length
    if angle is not None and sharpest < angle < sharpest + ROOM:
        found.append({"where": "angle", "kind": "close", "bounds": {"angle": sharpest}})
    if wanted.choices.whole and length > 20.0 * case.thickness:
        found.append({"where": "whole", "kind": "long", "bounds": {"ratio": round(length / case.thickness)}})
    return found
