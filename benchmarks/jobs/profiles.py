"""Strips between tools whose sections a user has drawn: ridges, pits and channels below, noses above."""

from __future__ import annotations

from typing import Any

import umform as uf
from jobs.contacts import HAIR, draw_contact
from jobs.drawing import Drawing
from jobs.pressing import increments, pressed
from umform import sheet_metals
from umform.surfaces import Arc, Line, Surface

_ELEMENTS = (*["ANS3DEAS"] * 3, *["BEND8"] * 3, "EAS3DEAS", "MI9K3DEAS", "BEND18")


def draw(drawing: Drawing) -> dict[str, Any]:
    """Half of a strip; all lengths of the tools follow from its span and its thickness."""
    thickness = drawing.one_of((0.5, 0.8, 1.0, 1.5, 2.0, 3.0))
    metal = drawing.one_of(sheet_metals.names())
    element = drawing.one_of(_ELEMENTS)
    nodes = 18 if element in ("MI9K3DEAS", "BEND18") else 8
    span = drawing.between(6.0, 16.0) * thickness
    young = sheet_metals.get(metal).young
    plane = drawing.chance(0.6)
    width = thickness if plane else drawing.ratio(1.0, 10.0) * thickness
    stroke = span * drawing.between(0.05, 0.4)
    return {
        "metal": metal,
        "thickness": thickness,
        "element": element,
        "span": span,
        "length": span * drawing.between(1.3, 1.8),
        "width": width,
        "plane": plane,
        "cells": (drawing.whole(20, 60) // (nodes // 8), 1 if plane else 2),
        "die": drawing.one_of(("ridge", "ridge", "pit", "channel")),
        "slope": drawing.between(0.2, 2.0),
        "die_radius": drawing.ratio(0.7, 4.0) * thickness,
        "nose": drawing.ratio(0.3, 3.0) * thickness,
        "nose_radius": drawing.ratio(0.5, 3.0) * thickness,
        "nose_slope": drawing.between(0.3, 3.0),
        "stroke": stroke,
        "steps": increments(drawing, stroke, thickness),
        "contacts": [draw_contact(drawing, thickness, young, nodes) for _ in range(2)],
        "line_search": drawing.chance(0.7),
        "unload": drawing.chance(0.7),
    }


def tools(keys: dict[str, Any]) -> tuple[Surface, Surface]:
    """Die and punch, which touch the faces of the sheet; a fillet that does not fit is refused."""
    return _die(keys), _punch(keys)


def _die(keys: dict[str, Any]) -> Surface:
    """What the sheet lies on, its top at the lower face."""
    a, t, r = keys["span"], keys["thickness"], keys["die_radius"]
    top, deep = (HAIR - 0.5) * t, 4.0 * a
    if keys["die"] == "pit":  # a round one whose edges are rounded
        flat = a + r
        middle = [
            (flat, 0.0),
            *[(x * a, -0.5 * a * (1.0 - x * x) ** 0.5) for x in (0.8, 0.4, -0.4, -0.8)],
            (-flat, 0.0),
        ]
        corners = [(3.0 * a + 3.0 * flat, 0.0), *middle, (-3.0 * a - 3.0 * flat, 0.0)]
        profile = uf.Profile.from_corners(corners, [0.0, r, *[0.5 * a] * 4, r, 0.0], closed=False)
    elif keys["die"] == "channel":
        profile = uf.Profile(
            [
                Line((6.0 * a, 0.0), (a + r, 0.0)),
                Arc((a + r, 0.0), (a, -r), (a + r, -r)),
                Line((a, -r), (a, -r - deep)),
                Line((a, -r - deep), (-a, -r - deep)),
                Line((-a, -r - deep), (-a, -r)),
                Arc((-a, -r), (-a - r, 0.0), (-a - r, -r)),
                Line((-a - r, 0.0), (-6.0 * a, 0.0)),
            ],
            closed=False,
        )
    else:  # a ridge with a flat back, steeper or less steep on the side of the punch
        back, foot = 2.0 * r + keys["length"], keys["slope"] * a
        corners = [(a - foot, -a), (a + back, -a), (a + back, 0.0), (a, 0.0)]
        profile = uf.Profile.from_corners(corners, [0.0, 0.0, 0.0, r])
    return uf.Extruded(profile, origin=(0.0, 0.0, top), x="x", y="z")


def _punch(keys: dict[str, Any]) -> Surface:
    """A nose with a flat of some width, and rounded edges."""
    b, a, slope = keys["nose"], keys["span"], keys["nose_slope"]
    corners = [(-b - a / slope, a), (-b, 0.0), (b, 0.0), (b + a / slope, a)]
    profile = uf.Profile.from_corners(corners, [0.0, keys["nose_radius"], keys["nose_radius"], 0.0], closed=False)
    return uf.Extruded(profile, origin=(0.0, 0.0, (0.5 - HAIR) * keys["thickness"]), x="x", y="z")


def run(keys: dict[str, Any]) -> tuple[list[uf.Result], dict[str, tuple[float, float]]]:
    """Press down and release."""
    cell = uf.elements.element(keys["element"]).cell
    mesh = uf.mesh.strip(keys["length"], keys["width"], keys["thickness"], tuple(keys["cells"]), cell=cell)
    model = uf.Model(mesh, keys["element"], material=sheet_metals.get(keys["metal"]).law)
    model.symmetry("x0", normal="x")
    if keys["plane"]:
        model.fix(range(len(mesh.points)), "y")
    else:
        model.symmetry("y0", normal="y")
    (die, punch), (under, above) = tools(keys), keys["contacts"]
    model.contact("lower", die, name="die", **under)
    stroke = model.drive(model.contact("upper", punch, name="punch", **above), "-z", name="stroke")
    return pressed(model, stroke, keys)
