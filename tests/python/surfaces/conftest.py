"""Profiles of the tests, and distances by other means: polylines and the parity of crossings."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from umform.surfaces import Arc, Extruded, Line, Profile, Punch, UDie, VDie, WipingDie

#: Profiles that stay within 20 of the origin; the open ones go on for ever.
PROFILES = {
    "circle": Profile.circle((1.0, -2.0), 3.0),
    "hole": Profile.circle((1.0, -2.0), 3.0, hole=True),
    "square": Profile.from_corners([(-2, -2), (3, -2), (3, 2), (-2, 2)]),
    "rounded": Profile.from_corners([(-2, -2), (3, -2), (3, 2), (-2, 2)], [1.0, 0.0, 2.0, 0.5]),
    "stadium": Profile.from_corners([(-4, -1), (4, -1), (4, 1), (-4, 1)], 1.0),
    "cross": Profile.from_corners(
        [(1, -5), (1, -1), (5, -1), (5, 1), (1, 1), (1, 5), (-1, 5), (-1, 1), (-5, 1), (-5, -1), (-1, -1), (-1, -5)],
        [0.3, 2.0, 0.0, 0.7, 1.0, 0.0, 0.5, 1.0, 0.2, 0.3, 2.0, 0.0],
    ),
    "needle": Profile.from_corners([(-3, -0.1), (6, 0), (-3, 0.1)]),
    "horseshoe": Profile(
        [
            Arc((3, 4), (3, -4), (0, 0)),
            Line((3, -4), (1.5, -2)),
            Arc((1.5, -2), (1.5, 2), (0, 0), clockwise=True),
            Line((1.5, 2), (3, 4)),
        ]
    ),
    "half-plane": Profile([Line((0, 0), (1, 2))], closed=False),
    "wedge": Profile.from_corners([(-3, 8), (0, 0), (3, 8)], closed=False),
    "notch": Profile.from_corners([(3, 8), (0, 0), (-3, 8)], closed=False),
    "V die": VDie(10.0, 85.0, 1.5, bottom_radius=0.7).profile,
    "V die, flat": VDie(10.0, 85.0, 1.5, depth=3.0).profile,
    "V die, sharp": VDie(10.0, 85.0, 0.0).profile,
    "U die": UDie(8.0, 7.0, 2.0, 4.0).profile,
    "wiping die": WipingDie(2.0).profile,
    "punch": Punch(1.0, 80.0, width=6.0).profile,
    "edge": Punch(0.0, 30.0).profile,
}


def gap2(profile, p):
    """Distance, normal and curvature in the plane of a profile."""
    x = np.c_[p[:, 0], np.full(len(p), 0.3), p[:, 1]]
    g, n, H = Extruded(profile).kernel().gap(np.ascontiguousarray(x))
    np.testing.assert_array_equal(n[:, 1], 0.0)
    np.testing.assert_array_equal(H[:, 1], 0.0)
    return g, n[:, ::2], np.trace(H, axis1=1, axis2=2)


def polyline(profile, chord=1e-5, far=1e4):
    """Many points of the curve; an open one is closed far away, around its solid."""
    curve = profile.points(chord, far)
    if profile.closed:
        return curve
    start, end = np.arctan2(*curve[0, ::-1]), np.arctan2(*curve[-1, ::-1])
    angles = np.linspace(0.0, (start - end) % (2 * np.pi), 100)[1:-1] + end
    around = 2 * far * np.c_[np.cos(angles), np.sin(angles)]
    return np.vstack([curve, around, curve[:1]])


def distance(curve, p):
    """Distance of points to a polyline."""
    best = np.full(len(p), np.inf)
    for a, b in pairwise(curve):
        s = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        best = np.minimum(best, np.hypot(*(p - a - s[:, None] * (b - a)).T))
    return best


def solid(curve, p):
    """Whether points are in a closed polyline: its winding number is 1, or 0 for a hole of winding number -1."""
    winding = np.zeros(len(p), dtype=int)
    for a, b in pairwise(curve):
        left = (b[0] - a[0]) * (p[:, 1] - a[1]) - (p[:, 0] - a[0]) * (b[1] - a[1]) > 0
        winding += (a[1] <= p[:, 1]) & (b[1] > p[:, 1]) & left
        winding -= (a[1] > p[:, 1]) & (b[1] <= p[:, 1]) & ~left
    clockwise = np.sum(curve[:-1, 0] * curve[1:, 1] - curve[1:, 0] * curve[:-1, 1]) < 0
    return winding == (0 if clockwise else 1)


@pytest.fixture
def plane():
    """Means to look at profiles."""
    return SimpleNamespace(profiles=PROFILES, gap=gap2, polyline=polyline, distance=distance, solid=solid)
