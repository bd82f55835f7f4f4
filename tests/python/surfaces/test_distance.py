"""Tools that say they are distances: the gap never changes by more than the point moves."""

from __future__ import annotations

import numpy as np
import pytest

from umform.surfaces import Box, Cylinder, Extruded, Plane, Profile, Revolved, Sphere, Torus, UserSurface, WipingDie

TOOLS = {
    "plane": Plane((0, 0, 1), (1, 2, 3)),
    "cylinder": Cylinder((0, 0, 1), (1, 2, 3), 3.0),
    "bore": Cylinder((0, 0, 1), (1, 2, 3), 3.0, inside=True),
    "sphere": Sphere((0, 0, 1), 3.0),
    "bowl": Sphere((0, 0, 1), 3.0, inside=True),
    "torus": Torus((0, 0, 1), (1, 2, 3), 3.0, 1.0),
    "box": Box((0, 0, 1), (3, 4, 5), 0.5, x=(1, 1, 0), y=(-1, 1, 0)),
    "sharp box": Box((0, 0, 1), (3, 4, 5)),
    "funnel": Revolved(Profile.from_corners([(2, -5), (2, 0), (6, 3)], [0, 1, 0], closed=False)),
    "spool": Revolved(Profile.from_corners([(2, -2), (4, -2), (4, 2), (2, 2)], [0.0, 0.5, 0.5, 0.0]), axis="x"),
    "moved and mirrored": WipingDie(2.0).moved((0, 0, -2), (0.1, 0.2, 0.3)).mirrored((1, 1, 1)),
}


def excess(tool, rng):
    """Largest change of the gap beyond the way of the point, on ways of all lengths."""
    x = rng.uniform(-8.0, 8.0, (20000, 3))
    y = x + np.geomspace(0.01, 20.0, len(x))[:, None] * rng.normal(size=x.shape)
    (before, *_), (after, *_) = tool.kernel().gap(x), tool.kernel().gap(y)
    return (np.abs(after - before) - np.linalg.norm(y - x, axis=1)).max()


@pytest.mark.parametrize("name", TOOLS)
def test_a_tool_of_the_catalogue_is_a_distance(rng, name):
    assert TOOLS[name].kernel().is_distance
    assert excess(TOOLS[name], rng) < 1e-13


def test_profiles_are_distances(plane, rng):
    for profile in plane.profiles.values():
        assert Extruded(profile).kernel().is_distance
        assert excess(Extruded(profile), rng) < 1e-13


def test_a_function_of_a_user_need_not_be_one(rng):
    def doubled(x):
        g, n, H = TOOLS["sphere"].kernel().gap(x)
        return 2.0 * g, 2.0 * n, 2.0 * H

    tool = UserSurface(doubled)
    assert excess(tool, rng) > 1.0
    assert not tool.kernel().is_distance
    assert not tool.moved((1, 2, 3), (0.1, 0.2, 0.3)).kernel().is_distance
