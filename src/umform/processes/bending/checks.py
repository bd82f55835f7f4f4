"""What the parameters of free bending may be; a value that does not fit is refused with its likely cause and remedy."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from umform.errors import InvalidValue
from umform.processes.rules import check_rules, length, number, positive, whole
from umform.spec import Rule


def _two_counts(value: Any) -> bool:
    return isinstance(value, tuple | list) and len(value) == 2 and all(whole(count, 1) for count in value)


def _mm(what: str, usual: str) -> Rule:
    return length(what, f"in mm, such as {usual}")


def _mpa(what: str, usual: str) -> Rule:
    return length(what, f"in MPa, such as {usual}")


#: One rule a parameter; element and solver are looked up where the catalogues are.
RULES: dict[str, Rule] = {
    "length": _mm("the length of the half strip", "60"),
    "width": _mm("the width of the strip", "10"),
    "thickness": _mm("the thickness of the strip", "1"),
    "radius": _mm("the radius of the cylinder", "20"),
    "tool_x": Rule(
        number,
        "the x of the axis of the cylinder must be a finite number",
        "a missing value",
        "in mm, such as 25; the strip begins at 0",
    ),
    "tool_z": Rule(
        lambda value: value is None or number(value),
        "the z of the axis of the cylinder must be a finite number",
        "a missing value",
        "omit it: then the cylinder touches the strip",
    ),
    "kappa": _mpa("the bulk modulus", "175000"),
    "mu": _mpa("the shear modulus", "80770"),
    "yield_stress": _mpa("the yield stress", "160"),
    "hardening": Rule(
        lambda value: number(value) and value >= 0,
        "the hardening modulus must be finite and not negative",
        "softening needs a length scale that this law does not have",
        "0 is perfect plasticity",
    ),
    "penalty": Rule(
        positive,
        "the penalty must be positive and finite",
        "a sign, or a missing value",
        "choose it from the penetration that you allow: expected pressure / penetration, such as 100",
    ),
    "stroke": Rule(
        positive,
        "the stroke must be positive and finite",
        "a sign: the stroke counts downwards",
        "in mm, such as 15",
    ),
    "steps": Rule(
        lambda value: whole(value, 1),
        "the number of increments must be a whole number from 1",
        "zero or a sign",
        "such as 300; with fewer than 60 the forces are coarse",
    ),
    "mesh": Rule(
        _two_counts,
        "a mesh has one element or more along and across the strip",
        "zero, or one of the two numbers is missing",
        "such as 24x1",
    ),
    "contact": Rule(
        lambda value: value == "nodes" if isinstance(value, str) else whole(value, 1, 10),
        "contact points per direction must be 1 to 10, or nodes",
        "more points than there are rules for, or all points of a facet instead of those of one direction",
        "such as 2, 5 or nodes",
    ),
    "thickness_points": Rule(
        lambda value: whole(value, 2, 15),
        "the number of thickness points must lie between 2 and 15",
        "there are no rules with fewer or more points",
        "such as 5, or 8 with a cubic thickness strain",
    ),
    "thickness_rule": Rule(
        lambda value: value in ("gauss", "lobatto", "split"),
        "unknown thickness rule",
        "a typing error",
        "gauss, lobatto or split",
    ),
    "thickness_order": Rule(
        lambda value: whole(value, 1, 4),
        "the order of the thickness strain must be 1 to 4",
        "there are no modes of other orders",
        "1 is the paper, 3 is for sharp bends",
    ),
}


def check_parameters(values: Mapping[str, Any]) -> None:
    """Reject parameters of free bending that do not fit, each by itself and then together.

    Parameters
    ----------
    values : mapping
        Names and values.

    Raises
    ------
    NotFinite
        If a number is NaN or infinite.
    InvalidValue
        If a value does not fit; ``where`` is the name of the parameter.
    """
    check_rules(values, RULES)
    _check_thickness(values["thickness_points"], values["thickness_order"], values["thickness_rule"])
    _check_room(values)


def _check_room(values: Mapping[str, Any]) -> None:
    """Reject a stroke that the cylinder and its mirror image leave no room for.

    The sheet can at most be folded about its upper face: its lower face is then an arc of radius t about a point of
    x = 0, which goes down with the stroke and must stay clear of the cylinder.
    """
    t, R, x, stroke = (values[name] for name in ("thickness", "radius", "tool_x", "stroke"))
    z = -(R + 0.5 * t) if values["tool_z"] is None else values["tool_z"]
    if not 0.0 <= x < R + t or z >= 0.5 * t:
        return
    room = 0.5 * t - z - math.sqrt((R + t) ** 2 - x**2)
    if 0.0 <= room < stroke:
        raise InvalidValue(
            "the cylinder leaves no room for the stroke",
            where="stroke",
            value=stroke,
            cause=f"between it, with radius {R:g} at x = {x:g}, and its mirror image a sheet of {t:g} can go down by "
            f"{room:.4g} at most",
            remedy=f"a smaller stroke, a smaller radius, or tool_x={R + t:g} or more",
        )


def _check_thickness(points: int, order: int, rule: str) -> None:
    if points <= order:
        raise InvalidValue(
            f"thickness order {order} needs at least {order + 1} thickness points",
            where="thickness_points",
            value=points,
            cause="fewer points cannot see the highest mode",
            remedy=f"thickness_points={order + 1} or more",
        )
    if rule == "split" and points % 2:
        raise InvalidValue(
            "the split rule needs an even number of thickness points",
            where="thickness_points",
            value=points,
            cause="it puts as many points into one half of the thickness as into the other",
            remedy=f"thickness_points={points - 1 if points == 15 else points + 1}",
        )
