"""Quarters of plates, clamped, supported or on a ring, under a ball, a plunger or a ring."""

from __future__ import annotations

from typing import Any

import numpy as np

import umform as uf
from jobs.contacts import HAIR, draw_contact
from jobs.drawing import Drawing
from jobs.pressing import increments, pressed
from umform import sheet_metals
from umform.surfaces import Surface

_ELEMENTS = (*["ANS3DEAS"] * 4, "EAS3DEAS", "EAS3DEAS", "BEND8", "MI9K3DEAS")


def draw(drawing: Drawing) -> dict[str, Any]:
    """A plate, square or not, some twenty to two hundred times as wide as it is thick."""
    thickness = drawing.one_of((0.5, 0.8, 1.0, 1.5, 2.0))
    metal = drawing.one_of(sheet_metals.names())
    element = drawing.one_of(_ELEMENTS)
    nodes = 18 if element == "MI9K3DEAS" else 8
    half = drawing.ratio(10.0, 100.0) * thickness
    edges = drawing.one_of(("clamped", "clamped", "supported", "ring"))
    cells = drawing.whole(8, 26) // (nodes // 8)
    young = sheet_metals.get(metal).young
    stroke = half * drawing.between(0.03, 0.3)
    return {
        "metal": metal,
        "thickness": thickness,
        "element": element,
        "half": half,
        "aspect": drawing.one_of((1.0, 1.0, drawing.between(1.0, 1.6))),
        "cells": (cells, cells),
        "edges": edges,
        "tool": drawing.one_of(("ball", "ball", "plunger", "ring")),
        "radius": half * drawing.between(0.15, 0.5),
        "edge_radius": thickness * drawing.ratio(1.0, 5.0),
        "die_radius": thickness * drawing.ratio(2.0, 6.0),
        "stroke": stroke,
        "steps": increments(drawing, stroke, thickness),
        "contacts": [draw_contact(drawing, thickness, young, nodes) for _ in range(2)],
        "line_search": drawing.chance(0.5),
        "unload": drawing.chance(0.6),
    }


def _tool(keys: dict[str, Any]) -> Surface:
    """What presses, touching the upper face in the middle."""
    R, r, top = keys["radius"], min(keys["edge_radius"], 0.9 * keys["radius"]), (0.5 - HAIR) * keys["thickness"]
    if keys["tool"] == "ball":
        return uf.Sphere((0.0, 0.0, top + R), R)
    if keys["tool"] == "ring":
        return uf.Torus((0.0, 0.0, top + 0.4 * R), "z", R, 0.4 * R)
    profile = uf.Profile.from_corners([(0.0, 0.0), (R, 0.0), (R, 4.0 * R)], [0.0, r, 0.0], closed=False)
    return uf.Revolved(profile, origin=(0.0, 0.0, top), axis="z")


def run(keys: dict[str, Any]) -> tuple[list[uf.Result], dict[str, tuple[float, float]]]:
    """Press down and release."""
    a, t = keys["half"], keys["thickness"]
    cell = uf.elements.element(keys["element"]).cell
    mesh = uf.mesh.strip(a, a * keys["aspect"], t, tuple(keys["cells"]), cell=cell)
    model = uf.Model(mesh, keys["element"], material=sheet_metals.get(keys["metal"]).law)
    model.symmetry("x0", normal="x")
    model.symmetry("y0", normal="y")
    under, above = keys["contacts"]
    if keys["edges"] == "ring":
        hole = 0.75 * a
        corners = [(9.0 * a, 0.0), (hole, 0.0), (hole, -9.0 * a)]
        ring = uf.Profile.from_corners(corners, [0.0, keys["die_radius"], 0.0], closed=False)
        die = uf.Revolved(ring, origin=(0.0, 0.0, (HAIR - 0.5) * t), axis="z")
        model.contact("lower", die, name="die", **under)
    else:
        outer = np.union1d(mesh.nodes("x1"), mesh.nodes("y1"))
        if keys["edges"] == "clamped":
            model.fix(outer)
        else:
            model.hinge(outer, "z")
    punch = model.drive(model.contact("upper", _tool(keys), name="punch", **above), "-z", name="stroke")
    return pressed(model, punch, keys)
