"""Checks of the parameters of a draw bead; errors name the likely cause and remedy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from umform.errors import InvalidValue
from umform.processes.rules import (
    FRICTION,
    PLASTIC,
    check_rolling,
    check_rules,
    contact_points,
    length,
    number,
    positive,
)
from umform.spec import Rule

#: Range of the radii in thicknesses: sharper ones crush the sheet, larger ones are no bead.
_SHARPEST, _ROUNDEST = 1.0, 200.0

RULES: dict[str, Rule] = {
    "thickness": length("the thickness of the sheet", "in mm, such as 0.8"),
    "material": PLASTIC,
    "radius": length("the radius of the bead", "in mm, such as 5.5"),
    "height": length("the height of the bead", "in mm, such as 6"),
    "groove_radius": length("the radius of the edges of the groove", "in mm, such as 5"),
    "groove": length("the width of the groove", "in mm; omit it for bead, sheet and 10 % of air").optional(),
    "gap": Rule(
        lambda value: number(value) and value >= 0.0,
        "the gap beside the sheet between the flats must be zero or more",
        "a sign, or the distance of the flats in place of the air beside the sheet",
        "in mm, such as 0.04; omit it for 5 % of the thickness",
    ).optional(),
    "friction": FRICTION,
    "draw": length("the way that the strip is drawn", "in mm; omit it for 1.5 times the way through").optional(),
    "elements": Rule(
        lambda value: positive(value) and 2.0 <= value <= 100.0,
        "the number of elements on a quarter turn of the sharper radius lies between 2 and 100",
        "the number of all elements in place of those on an arc",
        "20 is usual, 10 with 18 nodes",
    ),
    "contact_points": contact_points("such as 4"),
    "penalty": Rule(
        positive,
        "the penalty must be positive",
        "a sign or a missing value",
        "in MPa/mm, such as 1e5; omit it",
    ).optional(),
}


class Geometry(Protocol):
    """Parameters of :class:`umform.processes.draw_bead.DrawBead` that the checks use."""

    @property
    def thickness(self) -> float:
        """Thickness of the sheet."""

    @property
    def radius(self) -> float:
        """Radius of the bead."""

    @property
    def groove_radius(self) -> float:
        """Radius of the edges of the groove."""

    @property
    def draw(self) -> float | None:
        """Travel of the strip."""

    @property
    def half_bead(self) -> float:
        """Half of the width of the bead."""

    @property
    def width(self) -> float:
        """Width of the groove."""

    @property
    def through(self) -> float:
        """Length of the path of the strip through the bead."""


def check_parameters(values: Mapping[str, Any]) -> None:
    """Reject invalid parameters one by one.

    Raises
    ------
    NotFinite, InvalidValue
        ``where`` is the name of the parameter.
    """
    check_rules(values, RULES)
    check_rolling(values["material"], values["rolling"])


def check_geometry(case: Geometry) -> None:
    """Reject tools that leave no room for the sheet, and a travel that ends before the force is steady.

    Raises
    ------
    InvalidValue
        ``where`` is the parameter that is most likely wrong.
    """
    for name in ("radius", "groove_radius"):
        ratio = getattr(case, name) / case.thickness
        if not _SHARPEST <= ratio <= _ROUNDEST:
            raise InvalidValue(
                "a radius of the bead does not fit the thickness of the sheet",
                where=name,
                value=getattr(case, name),
                cause=f"it is {ratio:.3g} thicknesses; another unit, or the two exchanged",
                remedy=f"{_SHARPEST:g} to {_ROUNDEST:g} thicknesses; 4 to 10 are usual",
            )
    least = 2.0 * (case.half_bead + case.thickness)
    if case.width <= least:
        raise InvalidValue(
            "the groove has no room for the bead and the sheet on both sides of it",
            where="groove",
            value=case.width,
            cause=f"bead and two thicknesses take {least:.4g}",
            remedy="a wider groove, or omit it",
        )
    if case.draw is not None and case.draw < 1.2 * case.through:
        raise InvalidValue(
            "the strip is not drawn far enough for a steady force",
            where="draw",
            value=case.draw,
            cause=f"the way through the bead is {case.through:.4g}",
            remedy=f"{1.2 * case.through:.4g} at least, or omit it",
        )
