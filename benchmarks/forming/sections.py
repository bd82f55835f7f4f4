"""Sections of strips between simple tools: hats, layers, Z, L, wiping, stretch bending, foils."""

from __future__ import annotations

import math
from typing import Any

from corpus import sections
from forming.sheets import draw_sheet, judged, sheet_of
from jobs.drawing import Drawing
from jobs.lot import Done

_ENDS = ("", "", "free", "release")


def draw_hat(drawing: Drawing) -> dict[str, Any]:
    """Half or the whole of a U; the holder by force or at a gap, a pad on a spring, or neither."""
    keys = draw_sheet(drawing)
    edge, nose = drawing.ratio(1.5, 8.0), drawing.ratio(1.5, 8.0)
    half = nose + drawing.between(4.0, 20.0)
    clearance = drawing.between(1.05, 1.4)
    stroke = drawing.between(0.6, 3.0) * (edge + nose)
    return keys | {
        "half": half,
        "nose": nose,
        "edge": edge,
        "clearance": clearance,
        "stroke": stroke,
        "reach": half + clearance + edge + stroke + drawing.between(2.0, 15.0),
        "whole": drawing.chance(0.25),
        "held": drawing.one_of(("holder", "holder", "gap", "pad", "free")),
        "pressure": drawing.ratio(0.5, 5.0),
        "end": drawing.one_of(_ENDS),
        "turn": drawing.between(20.0, 35.0),
    }


def draw_layers(drawing: Drawing) -> dict[str, Any]:
    """A U of a few elements with four layers of them."""
    keys = draw_hat(drawing) | {"layers": 4, "whole": False, "element": "BEND8", "turn": drawing.between(25.0, 45.0)}
    return keys | {"rule": keys["rule"] if keys["rule"].get("points") != 4 else {"points": 3}}


def run_hat(keys: dict[str, Any]) -> Done:
    """A hat."""
    names = ("half", "nose", "edge", "clearance", "stroke", "reach", "whole")
    width = keys["reach"] - keys["half"] - keys["clearance"] - keys["edge"]
    held = {
        "holder": {"holder": keys["pressure"] * width},
        "gap": {"gap": 0.05},
        "pad": {"pad": 20.0 * keys["pressure"]},
    }
    size = _size(keys["turn"], min(keys["edge"], keys["nose"]), keys["reach"])
    if keys["whole"]:  # a node lies in the middle
        size = keys["reach"] / round(keys["reach"] / size)
    sheet = sheet_of(keys, size=size, layers=keys.get("layers", 1))
    given = {name: keys[name] for name in names} | held.get(keys["held"], {})
    return judged(sections.u_bend(sheet, **given, end=keys["end"]))


def _size(turn: float, radius: float, length: float) -> float:
    """Distance of nodes that turn by an angle over a radius, at most 44 of them along the sheet."""
    return max(math.radians(turn) * (radius + 0.5), length / 44.0)


def draw_z(drawing: Drawing) -> dict[str, Any]:
    """The left is held by a pad, the right goes down."""
    edge = drawing.ratio(1.5, 5.0)
    return draw_sheet(drawing) | {
        "edge": edge,
        "width": drawing.between(1.2, 4.0) + edge * drawing.between(0.0, 1.5),
        "offset": drawing.between(0.4, 2.0) * edge,
        "pad": drawing.ratio(30.0, 200.0),
        "end": drawing.one_of(("", "release")),
        "turn": drawing.between(20.0, 35.0),
    }


def run_z(keys: dict[str, Any]) -> Done:
    """A Z."""
    sheet = sheet_of(keys, size=_size(keys["turn"], keys["edge"], 40.0))
    given = {name: keys[name] for name in ("edge", "width", "offset", "pad", "end")}
    return judged(sections.z_bend(sheet, **given))


