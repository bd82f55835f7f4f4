"""What is wanted of a bend: a stroke or an angle, and whether the tools allow it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from annotated_types import Ge, Le

from umform.errors import InvalidValue
from umform.processes.air_bending.spec import AirBending
from umform.spec import About, check_value
from umform.spec.types import Degrees, Positive

#: Smallest usual ratio of the opening to the thickness.
_USUAL = 5.0


@dataclass(frozen=True)
class Goal:
    """What is wanted of one bend, besides a stroke."""

    groups: ClassVar = {"angle": "What to do", "tolerance": "Solution"}
    """Group of the parameters from each of these on."""

    angle: Degrees | None = None
    """Angle between the legs after springback; the stroke for it is found."""
    force_per_metre: Annotated[Positive, Le(1e6), About("kN/m", remedy="3 to 5 times that of air bending")] | None = (
        None
    )
    """Force of bottoming."""
    travel: Annotated[float, About("mm")] | None = None
    """Way beyond the stroke at which tip and flanks are one thickness apart; of bottoming."""
    # Unloading ends at a small force, not at zero (`brake`): an error of the angle of about the lower bound.
    tolerance: Annotated[float, Ge(0.001), Le(10.0), About("degrees", cause="radians, or a part of the angle")] = 0.02
    """Tolerance of the angle."""


def needed_stroke(case: AirBending, of: str = "") -> float:
    """The stroke of a case that must have one.

    Parameters
    ----------
    case : AirBending
        The case.
    of : str
        Path of the bend, if it is one of several.

    Raises
    ------
    InvalidValue
        If it has none.
    """
    if case.stroke is None:
        raise InvalidValue(
            "the way of the punch is missing",
            where=f"{of}.stroke" if of else "stroke",
            remedy="those of a run to its angles: with_strokes of its part"
            if of
            else "AirBending(stroke=6.0), or find_stroke(case, angle).case",
        )
    return case.stroke


def check_angle(case: AirBending, angle: float) -> None:
    """Refuse an angle that air bending with these tools cannot reach.

    Raises
    ------
    InvalidValue
        If the angle is not between 0 and 180 degrees, or not above those of punch and die.
    """
    check_value(Goal, "angle", angle)
    least = max(case.die_angle, case.punch_angle)
    if angle <= least:
        raise unreachable(case, angle, f"the larger of the angles of punch and die is {least:.4g}")


def unreachable(case: AirBending, angle: float, cause: str) -> InvalidValue:
    """Error for an angle that is not reached before the sheet touches a flank."""
    over_thickness = case.opening / case.thickest
    if over_thickness < _USUAL:
        return InvalidValue(
            "the angle cannot be reached before the sheet lies against a flank",
            where="angle",
            value=angle,
            cause=f"{cause}; the opening V of the die is small: V/t = {over_thickness:.3g}",
            remedy=f"a wider opening, such as {8.0 * case.thickest:.4g} (V/t = 8)",
        )
    return InvalidValue(
        "the angle cannot be reached before the sheet lies against a flank",
        where="angle",
        value=angle,
        cause=cause,
        remedy="punch and die of smaller angle, some degrees below the wanted one for springback",
    )
