"""Checks of the parameters of air bending; errors name the likely cause and remedy."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Protocol

from umform.errors import InvalidValue
from umform.processes.air_bending.rules import RULES, angle_rule
from umform.processes.rules import Rule, check_rolling, check_rules, number

#: Range of opening over thickness for air bending; press brakes use 5 to 16.
_NARROWEST, _WIDEST = 1.0, 500.0
#: Smallest usual opening over thickness.
_USUAL = 5.0
#: Penalty times thickness over E beyond which Newton's method converges slowly.
_STIFFEST = 1e3


class Geometry(Protocol):
    """Parameters of :class:`umform.processes.air_bending.AirBending` that the checks use."""

    @property
    def thickness(self) -> float:
        """Thickness of the sheet."""

    @property
    def opening(self) -> float:
        """Opening of the die."""

    @property
    def die_angle(self) -> float:
        """Angle between the flanks of the die."""

    @property
    def die_radius(self) -> float:
        """Radius of the die shoulders."""

    @property
    def punch_angle(self) -> float:
        """Angle between the flanks of the punch."""

    @property
    def punch_radius(self) -> float:
        """Radius of the punch tip."""

    @property
    def material(self) -> Any:
        """Law of the sheet."""

    @property
    def rolling(self) -> float | None:
        """Degrees from the bend line to the rolling direction."""

    @property
    def width(self) -> float | None:
        """Length of the bend."""

    @property
    def penalty(self) -> float | None:
        """Contact pressure per penetration."""

    @property
    def stroke(self) -> float | None:
        """Way of the punch."""

    def free_length(self, slope: float) -> float:
        """Free length of the leg at a slope."""

    @property
    def bottoming(self) -> bool:
        """Whether the punch may press the sheet onto the flanks of the die."""

    @property
    def punch_width(self) -> float | None:
        """Width of the body of the punch."""

    @property
    def largest_stroke(self) -> float:
        """Stroke at which the sheet touches a flank."""

    @property
    def stroke_limit(self) -> float:
        """The largest stroke that is taken."""

    @property
    def steepest(self) -> float:
        """Smallest angle that the tools allow."""


#: The force that counts as zero after unloading leaves about the smallest of these as error; see `brake`.
_FINEST, _COARSEST = 0.001, 10.0
_TOLERANCE = Rule(
    lambda value: number(value) and _FINEST <= value <= _COARSEST,
    f"the tolerance of an angle is {_FINEST:g} to {_COARSEST:g} degrees",
    "a sign, radians, or a part of the angle",
    "0.02 is usual",
)
_WANTED = angle_rule(
    "the angle of a bend", "the angle by which the sheet is bent in place of that between the legs", "90"
)


def check_parameters(values: Mapping[str, Any]) -> None:
    """Refuse invalid parameters one by one, and a penalty given together with the allowed penetration.

    Raises
    ------
    NotFinite, InvalidValue
        ``where`` is the name of the parameter.
    """
    check_rules(values, RULES)
    if values["penalty"] is not None and values["penetration"] is not None:
        raise InvalidValue(
            "the penalty follows from the penetration that is allowed",
            where="penetration",
            value=values["penetration"],
            cause="both are given",
            remedy="leave one of them out",
        )


def check_geometry(case: Geometry) -> None:
    """Refuse tools that leave no room for the sheet, and strokes beyond the end of air bending.

    Raises
    ------
    InvalidValue
        ``where`` is the parameter that is most likely wrong.
    """
    _check_proportions(case)
    _check_room(case)
    _check_rolling(case)
    _check_bottoming(case)
    if case.stroke is not None and not case.bottoming and case.stroke > case.largest_stroke:
        raise _unfit(
            case,
            "stroke",
            "the stroke goes beyond air bending: the sheet would be pressed against a flank",
            f"with these tools a leg lies against a flank at {case.largest_stroke:.4g} at the latest",
            "a smaller stroke, sharper angles of punch and die, or bottoming=True",
        )


def _check_bottoming(case: Geometry) -> None:
    """Refuse tools that cannot bottom, and strokes that squeeze the sheet by more than half of its thickness."""
    if not case.bottoming:
        return
    if case.punch_angle > case.die_angle:
        raise _unfit(
            case,
            "punch_angle",
            "a punch cannot press the sheet onto the flanks of a sharper die",
            f"the flanks of the die have {case.die_angle:g} degrees: the punch meets its shoulders first",
            "an angle of the punch up to that of the die; 88 and 88, or 90 and 90 are usual",
        )
    if case.stroke is not None and case.stroke > case.stroke_limit:
        raise _unfit(
            case,
            "stroke",
            "the stroke squeezes the sheet by more than half of its thickness",
            f"half a thickness beyond the bottom is {case.stroke_limit:.4g}",
            "a smaller stroke, or a force",
        )


def _check_rolling(case: Geometry) -> None:
    """Refuse an anisotropic law without rolling direction, and one that breaks the symmetry of a half width."""
    check_rolling(case.material, case.rolling)
    anisotropic = getattr(case.material, "directional", False)
    if anisotropic and case.width is not None and (case.rolling or 0.0) % 90.0 != 0.0:
        raise _unfit(
            case,
            "rolling",
            "with a width, the rolling direction must be along or across the bend line",
            "a quarter of the sheet is modelled, and a sheet that is bent at another angle has no such symmetry",
            "rolling=0 or rolling=90, or no width: plane strain takes all angles",
        )


def _unfit(case: Geometry, name: str, what: str, cause: str, remedy: str) -> InvalidValue:
    """Error for a parameter that does not agree with the others."""
    return InvalidValue(what, where=name, value=getattr(case, name), cause=cause, remedy=remedy)


def _check_proportions(case: Geometry) -> None:
    """Refuse an opening and a penalty of an unlikely order of magnitude."""
    if not _NARROWEST <= case.opening / case.thickness <= _WIDEST:
        raise _unfit(
            case,
            "opening",
            "the opening of the die does not fit the thickness of the sheet",
            f"it is {case.opening / case.thickness:.3g} thicknesses; another unit, or the two exchanged",
            f"{_NARROWEST:g} to {_WIDEST:g} thicknesses; press brakes take 5 to 16",
        )
    if case.penalty is not None and case.penalty > _STIFFEST * case.material.E / case.thickness:
        raise _unfit(
            case,
            "penalty",
            "the penalty is so stiff that the run would creep",
            f"it is {case.penalty * case.thickness / case.material.E:.3g} times E / thickness",
            "omit it: it follows from the penetration that is allowed",
        )


def _check_room(case: Geometry) -> None:
    """Refuse a tip that is wider than the die, shoulders without flanks, and a sheet that would be drawn in."""
    tip = 2.0 * case.punch_radius * math.cos(math.radians(0.5 * case.punch_angle))
    if tip >= case.opening:
        raise _unfit(
            case,
            "punch_radius",
            "the tip of the punch is wider than the opening of the die",
            f"the tip is round on a width of {tip:.4g}, the opening is {case.opening:.4g}",
            "a smaller punch_radius, or a wider opening",
        )
    flank = 0.5 * case.opening / math.sin(math.radians(0.5 * case.die_angle))  # from the top to the apex of the V
    setback = case.die_radius * math.tan(math.radians(0.25 * (180.0 - case.die_angle)))
    if setback >= flank:
        raise _unfit(
            case,
            "die_radius",
            "the shoulders of the die are rounder than its flanks are long",
            f"each takes {setback:.4g} of a flank of {flank:.4g}",
            "a smaller die_radius, or a wider opening",
        )
    if case.free_length(case.steepest) <= 0.0:
        raise _unfit(
            case,
            "opening",
            "the sheet does not find room between punch and shoulders: it would be drawn, not bent",
            f"bent to {180.0 - 2.0 * case.steepest:.4g} degrees around the tip, a leg is longer than the flank",
            "an opening of 6 to 12 thicknesses, or smaller radii",
        )


def needed_stroke(case: Geometry) -> float:
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


def check_tolerance(tolerance: float) -> None:
    """Refuse a tolerance of the angle that is too small or too large.

    Raises
    ------
    InvalidValue
    """
    _TOLERANCE.check("tolerance", tolerance)


def check_angle(case: Geometry, angle: float) -> None:
    """Refuse an angle that air bending with these tools cannot reach.

    Raises
    ------
    InvalidValue
        If the angle is not between 0 and 180 degrees, or not above those of punch and die.
    """
    _WANTED.check("angle", angle)
    least = max(case.die_angle, case.punch_angle)
    if angle <= least:
        raise unreachable(case, angle, f"the larger of the angles of punch and die is {least:.4g}")


def unreachable(case: Geometry, angle: float, cause: str) -> InvalidValue:
    """Error for an angle that is not reached before the sheet touches a flank."""
    over_thickness = case.opening / case.thickness
    if over_thickness < _USUAL:
        return InvalidValue(
            "the angle cannot be reached before the sheet lies against a flank",
            where="angle",
            value=angle,
            cause=f"{cause}; the opening V of the die is small: V/t = {over_thickness:.3g}",
            remedy=f"a wider opening, such as {8.0 * case.thickness:.4g} (V/t = 8)",
        )
    return InvalidValue(
        "the angle cannot be reached before the sheet lies against a flank",
        where="angle",
        value=angle,
        cause=cause,
        remedy="punch and die of smaller angle, some degrees below the wanted one for springback",
    )
