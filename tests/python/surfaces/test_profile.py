"""Profiles: distance and sign by other means, derivatives, joints and corners, areas, and what is refused."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from umform.errors import InvalidValue, NotFinite
from umform.surfaces import Arc, Extruded, Line, Profile, Revolved, VDie

NAMES = [
    *("circle", "hole", "square", "rounded", "stadium", "cross", "needle", "horseshoe", "half-plane", "wedge", "notch"),
    *("V die", "V die, flat", "V die, sharp", "U die", "wiping die", "punch", "edge"),
]


def test_all_profiles_are_tested(plane):
    assert set(plane.profiles) == set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_distance_and_sign_are_those_of_a_polyline(plane, rng, name):
    profile = plane.profiles[name]
    curve = plane.polyline(profile)
    near = plane.polyline(profile, 1e-2, 20.0)[:: 3 if len(curve) > 1000 else 1]
    p = np.vstack([rng.uniform(-9, 9, (300, 2)), near + rng.normal(size=near.shape) * 0.02])
    g, _, _ = plane.gap(profile, p)
    np.testing.assert_allclose(np.abs(g), plane.distance(curve, p), atol=2e-5)
    sure = np.abs(g) > 3e-5
    assert sure.sum() > 300
    np.testing.assert_array_equal(g[sure] < 0, plane.solid(curve, p)[sure])


@pytest.mark.parametrize("name", NAMES)
def test_the_sign_is_right_far_away(plane, rng, name):
    profile = plane.profiles[name]
    p = rng.normal(size=(300, 2))
    p *= 3000.0 / np.hypot(*p.T)[:, None]
    g, n, _ = plane.gap(profile, p)
    np.testing.assert_array_equal(g < 0, plane.solid(plane.polyline(profile, 1e-2, 1e5), p))
    np.testing.assert_allclose(np.hypot(*n.T), 1.0, atol=1e-14)


def test_the_sign_is_right_next_to_sharp_corners(plane, rng):
    """In the wedge of the two tangents, whatever the distance."""
    count = 0
    for profile in plane.profiles.values():
        pairs = zip(profile.segments, profile.segments[1:] + profile.segments[:1], strict=True)
        for one, other in list(pairs)[: None if profile.closed else -1]:
            t, s = one.tangents()[1], other.tangents()[0]
            turn = t[0] * s[1] - t[1] * s[0]
            if abs(turn) < 1e-3:
                continue
            count += 1
            for size in (1e-4, 1e-7, 1e-10):
                d = size * rng.normal(size=(50, 2))
                left_of_one, left_of_other = t[0] * d[:, 1] - t[1] * d[:, 0], s[0] * d[:, 1] - s[1] * d[:, 0]
                g, _, _ = plane.gap(profile, np.array(one.end) + d)
                sure = np.minimum(np.abs(left_of_one), np.abs(left_of_other)) > 0.01 * size
                both, either = (left_of_one > 0) & (left_of_other > 0), (left_of_one > 0) | (left_of_other > 0)
                np.testing.assert_array_equal(g[sure] < 0, (both if turn > 0 else either)[sure])
    assert count > 20


@pytest.mark.parametrize("turn", [s * 10.0**e for s in (1.7, -2.9) for e in range(-12, 1, 2)])
def test_corners_that_hardly_turn(plane, rng, turn):
    """Right to the last digit at distances from 1e-12 to 1e3, and mostly where both lines and the corner are near."""
    end = np.array([np.cos(turn), np.sin(turn)])
    profile = Profile.from_corners([(-5.0, 0.0), (0.0, 0.0), tuple(5 * end)], closed=False)
    rho, angle = 10.0 ** rng.uniform(-12, 3, 4000), rng.uniform(0, 2 * np.pi, 4000)
    angle[::2] = rng.choice([-0.5 * np.pi, 0.5 * np.pi], 2000) + turn * rng.uniform(-1, 2, 2000)
    p = rho[:, None] * np.c_[np.cos(angle), np.sin(angle)]
    on_first, on_second = p[:, 0] <= 0, p @ end >= 0
    first, second = -p[:, 1], p[:, 0] * end[1] - p[:, 1] * end[0]
    expected = np.where(on_first & ~(on_second & (np.abs(second) < np.abs(first))), first, second)
    expected[~on_first & ~on_second] = (np.sign(turn) * rho)[~on_first & ~on_second]
    np.testing.assert_allclose(plane.gap(profile, p)[0] / rho, expected / rho, atol=2e-15)


@pytest.mark.parametrize("name", NAMES)
def test_derivatives(plane, rng, name):
    """Of all points those are left out whose surroundings see a kink or a joint: there the difference jumps."""
    profile, h = plane.profiles[name], 1e-5
    p = rng.uniform(-9, 9, (400, 2))
    _, n, k = plane.gap(profile, p)
    around = [plane.gap(profile, p + h * np.array(e)) for e in ((1, 0), (-1, 0), (0, 1), (0, -1))]
    smooth = np.all([np.abs(a[1] - n).max(axis=1) < 3 * h * (1 + np.abs(k)) for a in around], axis=0)
    smooth &= np.all([np.abs(a[2] - k) < 100 * h * k**2 + 1e-14 for a in around], axis=0) & (np.abs(k) < 10)
    assert smooth.sum() > 350
    east, west, north, south = around
    difference = np.stack([east[0] - west[0], north[0] - south[0]], axis=1) / (2 * h)
    np.testing.assert_allclose(n[smooth], difference[smooth], atol=1e-8)
    t = np.c_[-n[:, 1], n[:, 0]]
    H = k[:, None, None] * np.einsum("qi,qj->qij", t, t)
    difference = np.stack([east[1] - west[1], north[1] - south[1]], axis=2) / (2 * h)
    np.testing.assert_allclose(H[smooth], difference[smooth], atol=1e-7)


def test_the_distance_is_once_differentiable_over_tangent_joints(plane):
    """Normals on both sides of a joint differ by the step over the radius; the curvature jumps by that of the arc."""
    count = 0
    for profile in plane.profiles.values():
        for one, other in pairwise(profile.segments):
            t, at = one.tangents()[1], np.array(one.end)
            if np.abs(t - other.tangents()[0]).max() > 1e-9:
                continue
            count += 1
            normal = np.array([t[1], -t[0]])
            for depth in (-0.05, 0.0, 0.05):
                p = at + depth * normal + np.array([[-1e-6], [-1e-9], [0.0], [1e-9], [1e-6]]) * t
                g, n, k = plane.gap(profile, p)
                np.testing.assert_allclose(g, depth, atol=1e-11)
                np.testing.assert_allclose(n, np.tile(normal, (5, 1)), atol=1e-5)
                for side, segment in ((0, one), (4, other)):
                    own = segment.turn / segment.radius if isinstance(segment, Arc) else 0.0
                    assert k[side] == pytest.approx(own / (1 + depth * own), abs=1e-4)
    assert count > 25


def test_a_sharp_convex_corner_is_round_for_the_outside(plane):
    g, n, k = plane.gap(
        plane.profiles["square"], np.array([[3.3, 2.4], [3.0, 2.0], [3.0, 2.1], [3.0 + 1e-12, 2.0 + 1e-12]])
    )
    np.testing.assert_allclose(g[:3], [0.5, 0.0, 0.1], atol=1e-15)
    np.testing.assert_allclose(n, [[0.6, 0.8], [math.sqrt(0.5)] * 2, [0, 1], [math.sqrt(0.5)] * 2], atol=1e-3)
    assert k[0] == pytest.approx(2.0)
    assert k[1] == 0.0
    assert np.isfinite(k).all()


def test_a_sharp_concave_corner_is_held_by_the_nearer_line(plane):
    p = np.array([[1e-9, 1.0], [-1e-9, 1.0], [0.0, 1.0], [0.0, -2.0]])
    g, n, k = plane.gap(plane.profiles["notch"], p)
    slope = np.array([8.0, 3.0]) / math.hypot(3, 8)
    np.testing.assert_allclose(g, [slope[1], slope[1], slope[1], -2.0], atol=1e-8)
    np.testing.assert_allclose(n[:2], [[-slope[0], slope[1]], slope], atol=1e-12)
    np.testing.assert_array_equal(n[2], n[0])  # of equals the first
    np.testing.assert_allclose(n[3], [0.0, 1.0], atol=1e-15)
    assert k[3] == pytest.approx(-0.5)


def test_random_polygons_with_random_fillets(plane, rng):
    for _ in range(20):
        count = rng.integers(3, 9)
        angles = 2 * np.pi * (np.arange(count) + rng.uniform(-0.3, 0.3, count)) / count
        corners = rng.uniform(2, 6, count)[:, None] * np.c_[np.cos(angles), np.sin(angles)]
        radii = np.zeros(count)
        for i in range(count):  # as large as fits beside sharp neighbours, every other one
            a, b = corners[i - 1] - corners[i], corners[(i + 1) % count] - corners[i]
            half = 0.5 * np.arccos(a @ b / np.hypot(*a) / np.hypot(*b))
            radii[i] = rng.choice([0.0, 0.45]) * min(np.hypot(*a), np.hypot(*b)) * np.tan(half)
        profile = Profile.from_corners(corners.tolist(), radii.tolist())
        p = rng.uniform(-7, 7, (200, 2))
        curve = plane.polyline(profile, 1e-4)
        g, _, _ = plane.gap(profile, p)
        np.testing.assert_allclose(np.abs(g), plane.distance(curve, p), atol=2e-4)
        sure = np.abs(g) > 3e-4
        np.testing.assert_array_equal(g[sure] < 0, plane.solid(curve, p)[sure])


def test_areas():
    square = [(0, 0), (4, 0), (4, 3), (0, 3)]
    assert Profile.from_corners(square).area == 12.0
    assert Profile.from_corners(square[::-1]).area == -12.0
    assert Profile.from_corners(square, 0.5).area == pytest.approx(12.0 - (4 - math.pi) * 0.25, rel=1e-14)
    assert Profile.from_corners(square[::-1], 0.5).area == pytest.approx(-12.0 + (4 - math.pi) * 0.25, rel=1e-14)
    assert Profile.circle((7, -5), 2.0).area == pytest.approx(4 * math.pi, rel=1e-14)
    assert Profile.circle((7, -5), 2.0, hole=True).area == pytest.approx(-4 * math.pi, rel=1e-14)
    notched = Profile.from_corners([(0, 0), (4, 0), (4, 4), (2, 2), (0, 4)], [0, 0, 0, 0.5, 0])
    assert notched.area == pytest.approx(12.0 + (1 - math.pi / 4) * 0.25, rel=1e-14)


@pytest.mark.parametrize("name", NAMES)
def test_walked_the_other_way_solid_and_void_change_places(plane, rng, name):
    profile = plane.profiles[name]
    p = rng.uniform(-9, 9, (200, 2))
    g, n, k = plane.gap(profile, p)
    other = plane.gap(profile.reversed(), p)
    np.testing.assert_allclose(other[0], -g, atol=1e-13)
    single = np.abs(n + other[1]).max(axis=1) < 1e-9  # of two nearest points the other may be the first
    assert single.sum() > 195
    np.testing.assert_allclose(other[2][single], -k[single], rtol=1e-9, atol=1e-12)
    if profile.closed:
        assert profile.reversed().area == pytest.approx(-profile.area, rel=1e-14)


L = Line
BAD = {
    "no segment": (lambda: Profile([]), "at least one segment"),
    "no length": (lambda: Profile([L((0, 0), (0, 0))], closed=False), "must have a length"),
    "gap": (lambda: Profile([L((0, 0), (1, 0)), L((1.001, 0), (1, 1))], closed=False), "must meet"),
    "not closed": (lambda: Profile([L((0, 0), (1, 0)), L((1, 0), (1, 1))]), "must meet"),
    "two radii": (lambda: Profile([Arc((1, 0), (0, 1.1), (0, 0))], closed=False), "same distance from its centre"),
    "no radius": (lambda: Profile([Arc((0, 0), (0, 0), (0, 0))]), "must have a radius"),
    "turns back": (lambda: Profile([L((0, 0), (1, 0)), L((1, 0), (0.5, 0))], closed=False), "turns back"),
    "cusp": (
        lambda: Profile([Arc((1, 0), (0, 1), (0, 0)), Arc((0, 1), (1, 2), (0, 2))], closed=False),
        "turns back",
    ),
    "corner turns back": (lambda: Profile.from_corners([(0, 0), (3, 0), (1, 0)], closed=False), "turns back"),
    "two corners": (lambda: Profile.from_corners([(0, 0), (3, 0)]), "needs more corners"),
    "one corner": (lambda: Profile.from_corners([(0, 0)], closed=False), "needs more corners"),
    "same corner": (lambda: Profile.from_corners([(0, 0), (3, 0), (3, 0), (0, 2)]), "coincide"),
    "radius": (lambda: Profile.from_corners([(0, 0), (3, 0), (0, 2)], -1.0), "must not be negative"),
    "radii": (lambda: Profile.from_corners([(0, 0), (3, 0), (0, 2)], [0.1, 0.1]), "one radius for each"),
    "open end": (lambda: Profile.from_corners([(0, 0), (3, 0), (0, 2)], [1, 0, 0], closed=False), "are no corners"),
    "eight": (lambda: Profile.from_corners([(0, 0), (2, 2), (2, 0), (0, 2)]), "meet itself"),
    "touching": (lambda: Profile.from_corners([(0, 0), (4, 0), (4, 2), (2, 0), (0, 2)]), "meet itself"),
    "arc through line": (
        lambda: Profile([L((-5, 0), (2, 0)), Arc((2, 0), (0, -2), (0, 0)), L((0, -2), (0, 5))], closed=False),
        "meet itself",
    ),
    "two arcs": (
        lambda: Profile([L((-5, 0), (2, 0)), Arc((2, 0), (-2, 0), (0, 0)), Arc((-2, 0), (4, 0), (1, 0))], closed=False),
        "meet itself",
    ),
    "ends that meet": (
        lambda: Extruded(Profile.from_corners([(-1, 2), (-2, 0), (2, 0), (1, 2)], closed=False)).kernel(),
        "meet itself",
    ),
    "more than a turn": (
        lambda: Profile([Arc((2, 0), (0, -2), (0, 0)), Arc((0, -2), (0, 2), (0, 0))], closed=False),
        "meet itself",
    ),
    "endless arc": (lambda: Extruded(Profile.half_circle(2.0)).kernel(), "begin and end with a line"),
    "no area": (lambda: VDie(10, 90, 1).profile.area, "has no area"),
    "directions": (lambda: Extruded(Profile.circle((0, 0), 1), x="x", y=(1, 1, 0)).kernel(), "right angles"),
    "beyond the axis": (lambda: Revolved(Profile.circle((1, 0), 2)).kernel(), "one side of the axis"),
    "two on the axis": (
        lambda: Revolved(
            Profile.from_corners([(0, 0), (2, 0), (2, 3), (0, 3), (0, 2), (1, 2), (1, 1), (0, 1)])
        ).kernel(),
        "no surface",
    ),
    "through the axis": (
        lambda: Revolved(Profile.from_corners([(4, 0), (2, 0), (1, 5)], closed=False)).kernel(),
        "through the axis",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_profiles_are_refused(name):
    make, message = BAD[name]
    with pytest.raises(InvalidValue, match=message):
        make()


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_numbers_that_are_not_finite_are_refused(bad):
    for make in (
        lambda: Profile([L((0, 0), (1, bad))], closed=False),
        lambda: Profile([Arc((1, 0), (0, 1), (bad, 0))], closed=False),
        lambda: Profile.from_corners([(0, 0), (bad, 0), (0, 2)]),
    ):
        with pytest.raises(NotFinite):
            make()


def test_a_fillet_that_does_not_fit_names_its_corners():
    with pytest.raises(InvalidValue, match="a fillet does not fit") as caught:
        Profile.from_corners([(0, 0), (4, 0), (4, 3), (0, 3)], [0.0, 2.0, 1.5, 0.0])
    assert "corner 1 at (4.0, 0.0) to corner 2 at (4.0, 3.0)" in caught.value.where
    assert "3 long" in caught.value.value
    Profile.from_corners([(0, 0), (4, 0), (4, 3), (0, 3)], [0.0, 1.5, 1.5, 0.0])  # just fits


def test_a_straight_corner_needs_no_fillet():
    profile = Profile.from_corners([(0, 0), (2, 0), (4, 0), (4, 3)], [0, 1.0, 0, 0])
    assert all(isinstance(segment, Line) for segment in profile.segments)
