"""Polylines with rounded corners as lines and arcs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from umform.errors import InvalidValue
from umform.surfaces.directions import Point2, not_negative, pair, point
from umform.surfaces.segments import Arc, Floats, Line, Segment


class _Rounding(NamedTuple):
    """Where a fillet begins and ends; without a centre the corner stays sharp."""

    start: Point2
    end: Point2
    centre: Point2 | None
    clockwise: bool
    setback: float


def rounded(corners: Sequence[Point2], radii: float | Sequence[float], closed: bool) -> list[Segment]:
    """Lines between corners with arcs that touch both of them. eq. (4.24)

    Parameters
    ----------
    corners : sequence of (x, y)
        Corners in the order of the walk.
    radii : float or sequence of float
        Radius at all corners or at each; 0 leaves a corner sharp. The ends of an open polyline have no radius.
    closed : bool
        The last corner is followed by the first.

    Raises
    ------
    InvalidValue
        If there are too few corners, two of them coincide, or a fillet does not fit.
    """
    at = [np.array(point(corner, f"corner {i}", 2)) for i, corner in enumerate(corners)]
    count = len(at)
    if count < (3 if closed else 2):
        raise InvalidValue(
            "a profile needs more corners",
            where="corners",
            value=count,
            cause="a point or a line encloses nothing",
            remedy="3 if it is closed, 2 if it is open",
        )
    for i in range(count if closed else count - 1):
        if not (at[(i + 1) % count] - at[i]).any():
            raise InvalidValue(
                "two corners that follow each other coincide",
                where=f"corner {i}",
                value=corners[i],
                cause="a corner was given twice",
                remedy="take one of them out; a closed profile needs no last corner like the first",
            )
    wanted = _radii(radii, count, closed)
    roundings = [
        _round(at[i - 1], at[i], at[(i + 1) % count], wanted[i], f"corner {i} at {pair(at[i])}")
        if closed or 0 < i < count - 1
        else _Rounding(pair(at[i]), pair(at[i]), None, False, 0.0)
        for i in range(count)
    ]
    return _joined(at, roundings, closed)


def _radii(radii: float | Sequence[float], count: int, closed: bool) -> list[float]:
    """One radius for each corner."""
    if isinstance(radii, (int, float)):
        return [not_negative(radii, "radii")] * count
    values = [not_negative(radius, f"radius of corner {i}") for i, radius in enumerate(radii)]
    if len(values) != count:
        raise InvalidValue(
            "there must be one radius for each corner",
            where="radii",
            value=f"{len(values)} of {count}",
            cause="a corner was added or left out",
            remedy="one number for all corners, or a list as long as that of the corners",
        )
    if not closed and (values[0] or values[-1]):
        raise InvalidValue(
            "the ends of an open profile are no corners",
            where="radii",
            value=(values[0], values[-1]),
            cause="a radius at an end, where there is nothing to round",
            remedy="0 for the first and the last radius",
        )
    return values


def _round(before: Floats, at: Floats, after: Floats, radius: float, where: str) -> _Rounding:
    """Setback r tan(phi / 2) for a turn by phi, and the centre a radius beside the first tangent point. eq. (4.24)"""
    first, second = (at - before) / np.hypot(*(at - before)), (after - at) / np.hypot(*(after - at))
    sine, cosine = first[0] * second[1] - first[1] * second[0], float(first @ second)
    if abs(sine) < 1e-9 and cosine < 0.0:
        raise InvalidValue(
            "the profile turns back on itself",
            where=where,
            cause="two edges lie on each other",
            remedy="take out the corner, or move it aside",
        )
    if radius == 0.0 or abs(sine) < 1e-9:
        return _Rounding(pair(at), pair(at), None, False, 0.0)
    setback = radius * abs(sine) / (1.0 + cosine)
    start, end = at - setback * first, at + setback * second
    left = math.copysign(1.0, sine) * np.array([-first[1], first[0]])
    return _Rounding(pair(start), pair(end), pair(start + radius * left), sine < 0.0, float(setback))


def _joined(at: list[Floats], roundings: list[_Rounding], closed: bool) -> list[Segment]:
    """Arcs at the corners and the rest of the lines between them."""
    segments: list[Segment] = []
    count = len(at)
    for i, rounding in enumerate(roundings):
        if rounding.centre is not None:
            segments.append(Arc(rounding.start, rounding.end, rounding.centre, rounding.clockwise))
        if i == count - 1 and not closed:
            break
        k = (i + 1) % count
        following = roundings[k]
        length = float(np.hypot(*(at[k] - at[i])))
        left = length - rounding.setback - following.setback
        if left < -1e-12 * length:
            raise InvalidValue(
                "a fillet does not fit",
                where=f"edge from corner {i} at {pair(at[i])} to corner {k} at {pair(at[k])}",
                value=f"the edge is {length:.6g} long, the fillets take {rounding.setback:.6g} and "
                f"{following.setback:.6g} of it",
                cause="the radii are too large for the length of the edge",
                remedy="smaller radii, or a longer edge",
            )
        if left > 1e-12 * length:
            segments.append(Line(rounding.end, following.start))
    return segments
