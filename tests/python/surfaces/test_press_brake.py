"""Dies and punches: the numbers that stand on them are found again in their surface."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from umform.errors import InvalidValue
from umform.surfaces import Arc, Extruded, Line, Profile, Punch, UDie, VDie, WipingDie


def gap(tool, *x):
    return tool.kernel().gap(np.array(x, dtype=float))


@pytest.mark.parametrize("angle", [60.0, 88.0, 120.0])
@pytest.mark.parametrize("radius", [0.0, 1.5])
def test_a_v_die_has_its_opening_and_its_angle(angle, radius):
    die = VDie(12.0, angle, radius)
    slope = math.tan(math.radians(angle / 2))
    g, n, _ = gap(die, (20, 3, 0.5), (-20, 0, -0.5), (0, 0, 3.0))
    np.testing.assert_allclose(g[:2], [0.5, -0.5], atol=1e-15)
    np.testing.assert_allclose(n[:2], [[0, 0, 1], [0, 0, 1]], atol=1e-15)
    depth = 0.5 * 6.0 / slope  # a point of either flank, half way down
    flank = np.array([[3.0, 0, -depth], [-3.0, 0, -depth]])
    g, n, _ = die.kernel().gap(flank)
    np.testing.assert_allclose(g, 0.0, atol=1e-14)
    assert math.degrees(math.acos(-n[0] @ n[1])) == pytest.approx(angle)
    np.testing.assert_allclose(n[:, 2], math.sin(math.radians(angle / 2)), atol=1e-14)
    np.testing.assert_allclose(
        n[:, 0], [-math.cos(math.radians(angle / 2)), math.cos(math.radians(angle / 2))], atol=1e-14
    )
    half = 0.5 * die.tangent_width
    g, _, H = gap(die, (half + 1e-6, 0, 0.0), (half - 1e-3, 0, 0.0))
    assert g[0] == pytest.approx(0.0, abs=1e-15)
    assert not H[0].any()
    if radius:
        assert g[1] == pytest.approx(1e-6 / (2 * radius), rel=1e-2)
        assert np.trace(H[1]) == pytest.approx(1 / radius, rel=1e-2)


def test_the_bottom_of_a_v_die():
    sharp, rounded, flat = VDie(12, 90, 1), VDie(12, 90, 1, bottom_radius=2), VDie(12, 90, 1, depth=4.0)
    assert gap(sharp, (0, 0, -6))[0] == pytest.approx(0.0, abs=1e-15)
    lowest = 6 - 2 * (math.sqrt(2) - 1)
    assert gap(rounded, (0, 0, -lowest))[0] == pytest.approx(0.0, abs=1e-14)
    assert np.trace(gap(rounded, (0, 0, -lowest))[2][0]) == pytest.approx(-0.5)
    np.testing.assert_allclose(
        gap(flat, (0, 0, -4), (1.9, 0, -4), (2, 0, -4), (0, 0, -3.5))[0], [0, 0, 0, 0.5], atol=1e-14
    )


def test_a_u_die_has_its_walls_and_bottom():
    die = UDie(10.0, 8.0, 2.0, bottom_radius=5.0)
    g, n, _ = gap(die, (4.9, 0, -2.5), (-4.8, 0, -2.5), (0, 0, -7.9), (9, 0, 1))
    np.testing.assert_allclose(g, [0.1, 0.2, 0.1, 1.0], atol=1e-14)
    np.testing.assert_allclose(n[:, ::2], [[-1, 0], [1, 0], [0, 1], [0, 1]], atol=1e-14)


def test_a_wiping_die_has_one_rounded_edge():
    g, n, _ = gap(WipingDie(3.0), (-9, 0, 0.2), (0.1, 0, -9), (0, 0, 0), (-3, 5, -3), (0.1, 0, -1e6))
    np.testing.assert_allclose(g, [0.2, 0.1, 3 * (math.sqrt(2) - 1), -3.0, 0.1], atol=1e-14)
    np.testing.assert_allclose(n[2, ::2], [math.sqrt(0.5)] * 2, atol=1e-15)
    assert gap(WipingDie(0.0), (3, 0, 4))[0] == 5.0


@pytest.mark.parametrize("radius", [0.0, 0.8])
@pytest.mark.parametrize("width", [None, 10.0])
def test_a_punch_stands_on_its_tip(radius, width):
    punch = Punch(radius, 86.0, width=width)
    half = math.radians(43.0)
    g, n, H = gap(punch, (0, 0, 0.0), (0, 1, -0.5), (0, 0, -2.0))
    np.testing.assert_allclose(g, [0.0, 0.5, 2.0], atol=1e-14)
    np.testing.assert_allclose(n, np.tile([0, 0, -1.0], (3, 1)), atol=1e-14)
    assert np.trace(H[1]) == pytest.approx(1 / (0.5 + radius))
    apex = radius - radius / math.sin(half)
    at = np.array([[3.0, 0, apex + 3.0 / math.tan(half)]])
    g, n, _ = punch.kernel().gap(at)
    assert g == pytest.approx(0.0, abs=1e-14)
    np.testing.assert_allclose(n[0], [math.cos(half), 0, -math.sin(half)], atol=1e-14)
    far = gap(punch, (5.5, 0, 50.0), (0, 0, 50.0))[0]
    np.testing.assert_allclose(far[0] > 0, width is not None)
    if width:
        np.testing.assert_allclose(far, [0.5, -5.0], atol=1e-13)


def test_a_tool_stands_where_its_directions_say():
    punch = Punch(1.0, 80.0, origin=(1, 2, 3), x="y", y="-z")
    g, n, _ = gap(punch, (9, 2, 3.5))
    assert g == pytest.approx(0.5)
    np.testing.assert_allclose(n, [[0, 0, 1]], atol=1e-15)


def test_all_joints_of_rounded_tools_are_tangent():
    for tool in (
        VDie(12, 88, 1.5, 0.8),
        VDie(12, 88, 1.5, 0.8, depth=3),
        UDie(10, 7, 2, 3),
        WipingDie(2),
        Punch(1, 86),
    ):
        segments = tool.profile.segments
        assert {type(segment) for segment in segments} == {Line, Arc}
        for one, other in pairwise(segments):
            np.testing.assert_allclose(one.tangents()[1], other.tangents()[0], atol=1e-13)


def test_a_ready_tool_is_its_profile(rng):
    x = rng.uniform(-9, 9, (100, 3))
    die = VDie(10, 90, 1.0, 1.0)
    own = Profile.from_corners([(20, 0), (5, 0), (0, -5), (-5, 0), (-20, 0)], [0, 1, 1, 1, 0], closed=False)
    for a, b in zip(die.kernel().gap(x), Extruded(own).kernel().gap(x), strict=True):
        np.testing.assert_allclose(a, b, atol=1e-13)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: VDie(0.0, 90, 1), "opening must be positive"),
        (lambda: VDie(10, 180, 1), "between 0 and 180"),
        (lambda: VDie(10, math.nan, 1), "between 0 and 180"),
        (lambda: VDie(10, 90, -1), "at least 0"),
        (lambda: VDie(10, 90, 1, depth=5.0), "above the point of the V"),
        (lambda: VDie(10, 90, 10, 8), "fillet does not fit"),
        (lambda: UDie(10, 5, 3, 3), "fillet does not fit"),
        (lambda: UDie(10, 9, 1, 5.1), "fillet does not fit"),
        (lambda: WipingDie(math.inf), "at least 0"),
        (lambda: Punch(1, 0), "between 0 and 180"),
        (lambda: Punch(2.0, 90, width=2.5), "wider than its round tip"),
        (lambda: Punch(2.0, 90, width=1e300), r"finite numbers(.*\n)*.*beyond 1e\+50"),
        (lambda: Punch(1e300, 90), r"finite numbers(.*\n)*.*beyond 1e\+50"),
    ],
)
def test_tools_that_are_none_are_refused(make, message):
    with pytest.raises(InvalidValue, match=message):
        make().kernel()


def test_radii_and_direction_of_tools_that_are_moved_or_offset():
    die = VDie(10, 90, 2.0)
    assert list(die.convex_radii()) == list(die.moved((1, 2, 3)).convex_radii()) == [2.0]
    assert [list(die.offset(d).convex_radii()) for d in (0.5, -3.0)] == [[2.5], [0.0]]
    assert list(die.counterpart(1.0).convex_radii()) == []
    np.testing.assert_allclose(die.along(), (0.0, -1.0, 0.0), atol=1e-15)
    np.testing.assert_allclose(die.moved(rotation=(0.0, 0.0, math.pi / 2)).along(), (1.0, 0.0, 0.0), atol=1e-15)
    assert sorted(WipingDie(1.5).section().convex_radii()) == [1.5]
    assert list(WipingDie(0.0).section().convex_radii()) == [0.0]
