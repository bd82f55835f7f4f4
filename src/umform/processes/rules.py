"""Rules for the parameters of ready processes: valid values, and the error for others."""

from __future__ import annotations

import math
from numbers import Integral, Real
from typing import Any

from umform.errors import InvalidValue
from umform.spec import Rule
from umform.spec.types import FARTHEST


def whole(value: Any, least: int, most: float = math.inf) -> bool:
    """Whether a value is a whole number between two others."""
    return not isinstance(value, bool) and isinstance(value, Integral) and least <= int(value) <= most


def number(value: Any) -> bool:
    """Whether a value is a finite number."""
    return not isinstance(value, bool) and isinstance(value, Real) and math.isfinite(value)


def positive(value: Any) -> bool:
    """Whether a value is a finite number above zero."""
    return number(value) and value > 0


def bound(value: float) -> float:
    """A bound of a search; one beyond `FARTHEST` is none, since squares would overflow."""
    return value if abs(value) <= FARTHEST else math.copysign(math.inf, value)


def length(what: str, remedy: str) -> Rule:
    """A length, or another quantity that is positive and finite."""
    return Rule(positive, f"{what} must be positive and finite", "a sign, or a missing value", remedy)


def _is_plastic(value: Any) -> bool:
    from umform.materials.j2 import Plastic  # imported late: the command line works without NumPy until it needs a law

    return isinstance(value, Plastic)


#: A plastic law.
PLASTIC = Rule(
    _is_plastic,
    "forming needs a plastic material",
    "an elastic law, or the name of a metal",
    "a J2 or a Metal; umform.sheet_metals.get('DC04').law for one",
)

#: A law without a rate: how long the steps of a process take is not said.
WITHOUT_RATE = Rule(
    lambda value: getattr(value, "rate", None) is None,
    "the tools of a ready process have no speed",
    "a metal whose yield stress depends on the rate",
    "a metal without a rate; for one with it a deck (--print-deck) whose steps have a time",
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


def check_contact_points(name: Any, points: Any) -> None:
    """Reject one contact point on the faces of an element of 18 nodes, which its other nodes pass freely.

    Parameters
    ----------
    name : str or Element
        The element.
    points : object
        Contact points per direction and facet.

    Raises
    ------
    InvalidValue
        ``where`` is "contact_points".
    """
    if points != 1:
        return
    from umform.elements import element  # not for the help of the command

    made = element(name)
    if made.cell == "hex18":
        raise InvalidValue(
            "one contact point does not hold a face of nine nodes",
            where="contact_points",
            value=points,
            cause=f"the element {made.name} has 18 nodes: those between the points pass into the tool",
            remedy="2 or more",
        )
