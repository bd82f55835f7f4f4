"""A profile led around a rectangle: beside a box, a turned profile, and differences of its own distance."""

from __future__ import annotations

import numpy as np
import pytest

from umform.errors import InvalidValue
from umform.surfaces import Arc, Box, LedAround, Line, Profile, Revolved, check_surface


def section(edge: float, *, start: float = -9.0) -> Profile:
    """A punch: flat below, its wall at x = 0."""
    return Profile.from_corners([(start, 0), (0, 0), (0, 60)], radii=[0, edge, 0], closed=False)


def test_with_edges_as_round_as_the_corners_it_is_a_rounded_box():
    tool, box = LedAround(section(8), (70, 60), 8), Box((0, 0, 50), (70, 60, 100), 8)
    x = np.random.default_rng(1).uniform((-45, -45, -15), (45, 45, 30), (500, 3))
    outside = box.gap(x)[0] > 0.5
    for one, other in zip(tool.gap(x[outside]), box.gap(x[outside]), strict=True):
        assert np.abs(one - other).max() < 1e-12


def test_a_square_that_is_all_corner_is_a_turned_profile():
    flat = Profile.from_corners([(0, 0), (20, 0), (20, 60)], radii=[0, 6, 0], closed=False)
    tool, turned = LedAround(section(6, start=-20), (40, 40), 20), Revolved(flat)
    x = np.random.default_rng(2).uniform((-30, -30, -10), (30, 30, 30), (500, 3))
    x = x[np.hypot(x[:, 0], x[:, 1]) > 15.0]
    for one, other in zip(tool.gap(x), turned.gap(x), strict=True):
        assert np.abs(one - other).max() < 1e-12


@pytest.mark.parametrize("outwards", [True, False])
def test_normal_and_hessian_belong_to_the_distance(outwards):
    die = Profile.from_corners([(60, 0), (0, 0), (0, -60)], radii=[0, 5, 0], closed=False)
    how = {"origin": (1, 2, 3), "x": (1, 1, 0), "y": (-1, 1, 0)}
    tool = LedAround(section(8), (70, 60), 10, **how) if outwards else LedAround(die, (74, 64), 12, **how)
    x = np.random.default_rng(3).uniform(-50, 50, (2000, 3))
    g, n, _ = tool.gap(x)
    near = np.abs(g) < 4.0
    assert near.sum() > 100
    found = [check_surface(tool, point[None], 1e-5) for point in x[near][:150]]
    assert all(check.ok(1e-4) and check.gradient_length < 1e-6 for check in found)
    assert np.linalg.norm(n, axis=1) == pytest.approx(1.0, abs=1e-12)


def test_what_cannot_be_led_around_is_refused():
    with pytest.raises(InvalidValue, match="half of the shorter side"):
        LedAround(section(8), (70, 12), 10).kernel()
    with pytest.raises(InvalidValue, match="deeper inside"):
        LedAround(section(8), (70, 70), 5).kernel()
    with pytest.raises(InvalidValue, match="must be open"):
        LedAround(Profile.from_corners([(0, 0), (9, 0), (9, 9)]), (70, 70), 10).kernel()


@pytest.mark.parametrize(("clockwise", "accepted"), [(True, False), (False, True)])
def test_an_arc_that_bulges_to_the_diagonals_is_refused(clockwise, accepted):
    arc = Arc((-8.0, 2.0), (-8.0, 12.0), (-8.0, 7.0), clockwise=clockwise)
    lines = Line((-30.0, 0.0), (-8.0, 0.0)), Line((-8.0, 0.0), (-8.0, 2.0)), arc, Line((-8.0, 12.0), (-8.0, 40.0))
    tool = LedAround(Profile(lines, closed=False), (70, 70), 10)
    if accepted:
        tool.kernel()
        return
    with pytest.raises(InvalidValue, match=r"(?s)deeper inside.*x = -13"):
        tool.kernel()
