"""Strips that are bent freely over a cylinder: pushed down at one end, or wide ones between rolls with free edges."""

from __future__ import annotations

from typing import Any

import umform as uf
from jobs.contacts import HAIR, draw_contact
from jobs.drawing import Drawing
from jobs.pressing import increments, pressed
from umform import sheet_metals
from umform.processes.bending.case import build, free_bending
from umform.processes.bending.spec import FreeBending

_OF_8_NODES = (*["ANS3DEAS"] * 4, *["BEND8"] * 3, "EAS3DEAS", "DISP3DEAS")
_OF_18_NODES = ("MI9K3DEAS", "BEND18", "DISP9K3DEAS")


def draw(drawing: Drawing) -> dict[str, Any]:
    """A strip as in the example, in other sizes."""
    thickness = drawing.one_of((0.5, 0.8, 1.0, 1.5, 2.0, 3.0))
    radius = drawing.ratio(3.0, 40.0) * thickness
    tool_x = radius * drawing.between(1.1, 2.0) + thickness
    eight = drawing.chance(0.7)
    element = drawing.one_of(_OF_8_NODES if eight else _OF_18_NODES)
    cells = drawing.whole(16, 64) if eight else drawing.whole(10, 32)
    stroke = tool_x * drawing.between(0.1, 0.7)
    bends = element.startswith("BEND")
    keys = {
        "thickness": thickness,
        "length": tool_x * drawing.between(1.8, 3.0),
        "width": drawing.ratio(1.0, 20.0) * thickness,
        "radius": radius,
        "tool_x": tool_x,
        "stroke": stroke,
        "steps": increments(drawing, stroke, thickness),
        "yield_stress": drawing.between(80.0, 900.0),
        "hardening": drawing.one_of((0.0, 0.0, 300.0, 1000.0, 3000.0)),
        "penalty": drawing.ratio(20.0, 50_000.0) / thickness,
        "mesh": (cells, drawing.one_of((1, 1, 2, 3))),
        "element": element,
        "contact": drawing.one_of((1, 2, 2, 3, 4, 5, "nodes") if eight else (3, 4, 5, "nodes")),
        "thickness_points": 12 if bends else drawing.one_of((5, 5, 7)),
        "thickness_rule": "split" if bends else drawing.one_of(("gauss", "gauss", "lobatto")),
        "line_search": drawing.chance(0.3),
    }
    if bends:
        keys |= {"thickness_order": 4, "tie_E33": True, "mesh": (cells, 2 if eight else 1)}
    return keys


def case(keys: dict[str, Any]) -> FreeBending:
    """The parameters, with a model that can be built."""
    bend = FreeBending(**keys)
    build(bend)[0].system.check()
    return bend


def run(keys: dict[str, Any]) -> tuple[list[uf.Result], dict[str, tuple[float, float]]]:
    """Bend and release."""
    bend = free_bending(FreeBending(**keys), progress=False)
    assert bend.result is not None
    return [bend.result], {}


def draw_wide(drawing: Drawing) -> dict[str, Any]:
    """A quarter of a wide sheet: on blocks under a cylinder or a ball, or on cylinders and pushed along a line."""
    thickness = drawing.one_of((0.5, 0.8, 1.0, 1.5, 2.0, 3.0))
    metal = drawing.one_of(sheet_metals.names())
    eight = drawing.chance(0.8)
    span = drawing.between(8.0, 20.0) * thickness
    young = sheet_metals.get(metal).young
    stroke = span * drawing.between(0.05, 0.35)
    cells = (drawing.whole(12, 24), drawing.whole(3, 8)) if eight else (drawing.whole(8, 14), drawing.whole(2, 4))
    return {
        "metal": metal,
        "thickness": thickness,
        "element": drawing.one_of(_OF_8_NODES if eight else _OF_18_NODES),
        "cells": cells,
        "span": span,
        "length": span * drawing.between(1.3, 1.7),
        "width": span * drawing.between(0.3, 2.0),
        "support": drawing.ratio(1.0, 5.0) * thickness,
        "punch": drawing.one_of(("cylinder", "ball", "line", "line")),
        "punch_radius": drawing.ratio(2.0, 10.0) * thickness,
        "stroke": stroke,
        "steps": increments(drawing, stroke, thickness),
        "contacts": [draw_contact(drawing, thickness, young, 8 if eight else 18) for _ in range(2)],
        "line_search": drawing.chance(0.7),
        "unload": drawing.chance(0.7),
    }


def run_wide(keys: dict[str, Any]) -> tuple[list[uf.Result], dict[str, tuple[float, float]]]:
    """Press down and release."""
    t, r, R = keys["thickness"], keys["support"], keys["punch_radius"]
    cell = uf.elements.element(keys["element"]).cell
    mesh = uf.mesh.strip(keys["length"], keys["width"], t, tuple(keys["cells"]), cell=cell)
    model = uf.Model(mesh, keys["element"], material=sheet_metals.get(keys["metal"]).law)
    model.symmetry("x0", normal="x")
    model.symmetry("y0", normal="y")
    under, above = keys["contacts"]
    if keys["punch"] == "line":  # nothing but the line holds the sheet until it has come down to a contact point
        support = uf.Cylinder(centre=(keys["span"], 0.0, -0.5 * t - r), axis="y", radius=r)
        model.contact("lower", support, name="support", **under)
        return pressed(model, model.prescribe("x0_lower", "z", name="stroke"), keys, sign=-1)
    block = uf.WipingDie(r, origin=(-keys["span"], 0.0, (HAIR - 0.5) * t)).mirrored("x")
    model.contact("lower", block, name="support", **under)
    centre = (0.0, 0.0, (0.5 - HAIR) * t + R)
    tool = uf.Sphere(centre, R) if keys["punch"] == "ball" else uf.Cylinder(centre, "y", R)
    punch = model.drive(model.contact("upper", tool, name="punch", **above), "-z", name="stroke")
    return pressed(model, punch, keys)
