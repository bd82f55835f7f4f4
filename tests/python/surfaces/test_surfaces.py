"""Tool surfaces: distance, normal and Hessian against closed forms and differences; functions of the user."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from umform.errors import InvalidValue, NotFinite
from umform.surfaces import Cylinder, Plane, Sphere, UserSurface, check_surface, unit_vector
from umform.surfaces.directions import rotation_matrix


def torus(x, ring=5.0, radius=1.5):
    """True distance to a ring in the plane z = 0."""
    rho = np.hypot(x[:, 0], x[:, 1])
    e = np.c_[x[:, 0] / rho, x[:, 1] / rho, np.zeros(len(x))]
    k = np.broadcast_to([0.0, 0.0, 1.0], x.shape)
    q = rho - ring
    s = np.hypot(q, x[:, 2])
    n = (q[:, None] * e + x[:, 2:] * k) / s[:, None]
    t = np.cross(k, e)

    def dyad(a):
        return np.einsum("qi,qj->qij", a, a)

    H = (dyad(e) + (q / rho)[:, None, None] * dyad(t) + dyad(k) - dyad(n)) / s[:, None, None]
    return s - radius, n, H


def ellipsoid(x, axes=(6.0, 3.0, 2.0)):
    """Scaled level set of an ellipsoid: a distance to first order at the surface only."""
    A, scale = np.diag(1.0 / np.square(axes)), 2.0
    s = np.sqrt(np.einsum("qi,ij,qj->q", x, A, x))
    Ax = x @ A
    H = scale * (A / s[:, None, None] - np.einsum("qi,qj->qij", Ax, Ax) / s[:, None, None] ** 3)
    return scale * (s - 1), scale * Ax / s[:, None], H


SKEW = (1.0, -2.0, 0.5)
SURFACES = {
    "plane": Plane((1.0, 2.0, 3.0), SKEW),
    "cylinder": Cylinder((1.0, 2.0, 3.0), SKEW, 4.0),
    "bore": Cylinder((1.0, 2.0, 3.0), SKEW, 40.0, inside=True),
    "sphere": Sphere((1.0, 2.0, 3.0), 4.0),
    "bowl": Sphere((1.0, 2.0, 3.0), 40.0, inside=True),
    "torus": UserSurface(torus, "torus"),
    "ellipsoid": UserSurface(ellipsoid, "ellipsoid"),
}


@pytest.fixture
def points(rng):
    """Points at 6 to 9 from the origin in all directions."""
    x = rng.normal(size=(50, 3))
    return x / np.linalg.norm(x, axis=1)[:, None] * rng.uniform(6, 9, (50, 1))


@pytest.mark.parametrize("name", SURFACES)
def test_normal_and_hessian_are_derivatives_of_the_distance(name, points):
    check = check_surface(SURFACES[name], points, 1e-4)
    assert check.ok(1e-7)
    assert check.asymmetry < 1e-12
    if name != "ellipsoid":
        assert check.gradient_length < 1e-8
        _, n, H = SURFACES[name].kernel().gap(points)
        np.testing.assert_allclose(np.linalg.norm(n, axis=1), 1.0, atol=1e-13)
        np.testing.assert_allclose(np.einsum("qij,qj->qi", H, n), 0.0, atol=1e-13)
    else:
        assert check.gradient_length > 0.01


def test_distances_of_the_simple_shapes():
    x = np.array([[3.0, 0.0, 7.0]])
    kernel = Plane((0, 0, 5.0), "z").kernel().gap(x)
    assert kernel[0] == pytest.approx(2.0)
    g, n, H = Cylinder((0, -9.0, 3.0), "y", 2.0).kernel().gap(x)
    assert g == pytest.approx(3.0)
    np.testing.assert_allclose(n, [[0.6, 0.0, 0.8]], atol=1e-15)
    np.testing.assert_allclose(H[0] @ [-0.8, 0, 0.6], np.array([-0.8, 0, 0.6]) / 5, atol=1e-15)
    np.testing.assert_allclose(H[0] @ [0, 1, 0], 0.0, atol=1e-15)
    g, n, H = Sphere((0, 0, 3.0), 2.0).kernel().gap(x)
    assert g == pytest.approx(3.0)
    np.testing.assert_allclose(H[0] @ [0, 1, 0], [0, 0.2, 0], atol=1e-15)


@pytest.mark.parametrize("shape", [Cylinder, Sphere])
def test_inside_is_the_negative_of_outside(shape, points):
    arguments = ((0.0, 0.0, 0.0), (0, 1, 0), 4.0) if shape is Cylinder else ((0.0, 0.0, 0.0), 4.0)
    outside = shape(*arguments).kernel().gap(points)
    inside = shape(*arguments, inside=True).kernel().gap(points)
    for a, b in zip(outside, inside, strict=True):
        np.testing.assert_array_equal(a, -b)


def test_the_length_of_an_axis_does_not_matter(points):
    long = Cylinder((0, 0, 0), (0, 7.0, 0), 4.0).kernel().gap(points)
    unit = Cylinder((0, 0, 0), "y", 4.0).kernel().gap(points)
    for a, b in zip(long, unit, strict=True):
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize(
    ("direction", "expected"),
    [("x", (1, 0, 0)), ("-z", (0, 0, -1)), ((0, 3.0, 4.0), (0, 0.6, 0.8)), ((0, -2, 0), (0, -1, 0))],
)
def test_directions_are_letters_or_vectors(direction, expected):
    assert unit_vector(direction, "here") == pytest.approx(expected)


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda: Plane(normal="w"), InvalidValue),
        (lambda: Plane(normal=(0, 0, 0)), InvalidValue),
        (lambda: Plane(normal=(0, math.nan, 1)), NotFinite),
        (lambda: Plane(point=(0, math.inf, 1)), NotFinite),
        (lambda: Plane(point=(0, 1)), NotFinite),
        (lambda: Cylinder((0, 0, 0), "y", 0.0), InvalidValue),
        (lambda: Cylinder((0, 0, 0), "y", math.nan), InvalidValue),
        (lambda: Cylinder((0, 0, 0), (1, 2), 1.0), NotFinite),
        (lambda: Sphere((0, 0, 0), -1.0), InvalidValue),
        (lambda: Sphere((0, 0, math.nan), 1.0), NotFinite),
    ],
)
def test_surfaces_that_are_none_are_refused(make, error):
    with pytest.raises(error):
        make().kernel()


@pytest.mark.parametrize(
    ("surface", "x", "step", "said"),
    [
        (lambda x: x, [(0, 0, 1)], 1e-4, r"must be a surface[\s\S]*UserSurface\(function\)"),
        (Sphere, [(0, 0, 1)], 1e-4, "must be a surface"),
        (SURFACES["plane"], (0, 0, 1), 1e-4, r"shape \(n, 3\)"),
        (SURFACES["plane"], np.zeros((0, 3)), 1e-4, r"shape \(n, 3\)"),
        (SURFACES["plane"], [(0, 0, 1)], 0.0, "positive"),
    ],
)
def test_a_check_of_no_surface_or_without_points_or_step_is_refused(surface, x, step, said):
    with pytest.raises(InvalidValue, match=said):
        check_surface(surface, x, step)


def spoiled(function, part, change):
    def wrong(x):
        answer = list(function(x))
        answer[part] = change(answer[part])
        return tuple(answer)

    return UserSurface(wrong, "spoiled")


@pytest.mark.parametrize("function", [torus, ellipsoid])
@pytest.mark.parametrize(
    ("part", "change"),
    [
        (1, lambda n: -n),
        (1, lambda n: 1.001 * n),
        (2, lambda H: 0.0 * H),
        (2, lambda H: -H),
        (2, lambda H: 1.01 * H),
        (2, lambda H: H + 0.01 * np.triu(np.ones((3, 3)), 1)),
    ],
    ids=["n turned", "n too long", "H missing", "H turned", "H too large", "H not symmetric"],
)
def test_the_check_refuses_wrong_derivatives(function, part, change, points):
    assert check_surface(UserSurface(function), points, 1e-4).ok()
    assert not check_surface(spoiled(function, part, change), points, 1e-4).ok()


@pytest.mark.parametrize(
    ("part", "change"),
    [
        (0, lambda g: g[:-1]),
        (0, lambda g: g[:, None]),
        (1, lambda n: n.T),
        (2, lambda H: H[:, :2]),
        (2, lambda H: H[0]),
    ],
)
def test_arrays_of_wrong_shapes_are_refused(part, change, points):
    with pytest.raises(InvalidValue, match="must have shape") as caught:
        spoiled(torus, part, change).kernel().gap(points)
    assert caught.value.where == "spoiled"


@pytest.mark.parametrize("answer", [None, 3.0, (1.0, 2.0), [1.0, 2.0, 3.0]])
def test_answers_that_are_not_three_arrays_are_refused(answer, points):
    with pytest.raises(InvalidValue, match="three arrays"):
        UserSurface(lambda x: answer).kernel().gap(points)


@pytest.mark.parametrize("part", [0, 1, 2])
@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_value_that_is_not_finite_names_its_point(part, bad, points):
    def change(values):
        values = np.array(values)
        values[7] = bad
        return values

    with pytest.raises(NotFinite) as caught:
        spoiled(torus, part, change).kernel().gap(points)
    assert str(points[7]) in caught.value.where


def test_lists_and_other_number_types_are_taken(points):
    def listed(x):
        return tuple(a.astype(np.float32).tolist() for a in torus(x))

    for a, b in zip(UserSurface(listed).kernel().gap(points), torus(points), strict=True):
        np.testing.assert_allclose(a, b, atol=1e-5)


def test_an_error_inside_the_function_arrives_as_it_is(points):
    class Mine(Exception):
        pass

    def function(x):
        raise Mine("from the inside", 42)

    with pytest.raises(Mine) as caught:
        UserSurface(function).kernel().gap(points)
    assert caught.value.args == ("from the inside", 42)


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-6, 0.3, np.pi, 5.0])
def test_a_rotation_vector_has_the_matrix_that_scipy_gives_it(angle):
    vector = angle * np.array(unit_vector(SKEW, "axis"))
    Q = rotation_matrix(vector)
    np.testing.assert_allclose(Q, Rotation.from_rotvec(vector).as_matrix(), rtol=0, atol=1e-15)
    np.testing.assert_allclose(Q @ Q.T, np.eye(3), rtol=0, atol=1e-15)
