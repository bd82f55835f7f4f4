"""The deck of a bend."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from umform.elements import element
from umform.errors import InvalidValue
from umform.problem.keys import law_keys
from umform.problem.written import Entry, deck_text
from umform.processes.air_bending.brake import OPTIONS, loading, unloading_keys
from umform.processes.air_bending.goal import needed_stroke
from umform.processes.air_bending.sheet import lines_of
from umform.processes.air_bending.spec import AirBending
from umform.surfaces import Profile
from umform.surfaces.segments import Arc, Segment


def deck_of(case: AirBending) -> str:
    """Deck of a bend; it gives the same history as `air_bending`, to the last bit.

    Parameters
    ----------
    case : AirBending
        The parameters, with a stroke.

    Raises
    ------
    InvalidValue
        If the case has no stroke, or if a deck cannot express its hardening or its element.
    """
    stroke = needed_stroke(case)
    if case.width is None:
        modelled, kind = case.thickness, "in plane strain"
    else:
        modelled, kind = 0.5 * case.width, f"{case.width:g} mm wide"
    remarks = [
        f"Air bending of a sheet of {case.thickness:g} mm, {kind}, over an opening of {case.opening:g} mm: down by "
        f"{stroke:.6g} mm, and back to zero force. Units: mm, N, MPa.",
        f"Half of the sheet, {modelled:g} mm of its width: the force for each mm of the bend is stroke_force times "
        f"{2.0 / modelled:.6g}.",
    ]
    return deck_text("Air bending", remarks, _entries(case, stroke))


def _entries(case: AirBending, stroke: float) -> Iterator[Entry]:
    lines = dict(zip("xyz", (line.tolist() for line in lines_of(case)), strict=True))
    yield "[mesh]", {"generator": "grid", **lines}
    yield (
        "[element]",
        {
            "name": _element_name(case),
            "thickness_points": case.thickness_points,
            "plane_strain": case.plane_strain,
        },
    )
    rolling = None if case.rolling is None else {"angle": float(case.rolling)}
    yield "[material]", law_keys(case.material, rolling)
    yield "[tools.die]", _die(case)
    yield "[tools.punch]", _punch(case)
    for tool, faces in (("die", "lower"), ("punch", "upper")):
        how = {"penalty": case.penalty, "penetration": case.penetration, "points": case.contact_points}
        yield f"[contacts.{tool}]", {"tool": tool, "faces": faces, **how}
    yield "[[supports]]", {"kind": "symmetry", "nodes": "x0", "normal": "x"}
    yield "[[supports]]", _across(case)
    yield "[controls.stroke]", {"kind": "tool", "contact": "punch", "direction": "-z"}
    for end, count in loading(case, stroke):
        yield "[[steps]]", {"kind": "move", "to": {"stroke": end}, "increments": count}
    yield "[[steps]]", {"kind": "release", "control": "stroke", **unloading_keys(case)}
    tolerances = {"residual": OPTIONS.residual, "increment": OPTIONS.increment}
    yield "[solution]", {**tolerances, "line_search": OPTIONS.line_search, "extrapolate": OPTIONS.extrapolate}


def _die(case: AirBending) -> dict[str, Any]:
    if case.die_section is not None:
        return {"shape": "Extruded", "profile": _profile(case.die_section.profile)}
    return {"shape": "VDie", "opening": case.opening, "angle": case.die_angle, "shoulder_radius": case.die_radius}


def _punch(case: AirBending) -> dict[str, Any]:
    if case.punch_section is not None:
        shape: dict[str, Any] = {"shape": "Extruded", "profile": _profile(case.punch_section.profile)}
    else:
        tip = {"tip_radius": case.punch_radius, "angle": case.punch_angle, "width": case.punch_width}
        shape = {"shape": "Punch", **tip}
    return {**shape, "origin": case.punch.origin}


def _profile(profile: Profile) -> dict[str, Any]:
    """A drawn section by its lines and arcs: the deck needs no drawing beside it."""
    return {"segments": [_segment(segment) for segment in profile.segments], "closed": profile.closed}


def _segment(segment: Segment) -> dict[str, Any]:
    ends = {"start": segment.start, "end": segment.end}
    if isinstance(segment, Arc):
        return {"kind": "arc", **ends, "centre": segment.centre, "clockwise": bool(segment.clockwise)}
    return {"kind": "line", **ends}


def _element_name(case: AirBending) -> str:
    if not isinstance(case.element, str):
        raise InvalidValue(
            "a deck has no words for this element",
            where="element",
            value=case.element.name,
            cause="a deck names an element of the catalogue; this one is your own",
            remedy="take one of `umform elements`, or run the bend in Python",
        )
    return element(case.element).name


def _across(case: AirBending) -> dict[str, Any]:
    """Supports along the bend."""
    if case.width is None:
        everywhere = {"min": [-float("inf")] * 3}
        return {"kind": "fix", "nodes": everywhere, "directions": "y"}
    return {"kind": "symmetry", "nodes": "y0", "normal": "y"}