def draw_l(drawing: Drawing) -> dict[str, Any]:
    """A pad holds the sheet, a punch bends the flange."""
    edge, nose = drawing.ratio(1.5, 5.0), drawing.ratio(1.5, 6.0)
    stroke = drawing.between(1.0, 2.5) * (edge + nose)
    return draw_sheet(drawing) | {
        "edge": edge,
        "nose": nose,
        "stroke": stroke,
        "clearance": drawing.between(1.02, 1.3),
        "flange": edge + stroke + drawing.between(2.0, 6.0),
        "held": drawing.one_of(("force", "force", "spring", "gap")),
        "pad": drawing.ratio(30.0, 200.0),
        "end": drawing.one_of(_ENDS),
        "turn": drawing.between(20.0, 35.0),
    }


def run_l(keys: dict[str, Any]) -> Done:
    """An L."""
    length = 22.0 + keys["flange"]
    sheet = sheet_of(keys, size=_size(keys["turn"], min(keys["edge"], keys["nose"]), length))
    names = ("edge", "nose", "stroke", "clearance", "flange", "held", "pad", "end")
    return judged(sections.l_bend(sheet, **{name: keys[name] for name in names}))


def draw_wiping(drawing: Drawing) -> dict[str, Any]:
    """A clamped sheet without a pad."""
    keys = draw_l(drawing)
    return {name: value for name, value in keys.items() if name not in ("held", "pad")} | {
        "end": drawing.one_of(("", "release"))
    }


def run_wiping(keys: dict[str, Any]) -> Done:
    """Wiping."""
    length = 12.0 + keys["flange"]
    sheet = sheet_of(keys, size=_size(keys["turn"], min(keys["edge"], keys["nose"]), length))
    names = ("edge", "nose", "stroke", "clearance", "flange", "end")
    return judged(sections.wiping(sheet, **{name: keys[name] for name in names}))


def draw_stretch(drawing: Drawing) -> dict[str, Any]:
    """A strip is pulled, and a cylinder pressed into it."""
    return draw_sheet(drawing) | {
        "slender": drawing.one_of((0.3, 0.5, 1.0, 1.0, 2.0)),
        "radius": drawing.between(5.0, 16.0),
        "tension": drawing.one_of((0.0, 0.02, 0.1, 0.3)),
        "stroke": drawing.between(2.0, 9.0),
        "cells": drawing.whole(28, 44),
        "end": drawing.one_of(("", "release")),
    }


def run_stretch(keys: dict[str, Any]) -> Done:
    """Stretch bending."""
    sheet = sheet_of(keys, slender=keys["slender"], size=60.0 / keys["cells"])
    given = {name: keys[name] for name in ("radius", "tension", "stroke", "end")}
    return judged(sections.stretch_bend(sheet, **given))


def draw_foil(drawing: Drawing) -> dict[str, Any]:
    """A sheet that is very flexible between its tools: over a cylinder, drawn, or wiped over an edge."""
    return draw_sheet(drawing) | {
        "thickness": drawing.one_of((0.01, 0.02, 0.05, 0.1, 0.1, 0.2)),
        "slender": drawing.ratio(0.03, 0.3),
        "process": drawing.one_of(("stretch", "drawn", "drawn", "wiped", "wiped")),
        "stroke": drawing.between(2.0, 8.0),
        "held": drawing.one_of(("holder", "gap")),
        "pressure": drawing.ratio(0.1, 2.0),
        "cells": drawing.whole(28, 44),
    }


def run_foil(keys: dict[str, Any]) -> Done:
    """A foil."""
    length = {"stretch": 60.0, "drawn": 36.0, "wiped": 28.0}[keys["process"]]
    t = keys["slender"]
    sheet = sheet_of(keys, slender=t, size=length / keys["cells"])
    if keys["process"] == "stretch":
        return judged(sections.stretch_bend(sheet, stroke=keys["stroke"]))
    if keys["process"] == "wiped":
        return judged(sections.wiping(sheet, stroke=keys["stroke"]))
    held = {"holder": 16.0 * t * keys["pressure"]} if keys["held"] == "holder" else {"gap": 0.1 * t}
    return judged(sections.u_bend(sheet, stroke=keys["stroke"], clearance=2.0, **held))
