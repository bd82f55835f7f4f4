"""Approximate plane curves by tangent arcs."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from umform.surfaces.directions import pair
from umform.surfaces.segments import Arc, Floats, Line, Segment

#: Parameter -> point and tangent, both of shape (2,).
Curve = Callable[[float], tuple[Floats, Floats]]

_DEEPEST = 14
_STRAIGHT = 1e-9


def as_arcs(curve: Curve, parameters: list[float], tolerance: float) -> list[Segment]:
    """Tangent-continuous pairs of arcs within a distance of the curve.

    Parameters
    ----------
    curve : callable
        Point and tangent at a parameter.
    parameters : list of float
        Parameters where the curve is always split: its ends, and jumps of its curvature.
    tolerance : float
        Largest distance, sampled at seven places of each pair.
    """
    segments: list[Segment] = []
    for a, b in pairwise(parameters):
        segments += _fitted(curve, a, b, tolerance, 0)
    return segments


def _fitted(curve: Curve, a: float, b: float, tolerance: float, depth: int) -> list[Segment]:
    arcs = _biarc(*curve(a), *curve(b))
    inner = [curve(a + (b - a) * k / 8.0)[0] for k in range(1, 8)]
    fits = bool(arcs) and max(min(_distance(segment, x) for segment in arcs) for x in inner) <= tolerance
    if (fits and depth > 0) or depth == _DEEPEST:
        return arcs or [Line(pair(curve(a)[0]), pair(curve(b)[0]))]
    m = 0.5 * (a + b)
    return _fitted(curve, a, m, tolerance, depth + 1) + _fitted(curve, m, b, tolerance, depth + 1)


def _biarc(p: Floats, t: Floats, q: Floats, s: Floats) -> list[Segment]:
    """Two arcs with tangents of one length to their joint; none where they would turn back."""
    t, s, v = t / np.hypot(*t), s / np.hypot(*s), q - p
    if t @ s < -0.5 or v @ t <= 0.0 or v @ s <= 0.0:
        return []
    along, turn = float(v @ (t + s)), 2.0 * (1.0 - float(t @ s))
    length = float(v @ v) / (along + math.sqrt(along**2 + turn * float(v @ v)))
    joint = 0.5 * (p + q + length * (t - s))
    return [_arc(p, joint, t), _arc(joint, q, _reflected(joint, q, s))]


def _reflected(p: Floats, q: Floats, s: Floats) -> Floats:
    """Tangent at the start of an arc from p to q that ends with the tangent s."""
    d = (q - p) / np.hypot(*(q - p))
    return np.asarray(2.0 * (s @ d) * d - s)


def _arc(p: Floats, q: Floats, t: Floats) -> Segment:
    """Arc from p, with the unit tangent t there, to q; a line if its curvature is negligible."""
    d, left = q - p, np.array([-t[1], t[0]])
    across = float(d @ left)
    if abs(across) <= _STRAIGHT * float(np.hypot(*d)):
        return Line(pair(p), pair(q))
    centre = p + float(d @ d) / (2.0 * across) * left
    return Arc(pair(p), pair(q), pair(centre), clockwise=across < 0.0)


def _distance(segment: Segment, x: Floats) -> float:
    """Distance to a line or a circle; beyond the ends, to the nearest end."""
    ends = min(math.dist(x, segment.start), math.dist(x, segment.end))
    if isinstance(segment, Line):
        t = segment.tangents()[0]
        d = x - np.array(segment.start)
        along = float(d @ t)
        return abs(float(d[0] * t[1] - d[1] * t[0])) if 0.0 <= along <= segment.length else ends
    p = x - np.array(segment.centre)
    rho = float(np.hypot(*p))
    inside = float(p @ segment.middle) >= rho * math.cos(0.5 * segment.angle)
    return abs(rho - segment.radius) if inside else ends
