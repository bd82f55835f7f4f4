"""Checks of the parameters of hemming."""

from __future__ import annotations

from typing import Any, Protocol

from umform.errors import InvalidValue
from umform.processes.rules import length, whole
from umform.spec import Rule


class Hemming(Protocol):
    """Parameters of :class:`umform.processes.hemming.Hemming` that the checks use."""

    @property
    def angle(self) -> float:
        """Angle after the first bend."""

    @property
    def flange(self) -> float:
        """Length of the flange."""

    @property
    def base(self) -> float:
        """Length of the base."""

    @property
    def first(self) -> Any:
        """The first bend."""


#: Range of angles of the first bend: larger ones cannot be flattened between plates.
_SHARPEST, _BLUNTEST = 20.0, 70.0
_RULES = {
    "gap": length("the gap of a hem", "in mm, such as the thickness of the sheet"),
    "flange": length("the length of the flange", "in mm, such as 12"),
    "base": length("the length of the base", "in mm, such as 30"),
    "insert_from": length("the distance of the insert", "in mm; omit it for three thicknesses").optional(),
    "increments": Rule(
        lambda value: whole(value, 6, 10000), "a hem takes 6 increments at least", "a length", "60 is usual"
    ),
}


def check_hemming(hem: Hemming) -> None:
    """Refuse lengths that do not fit, and a first bend that is not acute; the first bend has its own checks.

    Raises
    ------
    InvalidValue
        ``where`` is the name of the parameter.
    """
    for name, rule in _RULES.items():
        rule.check(name, getattr(hem, name))
    if not _SHARPEST <= hem.angle <= _BLUNTEST:
        raise InvalidValue(
            f"the first bend of a hem has {_SHARPEST:g} to {_BLUNTEST:g} degrees between its legs",
            where="angle",
            value=hem.angle,
            cause="the angle of bending in place of that between the legs",
            remedy="40, with a die and a punch of 30 degrees",
        )
    if hem.base < hem.flange:
        raise InvalidValue(
            "the base of a hem is longer than its flange",
            where="base",
            value=hem.base,
            cause="the two exchanged",
            remedy=f"more than {hem.flange:g}",
        )
    _ = hem.first  # refuses a flange that is too short for the die
