"""Sections between a die from a drawing and its counterpart: joggles, rails that are not symmetric."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import umform as uf
from corpus.answers import Answer, carried, solve
from corpus.sections import Sheet
from forming.sheets import draw_sheet, judged, sheet_of
from jobs.drawing import Drawing
from jobs.lot import Done
from umform.analysis.steps import Step

_Corners = list[tuple[float, float]]


def draw_joggle(drawing: Drawing) -> dict[str, Any]:
    """A step between two flats, in thicknesses; the sheet lies on the higher one and is held at its end."""
    offset = drawing.ratio(0.7, 6.0)
    return draw_sheet(drawing) | {
        "radii": [drawing.ratio(1.5, 6.0), drawing.ratio(1.5, 6.0)],
        "depth": offset,
        "slope": drawing.between(30.0, 75.0),
        "arms": [drawing.between(8.0, 20.0), drawing.between(8.0, 20.0)],
        "gap": drawing.one_of((0.02, 0.05, 0.1, 0.2)),
        "closed": drawing.one_of((1.0, 1.0, 0.9)),
        "held": drawing.one_of(("end", "end", "pad")),
        "end": drawing.one_of(("", "", "release")),
        "turn": drawing.between(20.0, 35.0),
    }


def draw_rail(drawing: Drawing) -> dict[str, Any]:
    """A channel with two different walls: between two tools, its flanges at two heights, or under a holder."""
    depth = drawing.between(4.0, 14.0)
    return draw_sheet(drawing) | {
        "radii": [drawing.ratio(2.0, 6.0) for _ in range(4)],
        "depth": depth,
        "step": depth * drawing.one_of((0.0, 0.0, 0.2, 0.4)),
        "walls": [drawing.between(50.0, 85.0), drawing.between(50.0, 85.0)],
        "bottom": drawing.between(10.0, 25.0),
        "arms": [drawing.between(6.0, 14.0), drawing.between(6.0, 14.0)],
        "gap": drawing.one_of((0.05, 0.1, 0.2)),
        "closed": drawing.one_of((1.0, 0.9, 0.7)),
        "held": drawing.one_of(("pair", "holder", "holder")),
        "pressure": drawing.ratio(0.5, 5.0),
        "end": drawing.one_of(("", "", "release")),
        "turn": drawing.between(20.0, 35.0),
    }


def _section(keys: dict[str, Any]) -> tuple[_Corners, list[float]]:
    """Corners of the die from right to left, the solid below, and the radii there."""
    depth, far = keys["depth"], 200.0
    if "slope" in keys:
        foot = depth / math.tan(math.radians(keys["slope"]))
        return [(far, -depth), (foot, -depth), (0.0, 0.0), (-far, 0.0)], [
            0.0,
            keys["radii"][0] + 1.0,
            keys["radii"][1],
            0.0,
        ]
    (right, left), b, step = keys["walls"], 0.5 * keys["bottom"], keys["step"]
    out = [depth / math.tan(math.radians(right)), (depth - step) / math.tan(math.radians(left))]
    corners = [(far, 0.0), (b + out[0], 0.0), (b, -depth), (-b, -depth), (-b - out[1], -step), (-far, -step)]
    a, c, d, e = keys["radii"]
    return corners, [0.0, a, c + 1.0, d + 1.0, e, 0.0]


def _reach(keys: dict[str, Any]) -> tuple[float, float]:
    """Ends of the sheet: the arms on the flats, beside what is drawn in."""
    corners, radii = _section(keys)
    (left, right), bent = keys["arms"], [r * 0.5 for r in radii]
    lengths = sum(math.dist(a, b) for a, b in pairwise(corners[1:-1]))
    more = 0.5 * (lengths - (corners[1][0] - corners[-2][0])) if "walls" in keys else 0.0
    return corners[-2][0] - bent[-2] - more - left, corners[1][0] + bent[1] + more + right


def tools(keys: dict[str, Any]) -> tuple[uf.Extruded, uf.surfaces.Surface]:
    """Die and counterpart in the lengths of the job: closed, the gap is left between them and the sheet."""
    s = sheet_of(keys).length
    corners, radii = _section(keys)
    profile = uf.Profile.from_corners([(s * x, s * z) for x, z in corners], [s * r for r in radii], closed=False)
    die = uf.Extruded(profile)
    return die, die.counterpart(s * (1.0 + keys["gap"]))


def _punch(keys: dict[str, Any], s: float) -> uf.surfaces.Surface:
    """The punch of a rail under a holder: the same walls, beside the sheet, its bottom on the sheet."""
    (right, left), b, depth = keys["walls"], 0.5 * keys["bottom"], keys["depth"]
    t = 1.0 + keys["gap"]
    slopes = [math.radians(angle) for angle in (right, left)]
    in_by = [t * math.tan(0.5 * angle) for angle in slopes]  # where the offset lines of bottom and wall meet
    top, high = 3.0 * depth, [3.0 * depth / math.tan(angle) for angle in slopes]
    low = [(-b + in_by[1], 0.0), (b - in_by[0], 0.0)]
    corners = [(low[0][0] - high[1], top), *low, (low[1][0] + high[0], top)]
    radii = [0.0, max(0.5, keys["radii"][2]), max(0.5, keys["radii"][1]), 0.0]
    profile = uf.Profile.from_corners([(s * x, s * z) for x, z in corners], [s * r for r in radii], closed=True)
    return uf.Extruded(profile, origin=(0.0, 0.0, s))


def run(keys: dict[str, Any]) -> Done:
    """Close the pair, or draw under the holder."""
    radius = min(keys["radii"])
    left, right = _reach(keys)
    size = max(math.radians(keys["turn"]) * (radius + 0.5), (right - left) / 50.0)
    sheet = sheet_of(keys, size=size)
    model = sheet.model(left, right)
    return judged(_under_holder(sheet, model, keys) if keys["held"] == "holder" else _between(sheet, model, keys, left))


def _between(sheet: Sheet, model: uf.Model, keys: dict[str, Any], left: float) -> Answer:
    """Both tools close; the sheet lies on the highest flat, and is held there by its end or by a pad."""
    s, (die, upper) = sheet.length, tools(keys)
    if keys["held"] != "pad" and ("slope" in keys or not keys["friction"]):
        model.fix(sheet.at(left), "x")
    sheet.tool(model, "lower", die, "die")
    names, steps = ["die", "counter"], list[Step]()
    if keys["held"] == "pad":
        names.append("pad")
        pad = sheet.tool(model, "upper", sheet.box(left - 50.0, -keys["radii"][1], 1.0, 31.0, 0.5), "pad")
        steps.append(uf.Move(model.press(pad, "z", name="hold"), -sheet.force(60.0), steps=2))
        if not keys["friction"]:
            model.fix(sheet.at(left), "x")
    counter = sheet.tool(model, "upper", upper.moved((0.0, 0.0, s * keys["depth"])), "counter")
    ram = model.drive(counter, "-z", name="stroke")
    steps.append(uf.Move(ram, s * keys["closed"] * keys["depth"], steps=sheet.steps))
    return _ended(model, steps, keys, ram, names)


def _under_holder(sheet: Sheet, model: uf.Model, keys: dict[str, Any]) -> Answer:
    """A punch draws the sheet under a plane holder; flanges are at one height then."""
    s = sheet.length
    keys = keys | {"step": 0.0}
    if not keys["friction"]:
        model.fix(lambda x, y, z: abs(x) < 0.6 * s * sheet.size, "x")
    die, _ = tools(keys)
    sheet.tool(model, "lower", die, "die")
    punch = sheet.tool(model, "upper", _punch(keys, s), "punch")
    holder = sheet.tool(model, "upper", sheet.plane(1.0), "holder")
    hold = model.press(holder, "z", name="hold")
    ram = model.drive(punch, "-z", name="stroke")
    way = s * keys["closed"] * (keys["depth"] - keys["gap"])
    steps = [
        uf.Move(hold, -sheet.force(keys["pressure"] * sum(keys["arms"])), steps=2),
        uf.Move(ram, way, steps=sheet.steps),
    ]
    return _ended(model, steps, keys, ram, ["die", "punch", "holder"])


def _ended(model: uf.Model, steps: list[Step], keys: dict[str, Any], ram: Any, names: list[str]) -> Answer:
    steps = [*steps, *([uf.Release(ram)] if keys["end"] == "release" else [])]
    result = solve(model, steps)
    return Answer([result], tools=[carried(result, names)])
