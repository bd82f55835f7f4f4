"""Rules for the parameters of ready processes: valid values, and the error for others."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any

from umform.errors import InvalidValue, NotFinite


@dataclass(frozen=True)
class Rule:
    """Condition on a parameter.

    Attributes
    ----------
    fits : callable
        Whether a value is valid.
    what : str
        What is wrong otherwise.
    cause, remedy : str
        Likely cause, and remedy.
    """

    fits: Callable[[Any], bool]
    what: str
    cause: str
    remedy: str

    def optional(self) -> Rule:
        """The same for an optional parameter, which may be None."""
        return Rule(lambda value: value is None or self.fits(value), self.what, self.cause, self.remedy)

    def check(self, name: str, value: Any) -> None:
        """Reject an invalid value.

        Raises
        ------
        NotFinite
            If it is NaN or infinite.
        InvalidValue
            ``where`` is the name.
        """
        if not self.fits(value):
            kind = NotFinite if isinstance(value, float) and not math.isfinite(value) else InvalidValue
            raise kind(self.what, where=name, value=_shown(value), cause=self.cause, remedy=self.remedy)


def check_rules(values: Mapping[str, Any], rules: Mapping[str, Rule]) -> None:
    """Reject invalid values by name, one by one."""
    for name, rule in rules.items():
        rule.check(name, values[name])


def whole(value: Any, least: int, most: float = math.inf) -> bool:
    """Whether a value is a whole number between two others."""
    return not isinstance(value, bool) and isinstance(value, Integral) and least <= int(value) <= most


def number(value: Any) -> bool:
    """Whether a value is a finite number."""
    return not isinstance(value, bool) and isinstance(value, Real) and math.isfinite(value)


def positive(value: Any) -> bool:
    """Whether a value is a finite number above zero."""
    return number(value) and value > 0


def length(what: str, remedy: str) -> Rule:
    """A length, or another quantity that is positive and finite."""
    return Rule(positive, f"{what} must be positive and finite", "a sign, or a missing value", remedy)


def plastic_material(what: str) -> Rule:
    """A plastic law; ``what`` names what needs it."""
    from umform.materials.j2 import Plastic  # imported late: the command line works without NumPy until it needs a law

    return Rule(
        lambda value: isinstance(value, Plastic),
        f"{what} needs a plastic material",
        "an elastic law, or the name of a metal",
        "a J2 or a Metal; umform.sheet_metals.get('DC04').law for one",
    )


def contact_points(remedy: str) -> Rule:
    """Contact points per direction of a facet."""
    return Rule(
        lambda value: whole(value, 1, 10),
        "contact points per direction must be a whole number from 1 to 10",
        "zero, or a rule that does not exist",
        remedy,
    )


#: A coefficient of friction.
FRICTION = Rule(
    lambda value: number(value) and 0.0 <= value <= 2.0,
    "a coefficient of friction lies between 0 and 2",
    "a sign, or a percentage",
    "0.05 to 0.2 for lubricated sheet",
)
#: The rolling direction of a sheet that is bent about one line.
ROLLING = Rule(
    lambda value: value is None or (number(value) and abs(value) <= 180.0),
    "the rolling direction is an angle to the bend line from -180 to 180 degrees",
    "a vector in place of an angle",
    "0 along the bend line, 90 across it",
)


def check_rolling(material: Any, rolling: float | None) -> None:
    """Reject an anisotropic law without its rolling direction.

    Raises
    ------
    InvalidValue
        ``where`` is "rolling".
    """
    if rolling is None and getattr(material, "directional", False):
        raise InvalidValue(
            "this material differs along and across the rolling direction, which is not given",
            where="rolling",
            value=rolling,
            cause="its yield function has directions",
            remedy="rolling=90 for a bend across the rolling direction, rolling=0 for one along it",
        )


def _shown(value: object) -> str:
    """A value as typed by hand: a mesh as 24x1."""
    if isinstance(value, tuple | list):
        return "x".join(map(str, value))
    return str(value)
