"""Tools in space: distance, sign and derivatives by other means, the axis of revolution, boxes, placed tools."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial import cKDTree

from umform.errors import InvalidValue, NotFinite
from umform.surfaces import (
    Arc,
    Box,
    Cylinder,
    Extruded,
    Line,
    Plane,
    Profile,
    Punch,
    Revolved,
    Sphere,
    Torus,
    UDie,
    UserSurface,
    VDie,
    WipingDie,
    check_surface,
)

SKEW = (1.0, -2.0, 0.5)
#: Meridian of a cup with a bead: its bottom ends on the axis.
CUP = Profile.from_corners(
    [(0, -2), (3, -2), (4, 2), (3, 3), (2.5, 2), (2, -1), (0, -1)], [0, 1, 0.4, 0.5, 0.2, 0.7, 0]
)

SOLIDS = {
    "torus": Torus((0.3, 0.1, -0.2), SKEW, 3.0, 1.2),
    "box": Box((0.3, 0.1, -0.2), (4.0, 3.0, 2.0), 0.6, x=(1, 2, 0), y=(-2, 1, 0)),
    "sharp box": Box((0.3, 0.1, -0.2), (4.0, 3.0, 2.0)),
    "pill": Box((0.0, 0.0, 0.0), (5.0, 2.0, 2.0), 1.0),
    "cup": Revolved(CUP, (0.1, 0.2, 0.3), SKEW),
    "ball": Revolved(Profile.half_circle(3.0), (0.1, 0.2, 0.3), SKEW),
    "plunger": Revolved(
        Profile([Arc((0, -3), (2, -1), (0, -1)), Line((2, -1), (2, 2)), Line((2, 2), (0, 2))], closed=False)
    ),
    "spool": Revolved(Profile.from_corners([(2, -2), (4, -2), (4, 2), (2, 2)], [0.0, 0.5, 0.5, 0.0]), axis="x"),
    "moved torus": Torus((0, 0, 0), "z", 3.0, 1.2).moved((0.5, 0.2, -0.3), (0.3, 1.2, -0.4)),
    "mirrored box": Box((1, 0.5, 0), (4.0, 3.0, 2.0), 0.6, x=(1, 2, 0), y=(-2, 1, 0)).mirrored(SKEW, (0.2, 0, 0)),
}
ENDLESS = {
    "V die": VDie(6.0, 85.0, 1.0, bottom_radius=0.7, origin=(0.2, 0.1, 0.4)),
    "U die": UDie(5.0, 3.0, 0.8, 1.0, x=(1, 2, 0), y=(-2, 1, 0)),
    "wiping die": WipingDie(2.0, y="-z"),
    "punch": Punch(1.0, 80.0, width=4.0),
    "moved punch": Punch(1.0, 80.0).moved((0.5, 0.2, -0.3), (0.3, 1.2, -0.4)),
    "mirrored die": WipingDie(2.0).mirrored("x", (1.0, 0, 0)),
    "funnel": Revolved(Profile.from_corners([(2, -5), (2, 0), (6, 3)], [0.0, 1.0, 0.0], closed=False), axis=SKEW),
    "bore": Cylinder((0, 0, 0), SKEW, 4.0, inside=True).moved(rotation=(1, 2, 3)),
}
BOX = ((-7, -7, -7), (7, 7, 7))


def winding(surface, x):
    """Solid angle of a triangulated surface over 4 pi: 1 in a solid, 0 outside."""
    a, b, c = (surface.corners[:, k] - x[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(v, axis=2) for v in (a, b, c))
    volume = np.einsum("qti,qti->qt", a, np.cross(b, c))
    base = la * lb * lc + sum(np.einsum("qti,qti->qt", u, v) * w for u, v, w in ((a, b, lc), (b, c, la), (c, a, lb)))
    return np.arctan2(volume, base).sum(axis=1) / (2 * math.pi)


@pytest.mark.parametrize("name", SOLIDS)
def test_distance_and_sign_are_those_of_the_triangles(rng, name):
    tool, chord = SOLIDS[name], 0.02
    surface = tool.triangles(BOX, chord)
    near = rng.choice(surface.points, 200) + 0.3 * rng.normal(size=(200, 3))
    x = np.vstack([rng.uniform(-6, 6, (100, 3)), near])
    g, n, _ = tool.kernel().gap(x)
    assert 30 < (g < 0).sum() < 240
    sure = np.abs(g) > chord
    np.testing.assert_allclose(winding(surface, x)[sure], (g < 0)[sure], atol=1e-6)
    foot, _, _ = tool.kernel().gap(x - g[:, None] * n)  # the nearest point lies on the surface
    np.testing.assert_allclose(foot, 0.0, atol=1e-12)
    centres = surface.corners.mean(axis=1)
    size = np.linalg.norm(surface.corners - centres[:, None], axis=2).max()
    nearest = cKDTree(surface.points).query(x)[0]
    assert (nearest > np.abs(g) - 1e-9).all()  # no point of the surface is nearer
    assert (nearest < np.abs(g) + 2 * size).all()


@pytest.mark.parametrize("name", [*SOLIDS, *ENDLESS])
def test_derivatives(rng, name):
    """Without the points whose surroundings see a kink or a joint."""
    tool = {**SOLIDS, **ENDLESS}[name]
    kernel, h = tool.kernel(), 1e-5
    x = rng.uniform(-6, 6, (300, 3))
    _, n, H = kernel.gap(x)
    np.testing.assert_allclose(np.linalg.norm(n, axis=1), 1.0, atol=1e-14)
    np.testing.assert_allclose(np.einsum("qij,qj->qi", H, n), 0.0, atol=1e-12 * (1 + np.abs(H).max()))
    np.testing.assert_allclose(H, np.swapaxes(H, 1, 2), atol=1e-14 * (1 + np.abs(H).max()))
    smooth = np.abs(H).max(axis=(1, 2)) < 5
    for e in np.vstack([np.eye(3), -np.eye(3)]):
        _, n_near, H_near = kernel.gap(x + 2 * h * e)
        smooth &= np.abs(n_near - n).max(axis=1) < 20 * h
        smooth &= np.abs(H_near - H).max(axis=(1, 2)) < 200 * h
    assert smooth.sum() > 240
    check = check_surface(tool, x[smooth], h)
    assert check.ok(1e-7)
    assert check.gradient_length < 1e-9


@pytest.mark.parametrize("name", [*SOLIDS, *ENDLESS])
def test_moved_tools_see_moved_points(rng, name):
    tool = {**SOLIDS, **ENDLESS}[name]
    x = rng.uniform(-6, 6, (100, 3))
    g, n, H = tool.kernel().gap(x)
    shift, turn = np.array([0.3, -1.0, 2.0]), np.array([0.5, 0.4, -1.2])
    placed = tool.moved(tuple(shift), tuple(turn))
    Q = np.array(Plane().moved(rotation=tuple(turn)).matrix)
    got = placed.kernel().gap(np.ascontiguousarray(x @ Q.T + shift))
    single = np.abs(got[1] - n @ Q.T).max(axis=1) < 1e-9
    assert single.sum() > 97  # elsewhere round-off chooses another one of two nearest points
    np.testing.assert_allclose(got[0], g, atol=1e-13)
    np.testing.assert_allclose(got[2][single], np.einsum("ik,qkl,jl->qij", Q, H[single], Q), atol=1e-10)


def test_placing_twice_is_placing_once(rng):
    x = rng.uniform(-6, 6, (50, 3))
    die = WipingDie(2.0)
    twice = die.moved((1, 2, 3), (0.1, 0.2, 0.3)).mirrored("x", (2, 0, 0)).moved((0, 1, 0))
    assert twice.tool is die
    once = die.moved((1, 2, 3), (0.1, 0.2, 0.3)).kernel().gap((x - (0, 1, 0)) * (-1, 1, 1) + (4, 0, 0))
    np.testing.assert_allclose(twice.kernel().gap(x)[0], once[0], atol=1e-13)
    np.testing.assert_allclose(twice.kernel().gap(x)[1], once[1] * (-1, 1, 1), atol=1e-13)
    there_and_back = die.mirrored("x").mirrored("x")
    for a, b in zip(there_and_back.kernel().gap(x), die.kernel().gap(x), strict=True):
        np.testing.assert_array_equal(a, b)


def test_a_users_tool_can_be_placed_and_is_asked_once(rng):
    asked = []

    def plane(x):
        asked.append(len(x))
        return x[:, 2], np.tile([0.0, 0.0, 1.0], (len(x), 1)), np.zeros((len(x), 3, 3))

    _, n, _ = UserSurface(plane).moved((0, 0, 2.0), (0, math.pi / 2, 0)).kernel().gap(rng.normal(size=(70, 3)))
    assert asked == [70]
    np.testing.assert_allclose(n, np.tile([1.0, 0.0, 0.0], (70, 1)), atol=1e-15)


@pytest.mark.parametrize("hole", [False, True])
def test_circles_make_cylinders_and_half_circles_spheres(rng, hole):
    x, centre = rng.uniform(-6, 6, (200, 3)), (0.5, 1.0, -0.3)
    pairs = (
        (Extruded(Profile.circle((0.5, -0.3), 2.0, hole=hole)), Cylinder(centre, "y", 2.0, inside=hole)),
        (Revolved(Profile.half_circle(2.0, hole=hole), centre, SKEW), Sphere(centre, 2.0, inside=hole)),
    )
    for one, other in pairs:
        for a, b in zip(one.kernel().gap(x), other.kernel().gap(x), strict=True):
            np.testing.assert_allclose(a, b, atol=1e-13)


def test_both_curvatures_are_equal_on_the_axis_of_a_smooth_tool():
    x = np.array([[0.0, 0.0, -4.0], [1e-9, 0.0, -4.0], [0.0, 1e-15, -4.0], [1e-5, 1e-5, -4.0]])
    g, n, H = SOLIDS["plunger"].kernel().gap(x)
    np.testing.assert_allclose(g, 1.0, atol=1e-9)
    np.testing.assert_allclose(n, np.tile([0, 0, -1.0], (4, 1)), atol=1e-5)
    np.testing.assert_allclose(H, np.tile(np.diag([1 / 3, 1 / 3, 0.0]), (4, 1, 1)), atol=1e-5)
    g, n, H = SOLIDS["plunger"].kernel().gap(np.array([[0.0, 0.0, 2.5], [0.0, 0.0, 1.5]]))
    np.testing.assert_allclose(g, [0.5, -0.5], atol=1e-15)
    np.testing.assert_array_equal(H, 0.0)


def test_a_line_on_the_axis_is_no_surface(rng):
    open_one = Profile.from_corners([(0, 0), (2, 0), (2, 3), (0, 3)], [0, 0.5, 0.5, 0], closed=False)
    closed = Profile.from_corners([(0, 0), (2, 0), (2, 3), (0, 3)], [0, 0.5, 0.5, 0])
    x = rng.uniform(-1, 3, (100, 3))
    for a, b in zip(Revolved(open_one).kernel().gap(x), Revolved(closed).kernel().gap(x), strict=True):
        np.testing.assert_array_equal(a, b)
    assert Revolved(closed).kernel().gap(np.array([[0.0, 0.0, 1.4]]))[0] == pytest.approx(-1.4)


def test_the_point_of_a_cone_and_of_a_pit():
    cone = Profile([Line((3, -3), (0, 0))], closed=False)
    x = np.array([[0.0, 0.0, 2.0], [0.1, 0.0, 2.0], [0.0, 0.0, -2.0], [1.0, 0.0, -1.0]])
    g, n, H = Revolved(cone).kernel().gap(x)
    np.testing.assert_allclose(g, [2.0, math.hypot(0.1, 2), -math.sqrt(2), 0.0], atol=1e-15)
    np.testing.assert_allclose(H[0], np.diag([0.5, 0.5, 0.0]), atol=1e-15)
    assert np.isfinite(H).all()
    assert np.isfinite(n).all()
    np.testing.assert_allclose(Revolved(cone.reversed()).kernel().gap(x)[0], -g, atol=1e-15)


def test_distances_of_a_rounded_box():
    box = Box((0, 0, 0), (6, 4, 2), 0.5)
    x = np.array([[0, 0, 0], [3.5, 0, 0], [-2.8, 0, 0.1], [5.5, 5.5, 0], [2.5, -1.5, 2.5], [5.5, 3.5, 6.5]])
    g, n, H = box.kernel().gap(x)
    np.testing.assert_allclose(g, [-1.0, 0.5, -0.2, 4.5, 1.5, math.sqrt(9 + 4 + 36) - 0.5], atol=1e-14)
    np.testing.assert_allclose(n[3], [0.6, 0.8, 0.0], atol=1e-15)
    np.testing.assert_allclose(n[5], np.array([3, 2, 6]) / 7, atol=1e-15)
    np.testing.assert_allclose(np.trace(H[3:], axis1=1, axis2=2), [1 / 5, 0.0, 2 / 7], atol=1e-15)


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: Torus((0, 0, 0), "z", 1.0, 1.0), InvalidValue, "must have a hole"),
        (lambda: Torus((0, 0, 0), "z", 1.0, -1.0), InvalidValue, "must be positive"),
        (lambda: Torus((0, 0), "z", 2.0, 1.0), NotFinite, "three finite"),
        (lambda: Box((0, 0, 0), (1, 2, 3), 0.51), InvalidValue, "half of its smallest"),
        (lambda: Box((0, 0, 0), (1, 0, 3)), InvalidValue, "must be positive"),
        (lambda: Box((0, 0, 0), (1, 2, math.nan)), NotFinite, "finite"),
        (lambda: Box((0, 0, 0), (1, 2, 3), x="x", y="x"), InvalidValue, "right angles"),
        (lambda: Box((0, 0, 0), (1, 2, 3), -0.1), InvalidValue, "at least 0"),
        (lambda: Plane().moved((0, math.inf, 0)), NotFinite, "finite"),
        (lambda: Plane().moved(rotation=(0, 1)), NotFinite, "finite"),
        (lambda: Plane().mirrored((0, 0, 0)), InvalidValue, "zero vector"),
    ],
)
def test_tools_that_are_none_are_refused(make, error, message):
    with pytest.raises(error, match=message):
        make().kernel()


def test_a_tool_is_asked_for_its_gap(rng):
    x = rng.uniform(-6, 6, (20, 3))
    for a, b in zip(SOLIDS["torus"].gap(x.tolist()), SOLIDS["torus"].kernel().gap(x), strict=True):
        np.testing.assert_array_equal(a, b)
    with pytest.raises(InvalidValue, match=r"shape \(n, 3\)"):
        SOLIDS["torus"].gap([1.0, 2.0, 3.0])
