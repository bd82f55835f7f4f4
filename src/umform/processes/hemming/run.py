"""Bend acutely, place the base on a table, move a plate down, unload."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from umform.errors import InvalidValue
from umform.model import Model
from umform.model.control import Control
from umform.model.rigid_motion import RigidMotion
from umform.processes.air_bending.brake import OPTIONS, touching, unloading_keys
from umform.processes.bend_sequence.part import Part
from umform.processes.bend_sequence.run import FRAMES, bend_sequence
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming.measures import Hem, clearances, measured
from umform.processes.hemming.spec import Hemming
from umform.progress import Show, parts, progress_bar
from umform.run.open_run import OpenRun
from umform.run.stages import continued
from umform.steps import Move, Release
from umform.surfaces import Box, Plane

#: Parts of the travel of the plate, after each of which the flange is checked.
_PARTS = 12
#: Radius of the edge of the insert relative to its thickness.
_ROUND = 0.49
#: Contact points per direction and facet: plates are flat.
_POINTS = 5
#: Gap that counts as contact, relative to the thickness.
_TOUCHES = -0.01


def hemming(case: Hemming, *, tolerance: float = 0.1, frames: int = FRAMES, progress: Show = None) -> Hem:
    """Make a hem: an acute bend, flattened between a plate and a table.

    Parameters
    ----------
    case : Hemming
        The parameters.
    tolerance : float
        Largest deviation of the angle of the first bend in degrees.
    frames : int
        Approximate number of states kept of each operation.
    progress : bool or callable, optional
        Show a progress bar; default: only on a terminal. A callable takes name, fraction and detail instead.

    Raises
    ------
    InvalidValue
        If the flange of an open hem would touch the base, or the first bend is out of reach.
    NoConvergence
        If the run does not converge.
    """
    first = bend_sequence(case.first, tolerance=tolerance, frames=frames, progress=progress)
    model, plate, way = in_press(case, first)
    run = OpenRun(model, options=OPTIONS, frames=max(1, frames // _PARTS))
    with progress_bar(progress) as tick:
        for part, told in enumerate(parts(tick, "flattening", [1.0] * _PARTS), 1):
            run.take(Move(plate, to=way * part / _PARTS, steps=math.ceil(case.increments / _PARTS)), tick=told)
            strip = Strip.of(model.mesh, model.u)
            if not case.insert:
                _refuse_touch(case, strip, way * (1.0 - part / _PARTS))
        force = run.result["stroke_force"] / case.sheet.thickness
        run.take(Release(plate, **unloading_keys(case.sheet)))
    released = Strip.of(model.mesh, model.u)
    result = run.close()
    whole = result["stroke_force"] / case.sheet.thickness
    warnings = (*first.warnings, *result.warnings)
    return Hem(case, first, measured(case, force, strip, released), result["stroke"], whole, released, warnings, result)


def in_press(case: Hemming, first: Part) -> tuple[Model, Control, float]:
    """Model of the bent strip on the table, the control that moves the plate down, and its travel."""
    sheet, before = case.sheet, first.bends[0].result
    mesh = before.model.mesh
    model = Model(
        mesh,
        sheet.element,
        material=sheet.material,
        thickness_points=sheet.thickness_points,
        rolling=sheet.rolling_direction,
        plane_strain=sheet.plane_strain,
    )
    continued(model, before, _on_the_table(case, first))
    x = mesh.points + model.u.reshape(-1, 3)
    model.fix(np.arange(len(x)), "y", here=True)
    model.fix("x1", "x", here=True, name="stop")
    single = touching(sheet).values()
    how: dict[str, Any] = {"penalty": max(contact.penalty for contact in single), "points": _POINTS}
    top = float(x[:, 2].max())
    model.contact("lower", Plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), name="table", **how)
    plate = model.contact("lower", Plane((0.0, 0.0, top), (0.0, 0.0, -1.0)), name="plate", **how)
    if case.insert:
        model.contact("upper", _insert(case, Strip.of(mesh, model.u)), name="insert", **how)
    plate.tool.may_bottom = case.insert
    control = model.drive(plate, "-z", name="stroke")
    model.rest()
    return model, control, top - case.height


def _on_the_table(case: Hemming, first: Part) -> RigidMotion:
    """Motion that places the outer face of the base on z = 0, its middle at the same x as in the flat strip."""
    bent = first.bends[0]
    u = bent.result.model.u
    leg = Strip.of(bent.result.model.mesh, u).at(case.flange, over=False).sides(case.first.zone(bent.bend)).right_leg
    angle = -math.atan2(leg.direction[1], leg.direction[0])
    return RigidMotion.in_section(angle, leg.point, np.array([case.flange, 0.0]))


def _insert(case: Hemming, strip: Strip) -> Box:
    """Plate on the base, from a distance from the inner face at the bend line to beyond the end of the base."""
    bend = int(np.abs(strip.reference[:, 0, 0] - case.flange).argmin())
    edge = float(strip.current[bend, -1, 0]) + case.insert_edge
    long, wide = 2.0 * (case.flange + case.base), 200.0 * case.sheet.thickness
    centre = (edge + 0.5 * long, 0.5 * case.sheet.thickness, case.sheet.thickness + 0.5 * case.gap)
    return Box(centre, (long, wide, case.gap), _ROUND * case.gap)


def _refuse_touch(case: Hemming, strip: Strip, left: float) -> None:
    """Refuse a flange that has passed through the base."""
    if clearances(case, strip).min() < _TOUCHES * case.sheet.thickness:
        raise InvalidValue(
            "the flange of an open hem touches the base, and the sheet has no contact with itself",
            where="gap",
            value=case.gap,
            cause=f"it touches at a gap of about {case.gap + left:.3g}: the bend stands higher than the tip",
            remedy="a larger gap, or insert=True: a plate of the thickness gap between flange and base",
        )
