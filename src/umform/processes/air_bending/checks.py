"""What the parameters of air bending may be; what does not fit is refused with its likely cause and remedy."""

from __future__ import annotations

import math
from collections.abc import Mapping
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any

from umform.errors import InvalidValue, NotFinite
from umform.materials import J2

if TYPE_CHECKING:
    from umform.processes.air_bending.parameters import AirBending

_LENGTHS = {
    "thickness": "the thickness of the sheet, such as 2",
    "opening": "the opening of the die, such as 8 times the thickness",
    "die_radius": "the radius of the shoulders, such as 2",
    "punch_radius": "the radius of the tip, such as 1.5",
    "width": "the length of the bend, such as 50; leave it out for plane strain",
    "stroke": "the way of the punch, downwards, such as 6",
    "penalty": "pressure per penetration; leave it out for E / thickness",
    "penetration": "a length such as thickness / 500; leave it out, or the penalty",
    "increment": "a part of the opening, such as 0.00625",
    "elements_per_thickness": "such as 3",
}
_OPTIONAL = ("width", "stroke", "penalty", "penetration")
_COUNTS = {"layers": (1, 8), "thickness_points": (2, 15), "width_elements": (1, 1000), "contact_points": (1, 10)}
#: A larger increment jumps over the first contact.
_LARGEST_INCREMENT = 0.05


def check_parameters(values: Mapping[str, Any]) -> None:
    """Refuse parameters that do not fit, each by itself.

    Raises
    ------
    NotFinite, InvalidValue
        ``where`` is the name of the parameter.
    """
    for name, remedy in _LENGTHS.items():
        value = values[name]
        if not (value is None and name in _OPTIONAL):
            _check_positive(name, value, remedy)
    for name in ("die_angle", "punch_angle"):
        _check_positive(name, values[name], "in degrees, such as 85")
        if not values[name] < 180.0:
            raise InvalidValue("an angle of a tool lies between 0 and 180 degrees", where=name, value=values[name])
    if values["penalty"] is not None and values["penetration"] is not None:
        raise InvalidValue(
            "the penalty follows from the penetration that is allowed",
            where="penetration",
            value=values["penetration"],
            cause="both are given",
            remedy="leave one of them out",
        )
    for name, (least, most) in _COUNTS.items():
        value = values[name]
        if name == "contact_points" and value == "auto":
            continue
        if isinstance(value, bool) or not isinstance(value, Integral) or not least <= int(value) <= most:
            raise InvalidValue(f"{name} must be a whole number from {least} to {most}", where=name, value=value)
    if values["increment"] > _LARGEST_INCREMENT:
        raise InvalidValue(
            f"an increment is at most {_LARGEST_INCREMENT} of the opening",
            where="increment",
            value=values["increment"],
            cause="a length in mm instead of a part of the opening",
            remedy="0.00625 is usual",
        )
    if not isinstance(values["material"], J2):
        raise InvalidValue(
            "air bending needs a plastic material", where="material", value=values["material"], remedy="a J2"
        )


def check_geometry(case: AirBending) -> None:
    """Refuse tools between which the sheet finds no room, and strokes beyond the end of air bending.

    Raises
    ------
    InvalidValue
        ``where`` is the name of the parameter that is the likeliest to be wrong.
    """
    tip = 2.0 * case.punch_radius * math.cos(math.radians(0.5 * case.punch_angle))
    if tip >= case.opening:
        raise InvalidValue(
            "the tip of the punch is wider than the opening of the die",
            where="punch_radius",
            value=case.punch_radius,
            cause=f"the tip is round on a width of {tip:.4g}, the opening is {case.opening:.4g}",
            remedy="a smaller punch_radius, or a wider opening",
        )
    flank = 0.5 * case.opening / math.sin(math.radians(0.5 * case.die_angle))  # from the top to the point of the V
    setback = case.die_radius * math.tan(math.radians(0.25 * (180.0 - case.die_angle)))
    if setback >= flank:
        raise InvalidValue(
            "the shoulders of the die are rounder than its flanks are long",
            where="die_radius",
            value=case.die_radius,
            cause=f"each takes {setback:.4g} of a flank of {flank:.4g}",
            remedy="a smaller die_radius, or a wider opening",
        )
    if case.free_length(case.steepest) <= 0.0:
        raise InvalidValue(
            "the sheet does not find room between punch and shoulders: it would be drawn, not bent",
            where="opening",
            value=case.opening,
            cause=f"bent to {180.0 - 2.0 * case.steepest:.4g} degrees around the tip, a leg is longer than the flank",
            remedy="an opening of 6 to 12 thicknesses, or smaller radii",
        )
    if case.stroke is not None and case.stroke > case.largest_stroke:
        raise InvalidValue(
            "the stroke goes beyond air bending: the sheet would be pressed against a flank",
            where="stroke",
            value=case.stroke,
            cause=f"with these tools a leg lies against a flank at {case.largest_stroke:.4g} at the latest",
            remedy="a smaller stroke, or sharper angles of punch and die",
        )


def needed_stroke(case: AirBending) -> float:
    """The stroke of a case that must have one.

    Raises
    ------
    InvalidValue
        If it has none.
    """
    if case.stroke is None:
        raise InvalidValue(
            "the way of the punch is missing",
            where="stroke",
            remedy="AirBending(stroke=6.0), or find_stroke(case, angle).case",
        )
    return case.stroke


def check_angle(case: AirBending, angle: float) -> None:
    """Refuse an angle that air bending with these tools cannot reach.

    Raises
    ------
    InvalidValue
        If the angle is no angle of a bend, or not above those of punch and die.
    """
    _check_positive("angle", angle, "in degrees, such as 90")
    if angle >= 180.0:
        raise InvalidValue("a bend has an angle below 180 degrees", where="angle", value=angle)
    least = max(case.die_angle, case.punch_angle)
    if angle <= least:
        raise unreachable(angle, f"the larger of the angles of punch and die is {least:.4g}")


def unreachable(angle: float, cause: str) -> InvalidValue:
    """Error for an angle that the sheet does not take before it lies against a flank."""
    return InvalidValue(
        "the angle cannot be reached before the sheet lies against a flank",
        where="angle",
        value=angle,
        cause=cause,
        remedy="punch and die of smaller angle, some degrees below the wanted one for springback",
    )


def _check_positive(name: str, value: Any, remedy: str) -> None:
    number = isinstance(value, Real) and not isinstance(value, bool)
    if number and not math.isfinite(value):
        raise NotFinite(f"{name} is not a finite number", where=name, value=value)
    if not number or not value > 0:
        raise InvalidValue(f"{name} must be a positive number", where=name, value=value, remedy=remedy)
