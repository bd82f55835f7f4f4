"""The problem of a hem: what a deck of its second operation holds; the first is a bend."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from umform.model.transfer.rigid_motion import RigidMotion
from umform.problem.before import Placement
from umform.problem.problem import Problem
from umform.processes.air_bending.brake import unloading_keys
from umform.processes.air_bending.problem import touching
from umform.processes.bend_sequence.part import Part
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming.spec import Hemming

#: Parts of the travel of the plate, after each of which the flange is checked.
PARTS = 12
#: Radius of the edge of the insert relative to its thickness.
_ROUND = 0.49
#: Contact points per direction and facet: plates are flat.
_POINTS = 5


def problem_of_hem(case: Hemming, first: Part) -> tuple[Problem, float]:
    """The bent strip on the table, flattened by the plate and released; and the travel of the plate."""
    before = first.bends[0]
    mesh, motion = before.result.model.mesh, _on_the_table(case, first)
    u = motion.displacement(mesh.points, before.result.model.u)
    top = float((mesh.points + u.reshape(-1, 3))[:, 2].max())
    way = top - case.height
    how = {"penalty": max(pair.penalty for pair in touching(case.sheet).values()), "points": _POINTS}
    bent = before.problem.source.data
    plane = {"shape": "Plane", "point": (0.0, 0.0, 0.0), "normal": (0.0, 0.0, 1.0)}
    tools: dict[str, Any] = {
        "table": plane,
        "plate": plane | {"point": (0.0, 0.0, top), "normal": (0.0, 0.0, -1.0)},
    }
    contacts: dict[str, Any] = {
        "table": {"tool": "table", "faces": "lower", **how},
        "plate": {"tool": "plate", "faces": "lower", **how, "may_bottom": case.insert},
    }
    if case.insert:
        tools["insert"] = _insert(case, Strip.of(mesh, u))
        contacts["insert"] = {"tool": "insert", "faces": "upper", **how}
    increments = math.ceil(case.increments / PARTS)
    moves = [
        {"kind": "move", "to": {"stroke": way * part / PARTS}, "increments": increments} for part in range(1, PARTS + 1)
    ]
    tables = {
        "title": "A hem",
        "placement": Placement.table(motion),
        **{key: bent[key] for key in ("mesh", "element", "material")},
        "tools": tools,
        "contacts": contacts,
        "supports": [
            {"kind": "fix", "nodes": {"min": [-math.inf] * 3}, "directions": "y"},
            {"kind": "fix", "name": "stop", "nodes": "x1", "directions": "x"},
        ],
        "controls": {"stroke": {"kind": "tool", "contact": "plate", "direction": "-z"}},
        "steps": [*moves, {"kind": "release", "control": "stroke", **unloading_keys(case.sheet)}],
        "solution": {**bent["solution"], "rest": "on"},
    }
    about = f"A bent strip, flattened by {way:.6g} mm and released; in plane strain. Units: mm, N, MPa."
    return Problem.of(tables, [about], before.result), way


def _on_the_table(case: Hemming, first: Part) -> RigidMotion:
    """Motion that places the outer face of the base on z = 0, its middle at the same x as in the flat strip."""
    bent = first.bends[0]
    u = bent.result.model.u
    leg = Strip.of(bent.result.model.mesh, u).at(case.flange, over=False).sides(case.first.zone(bent.bend)).right_leg
    angle = -math.atan2(leg.direction[1], leg.direction[0])
    return RigidMotion.in_section(angle, leg.point, np.array([case.flange, 0.0]))


def _insert(case: Hemming, strip: Strip) -> dict[str, Any]:
    """Plate on the base, from a distance from the inner face at the bend line to beyond the end of the base."""
    bend = int(np.abs(strip.reference[:, 0, 0] - case.flange).argmin())
    edge = float(strip.current[bend, -1, 0]) + case.insert_edge
    long, wide = 2.0 * (case.flange + case.base), 200.0 * case.sheet.thickness
    centre = (edge + 0.5 * long, 0.5 * case.sheet.thickness, case.sheet.thickness + 0.5 * case.gap)
    return {"shape": "Box", "centre": centre, "size": (long, wide, case.gap), "radius": _ROUND * case.gap}
