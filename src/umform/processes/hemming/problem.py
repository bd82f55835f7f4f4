"""The problem of a hem: what a deck of its second operation holds; the first is a bend."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.elements import element
from umform.errors import InvalidValue
from umform.mesh import Mesh
from umform.model.contact.encounter import Layer
from umform.model.contact.settings import ContactOptions, contact_settings
from umform.model.transfer.beside import PART
from umform.model.transfer.rigid_motion import RigidMotion
from umform.problem.previous_operation import Placement
from umform.problem.problem import Problem
from umform.processes.air_bending.loading import unloading_keys
from umform.processes.air_bending.problem import touching
from umform.processes.bend_sequence.part import Part
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming.spec import LARGEST_ANGLE, Hemming
from umform.surfaces import Plane

#: Steps of the travel of the plate.
_PARTS = 12
#: Radius of the edge of insert and plate relative to their thickness.
_ROUND = 0.49
#: Contact points per direction and facet over a rigid insert; where sheets touch, cells by the type of the elements: a
#: fold rolls closed over points step by step, over cells smoothly (docs/sheets-that-touch.md).
_POINTS = 5
_CELLS = {"hex8": 3, "hex18": 6}
#: Length of the elements of an inner sheet below the flange, in thicknesses of the sheet; beyond it, this many times.
_INNER, _COARSER = 0.5, 4.0
#: Force of the plate that counts as zero, relative to the force before unloading: a thousandth of what closes the fold
#: still bends the flange.
_ZERO_FORCE = 1e-6
#: Control of the plate: its force, and its way where that is prescribed.
FORCE, STROKE = "stroke_force", "stroke"


def loading_steps(case: Hemming) -> int:
    """Number of steps before the release: parts of a travel, or one with a force."""
    return _PARTS if case.force is None else 1


def way_column(case: Hemming) -> str:
    """Column of the way of the plate."""
    return STROKE if case.force is None else f"{FORCE}_way"


def edge_of(case: Hemming) -> str:
    """Set of the nodes at y = 0 of the hemmed sheet."""
    return _of_part(case, "y0")


def start_of(case: Hemming, first: Part) -> tuple[Mesh, NDArray[np.float64], RigidMotion]:
    """The bent strip on the table: mesh, displacements, motion from where it was bent."""
    model, motion = first.bends[0].result.model, _on_the_table(case, first)
    return model.mesh, motion.displacement(model.mesh.points, model.u), motion


def problem_of_hem(case: Hemming, first: Part) -> tuple[Problem, float]:
    """The bent strip on the table, flattened by the plate and released; and the travel of the plate to its height."""
    _check_angle(case, first)
    before, (mesh, u, motion) = first.bends[0], start_of(case, first)
    strip = Strip.of(mesh, u)
    top = _top(case, strip)
    way = top - case.height
    how, flat = {**_given(case), **_integration(case)}, _flat(case, mesh)
    bent, outside = before.problem.source.data, _of_part(case, "lower")
    plane = {"shape": "Plane", "point": (0.0, 0.0, 0.0), "normal": (0.0, 0.0, 1.0)}
    tools: dict[str, Any] = {"table": plane, "plate": _plate(case, strip, top)}
    contacts: dict[str, Any] = {
        "table": {"tool": "table", "faces": outside, **how, **flat},
        "plate": {"tool": "plate", "faces": outside, **how, "may_bottom": case.form != "open"},
    }
    if not case.loop_length:
        contacts["plate"] |= flat
    fixed = [{"kind": "fix", "nodes": {"min": [-math.inf] * 3}, "directions": "y"}]
    fixed.append({"kind": "fix", "name": "stop", "nodes": _of_part(case, "x1"), "directions": "x"})
    added: dict[str, Any] = {}
    if case.form == "insert":
        tools["insert"] = _insert(case, strip)
        contacts["insert"] = {"tool": "insert", "faces": "upper", **how}
    if case.form == "inner":
        added["inner"] = _inner(case, strip)
        fixed.append({"kind": "fix", "name": "inner_end", "nodes": "x1 of inner", "directions": "xz"})
    tables = {
        "title": "A hem",
        "placement": Placement.table(motion),
        "added": added or None,
        **{key: bent[key] for key in ("mesh", "element", "material")},
        "tools": tools,
        "contacts": contacts,
        "sheet_contacts": _sheet_contacts(case) if case.touches_itself else None,
        "supports": fixed,
        **_pressing(case, way),
        "solution": {**bent["solution"], "rest": "on"},
    }
    goal = f"by {way:.6g} mm" if case.force is None else f"with {case.force:g} kN/m"
    about = f"A bent strip, flattened {goal} and released; in plane strain. Units: mm, N, MPa."
    return Problem.of(tables, [about], before.result), way


def _check_angle(case: Hemming, first: Part) -> None:
    """Refuse a first bend by a stroke that leaves its flange too far open."""
    angle = first.bends[0].measures.angle
    if case.sheet.stroke is not None and not angle <= LARGEST_ANGLE:
        raise InvalidValue(
            f"the first bend of a hem closes to {LARGEST_ANGLE:g} degrees at least",
            where="sheet.stroke",
            value=f"{case.sheet.stroke:g}, which leaves {angle:.4g} degrees",
            cause="a small stroke: the plate would press the flange flat",
            remedy="a larger stroke, or an angle in place of it",
        )


def _given(case: Hemming) -> dict[str, float | None]:
    """Penalty or allowed penetration of the sheet, if one is given."""
    return {"penalty": case.sheet.penalty, "penetration": case.sheet.penetration}


def _integration(case: Hemming) -> dict[str, Any]:
    """Integration of the contact over a face."""
    return {"cells": _CELLS[element(case.sheet.element).cell]} if case.touches_itself else {"points": _POINTS}


def _flat(case: Hemming, mesh: Mesh) -> dict[str, Any]:
    """Allowed penetration of a flat tool, and the one from which its first penalty follows.

    An estimate spreads the force over 20 thicknesses, but a hem is pressed at its fold: the first penalty is that of
    punch or die of the bend, and grows from there.
    """
    if case.sheet.penalty is not None:
        return {}
    steep = max(touching(case.sheet).values(), key=lambda pair: pair.penalty)
    how = ContactOptions(penetration=case.sheet.penetration)
    soft = contact_settings(mesh, "lower", Plane(), [Layer(case.sheet.material)], how)
    assert soft.allowed is not None
    return {"penetration": soft.allowed * soft.penalty / steep.penalty, "allowed": soft.allowed}


def _of_part(case: Hemming, name: str) -> str:
    """Name of a set of the hemmed sheet, which is one of two beside an inner sheet."""
    return f"{name} of {PART}" if case.form == "inner" else name


def _pressing(case: Hemming, way: float) -> dict[str, Any]:
    """The control of the plate, and its steps."""
    on: dict[str, Any] = {"contact": "plate", "direction": "-z"}
    if case.force is not None:
        force, increment = case.force * case.sheet.thickness, way / case.increments
        steps = [{"kind": "close", "control": FORCE, "force": force, "increment": increment}]
        release = {"kind": "release", "control": FORCE, **unloading_keys(case.sheet, _ZERO_FORCE)}
        return {"controls": {FORCE: {"kind": "press", **on}}, "steps": [*steps, release]}
    count = math.ceil(case.increments / _PARTS)
    ends = [way * part / _PARTS for part in range(1, _PARTS + 1)]
    steps = [{"kind": "move", "to": {STROKE: end}, "increments": count} for end in ends]
    release = {"kind": "release", "control": STROKE, **unloading_keys(case.sheet, _ZERO_FORCE)}
    return {"controls": {STROKE: {"kind": "tool", **on}}, "steps": [*steps, release]}


def _sheet_contacts(case: Hemming) -> dict[str, Any]:
    """The inner face with itself, and with both faces of an inner sheet: the base from below, the flange from above."""
    how = _integration(case)
    inside = _of_part(case, "upper")
    found: dict[str, Any] = {"inside": {"faces": inside, **how}}
    if case.form == "inner":
        base = {"min": (case.flange, -math.inf, -math.inf)}
        flange = {"max": (case.flange, math.inf, math.inf)}
        for name, side, box in (("below", "lower", base), ("above", "upper", flange)):
            found[name] = {"faces": {"intersection": [inside, box]}, "others": f"{side} of inner", **how}
    return found


def _on_the_table(case: Hemming, first: Part) -> RigidMotion:
    """Motion that places the outer face of the base on z = 0, its end at the same x as in the flat strip."""
    bent = first.bends[0]
    strip = Strip.of(bent.result.model.mesh, bent.result.model.u)
    leg = strip.at(case.flange, over=False).sides(case.first.zone(bent.bend)).right_leg
    angle = -math.atan2(leg.direction[1], leg.direction[0])
    end = leg.point + leg.direction * float((strip.current[-1, 0] - leg.point) @ leg.direction)
    return RigidMotion.in_section(angle, end, np.array([case.flange + case.base, 0.0]))


def _bend_line(case: Hemming, strip: Strip) -> float:
    """Coordinate x of the inner face at the bend line."""
    bend = int(np.abs(strip.reference[:, 0, 0] - case.flange).argmin())
    return float(strip.current[bend, -1, 0])


def _top(case: Hemming, strip: Strip) -> float:
    """Height at which the plate first touches the flange."""
    at = strip.current[:, 0]
    below = at[at[:, 0] >= _bend_line(case, strip) + case.loop_length] if case.loop_length else at
    return float(below[:, 1].max())


def _plate(case: Hemming, strip: Strip, top: float) -> dict[str, Any]:
    """The plate: a plane, or for a rope hem a block that ends before the loop."""
    if not case.loop_length:
        return {"shape": "Plane", "point": (0.0, 0.0, top), "normal": (0.0, 0.0, -1.0)}
    thick = case.sheet.thickness
    return _block(case, _bend_line(case, strip) + case.loop_length, top, 4.0 * thick, thick)


def _insert(case: Hemming, strip: Strip) -> dict[str, Any]:
    """Plate on the base, from a distance from the inner face at the bend line to beyond the end of the base."""
    return _block(case, _inner_edge(case, strip), case.sheet.thickness, case.gap, _ROUND * case.gap)


def _inner_edge(case: Hemming, strip: Strip) -> float:
    return _bend_line(case, strip) + case.insert_edge


def _block(case: Hemming, edge: float, bottom: float, height: float, radius: float) -> dict[str, Any]:
    long, wide = 2.0 * (case.flange + case.base), 200.0 * case.sheet.thickness
    centre = (edge + 0.5 * long, 0.5 * case.sheet.thickness, bottom + 0.5 * height)
    return {"shape": "Box", "centre": centre, "size": (long, wide, height), "radius": radius}


def _inner(case: Hemming, strip: Strip) -> dict[str, Any]:
    """Mesh of the inner sheet on the base, up to the end of the base: fine below the flange."""
    thick, start = case.sheet.thickness, _inner_edge(case, strip)
    end = float(strip.current[-1, -1, 0])
    fine = min(end, _bend_line(case, strip) + case.flange + thick)
    pieces = [(start, fine, _INNER * thick), (fine, end, _INNER * _COARSER * thick)]
    lines = [np.linspace(a, b, 1 + max(1, round((b - a) / size))) for a, b, size in pieces if b - a > 1e-3 * thick]
    x = np.unique(np.concatenate(lines))
    z = thick + case.gap * np.linspace(0.0, 1.0, 1 + case.sheet.layers)
    return {"generator": "grid", "x": x.tolist(), "y": [0.0, thick], "z": z.tolist(), "thickness": case.gap}
