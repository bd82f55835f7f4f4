"""Tools of triangles: order of the error, derivatives, one tangent plane at edges, edges and corners, refusals."""

from __future__ import annotations

import math
import pickle
import re

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import FileProblem, HoleInSurface, InvalidValue, TurnedNormals, UnfitTriangles
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import (
    Box,
    Cylinder,
    Profile,
    Revolved,
    Sphere,
    Torus,
    Triangles,
    Triangulated,
    UDie,
    check_surface,
    write_tool,
)
from umform.surfaces.stl import welded

ALL = ((-9, -9, -9), (9, 9, 9))
TORUS = Torus((0.1, 0.2, 0.3), (1, 2, 3), 3.0, 1.0)


def sphere(halvings):
    """Octahedron whose triangles are cut into four, on the unit sphere, irregularly."""
    soup = np.array([[(x, 0, 0), (0, y, 0), (0, 0, z)] for x in (1, -1) for y in (1, -1) for z in (1, -1)], dtype=float)
    soup[[1, 2, 4, 7]] = soup[[1, 2, 4, 7], ::-1]
    for _ in range(halvings):
        a, b, c = np.moveaxis(soup, 1, 0)
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        soup = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    soup += 0.1 * np.sin(3 * soup[..., ::-1])
    soup /= np.linalg.norm(soup, axis=2, keepdims=True)
    return welded(soup.reshape(-1, 3), np.arange(3 * len(soup)).reshape(-1, 3), 1e-9)[0]


def torus(parts):
    """Uneven grid on TORUS."""
    u, v = np.meshgrid(*(np.linspace(0, 2 * math.pi, k * parts + 1) for k in (3, 2)), indexing="ij")
    v = v + 0.2 * np.sin(3 * u)
    x = np.stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)], axis=-1)
    at = np.arange(u.size).reshape(u.shape)
    a, b, c, d = at[:-1, :-1].ravel(), at[1:, :-1].ravel(), at[1:, 1:].ravel(), at[:-1, 1:].ravel()
    surface, _ = welded(x.reshape(-1, 3), np.vstack([np.c_[a, b, c], np.c_[a, c, d]]), 1e-9)
    axis = np.array([1, 2, 3]) / math.sqrt(14)
    e = np.cross([0, 1, 0], axis)
    e /= np.linalg.norm(e)
    return Triangles(surface.points @ np.array([e, np.cross(axis, e), axis]) + (0.1, 0.2, 0.3), surface.triangles)


def tube(parts):
    """Unit cylinder along z, from -20 to 20, of needles."""
    angle = 2 * math.pi * np.arange(parts) / parts
    ring = np.c_[np.cos(angle), np.sin(angle), np.zeros(parts)]
    a, b = np.arange(parts), (np.arange(parts) + 1) % parts
    faces = np.vstack([np.c_[a, b, b + parts], np.c_[a, b + parts, a + parts]])
    return Triangles(np.vstack([ring - np.array([0, 0, 20]), ring + np.array([0, 0, 20])]), faces)


def smooth(surface, tool=None):
    """With the normals of the true surface, or with those of the triangles."""
    normals = None if tool is None else tool.gap(surface.points)[1][surface.triangles]
    return Triangulated(surface, normals, sharp=80)


def near(tool, rng, count=1500, depth=0.05):
    """Points on both sides of a tool of triangles."""
    corners = tool.surface.corners[rng.integers(0, len(tool.surface.triangles), count)]
    return np.einsum("tk,tki->ti", rng.dirichlet((1, 1, 1), count), corners) + depth * rng.normal(size=(count, 3))


@pytest.fixture(scope="module")
def ring():
    return smooth(torus(8), TORUS)


# The error ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "true", "given", "orders"),
    [
        (lambda k: sphere(k), Sphere((0, 0, 0), 1.0), True, (3.7, 2.7)),
        (lambda k: sphere(k), Sphere((0, 0, 0), 1.0), False, (3.7, 2.7)),
        (lambda k: torus(2**k), TORUS, True, (3.0, 1.7)),
        (lambda k: torus(2**k), TORUS, False, (2.7, 1.5)),
    ],
    ids=["sphere", "sphere by triangles", "torus", "torus by triangles"],
)
def test_order_of_the_error(make, true, given, orders, rng):
    """Of distance and normal: fourth and third where the third derivatives of the surface vanish, else one less."""
    errors = []
    for k in (2, 3, 4):
        tool = smooth(make(k), true if given else None)
        x = near(tool, rng)
        (g, n, _), (G, N, _) = tool.gap(x), true.gap(x)
        errors.append((np.abs(g - G).max(), np.abs(n - N).max()))
    found = np.log2(np.array(errors[:-1]) / errors[1:]).mean(axis=0)
    print(errors, found)
    assert (found > orders).all()
    assert errors[-1][0] < 3e-4


@pytest.mark.parametrize("given", [True, False])
def test_needles_along_a_bar(given):
    """Triangles that are long along a cylinder, as CAD makes them: the error is of fourth order in their angle."""
    errors = []
    for parts in (12, 24):
        made = tube(parts)
        radial = made.points * (1, 1, 0)
        tool = Triangulated(made, radial[made.triangles] if given else None, sharp=50, open=True)
        t = np.linspace(0.1, 6.1, 300)
        x = np.c_[1.2 * np.cos(t), 1.2 * np.sin(t), 19 * np.sin(7 * t)]
        errors.append(np.abs(tool.gap(x)[0] - 0.2).max())
    assert errors[1] < 2e-4
    assert errors[0] > 12 * errors[1]


def test_flanges_stay_flat_beside_their_fillets():
    """The normal where they meet is that of the flange, as in the drawing; a mean would let it bulge by millimetres."""
    die = UDie(opening=44, depth=20, shoulder_radius=5, bottom_radius=5)
    section = die.profile.points(0.05, beyond=30.0)
    points = np.concatenate([np.c_[section[:, 0], np.full(len(section), y), section[:, 1]] for y in (0.0, 40.0)])
    a = np.arange(len(section) - 1)
    b, c, d = a + 1, a + 1 + len(section), a + len(section)
    tool = Triangulated(Triangles(points, np.vstack([np.c_[a, c, b], np.c_[a, d, c]])), open=True)
    x, y, z = (v.ravel() for v in np.meshgrid(np.linspace(-50, 50, 101), [3.0, 21.0], [-17.0, -10.0, -1.0, 0.5]))
    inside = np.abs(x) < 20.0
    at = np.c_[x, y, np.where(inside, z, np.abs(z))]
    assert np.abs(tool.gap(at)[0] - die.gap(at)[0]).max() < 0.05 / 20


# Derivatives -------------------------------------------------------------------------------------------------


def test_normal_and_hessian_are_derivatives(ring, rng):
    found = check_surface(ring, near(ring, rng, 400, 0.1), 1e-6)
    assert found.ok(1e-6)
    assert found.gradient_length < 1e-8
    _, n, H = ring.gap(near(ring, rng, 400, 0.1))
    assert np.abs(np.linalg.norm(n, axis=1) - 1).max() < 1e-14
    assert np.abs(np.einsum("qij,qj->qi", H, n)).max() < 1e-12


@pytest.mark.parametrize("given", [True, False])
def test_distance_and_normal_are_continuous_across_all_edges(given):
    """Of triangles and of their thirds: from one side to the other the normal turns by the curvature only."""
    surface = torus(4)
    tool = smooth(surface, TORUS if given else None)
    control = tool.patches.control
    step = 1e-6
    for one, other in ((0, 4), (0, 14), (4, 14)):
        for share in (0.2, 0.5, 0.9):
            weights = np.zeros((1, 3))
            weights[0, [{0: 0, 4: 1, 14: 2}[k] for k in (one, other)]] = share, 1 - share
            y = tool.patches.at(weights)[:, 0]
            n = tool.gap(y)[1]
            across = np.cross(n, control[:, other] - control[:, one])
            across *= step / np.linalg.norm(across, axis=1, keepdims=True)
            for height in (-0.1, 0.0, 0.1):
                x = y + height * n
                (g, a, _), (h, b, _) = tool.gap(x - across), tool.gap(x + across)
                assert np.abs(g - h).max() < 1e-10
                assert np.abs(a - b).max() < 20 * step  # curvature 1, at most some 3 of the patches


def test_the_answer_does_not_depend_on_the_order_of_the_questions(ring, rng):
    x = near(ring, rng, 300, 0.3)
    shuffled = rng.permutation(len(x))
    for all_at_once, alone in zip(ring.gap(x), ring.gap(x[shuffled]), strict=True):
        assert np.array_equal(all_at_once[shuffled], alone)
    assert all(np.array_equal(ring.gap(x[i : i + 1])[0], ring.gap(x)[0][i : i + 1]) for i in range(20))


# Edges -------------------------------------------------------------------------------------------------------


def test_a_sharp_box_is_exact(rng):
    true = Box((0.3, 0.1, -0.2), (4.0, 3.0, 2.0))
    tool = Triangulated(true.triangles(ALL))
    assert np.bincount(tool.patches.across).tolist() == [24, 24]
    assert np.bincount(tool.patches.corner).tolist() == [2, 8]
    x = rng.uniform(-4, 4, (3000, 3))
    for mine, exact in zip(tool.gap(x), true.gap(x), strict=True):
        assert np.abs(mine - exact).max() < 1e-11
    assert tool.volume == pytest.approx(24.0)
    assert tool.largest_curvature == math.inf
    assert tool.arrow < 1e-12


def test_curved_edges_of_a_plunger(rng):
    """Rims of a disc: both tangent planes meet along them, so that they are followed as circles are."""
    true = Revolved(Profile.from_corners([(0, -1), (3, -1), (3, 1), (0, 1)], 0.0, closed=False))
    tool = Triangulated(true.triangles(ALL, 0.05), sharp=50)
    x = rng.uniform((-4, -4, -2), (4, 4, 2), (4000, 3))
    g, n, _ = tool.gap(x)
    G, N, _ = true.gap(x)
    assert np.abs(g - G).max() < 0.05 / 100
    clear = (np.abs(G) > 1e-3) & (G > 0)
    assert np.abs(n - N)[clear].max() < 5e-3
    assert check_surface(tool, x[(G > 0.05)][:500], 1e-6).ok(1e-6)


def test_a_rim_is_the_end_of_an_open_surface():
    square = Triangles(np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.0)]), np.array([(0, 1, 2), (0, 2, 3)]))
    tool = Triangulated(square, open=True)
    g, n, H = tool.gap([[0.5, 0.3, 0.2], [0.5, 0.3, -0.2], [1.3, 0.5, -0.4], [-0.3, -0.4, 0.0]])
    np.testing.assert_allclose(g, [0.2, -0.2, 0.5, 0.5], atol=1e-15)
    np.testing.assert_allclose(n[2:], [(0.6, 0, -0.8), (-0.6, -0.8, 0)], atol=1e-15)
    np.testing.assert_allclose(np.trace(H, axis1=1, axis2=2), [0, 0, 2, 4], atol=1e-12)
    assert np.allclose(tool.reversed().gap([[0.5, 0.3, 0.2]])[0], -0.2)


# Files -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("binary", [True, False])
def test_stl_files(tmp_path, binary, rng):
    true = Sphere((5, 2, 1), 3.0)
    path = write_tool(true, tmp_path / "ball.stl", ((0, -3, -4), (9, 6, 5)), chord=0.02)
    if not binary:
        import meshio

        meshio.write(path, meshio.read(path), binary=False)
    tool = Triangulated.from_stl(path)
    x = near(tool, rng, 300)
    assert np.abs(tool.gap(x)[0] - true.gap(x)[0]).max() < 5e-4
    assert tool.arrow == pytest.approx(0.02, rel=0.5)
    assert tool.largest_curvature == pytest.approx(1 / 3, rel=0.2)
    inches = Triangulated.from_stl(path, scale=1 / 25.4)
    assert inches.volume * 25.4**3 == pytest.approx(tool.volume, rel=1e-6)
    drawn = tool.triangles(((0, -3, -4), (9, 6, 5)), 1e-3)
    assert np.abs(true.gap(drawn.points)[0]).max() < 1e-3


def test_a_tool_can_be_sent_to_another_process(ring, rng):
    x = near(ring, rng, 10)
    assert np.array_equal(pickle.loads(pickle.dumps(ring)).gap(x)[0], ring.gap(x)[0])


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(FileProblem, match="there is no such file"):
        Triangulated.from_stl(tmp_path / "nothing.stl")
    (tmp_path / "text.stl").write_text("not a surface")
    with pytest.raises(FileProblem, match="no STL file"):
        Triangulated.from_stl(tmp_path / "text.stl")


@pytest.mark.parametrize(
    ("change", "why"), [(lambda data: data[:-60], "it was cut off"), (lambda data: data + b"a", "there is more behind")]
)
def test_a_file_of_another_size_than_that_of_its_triangles_says_so(tmp_path, capfd, change, why):
    ball = write_tool(Sphere((0, 0, 0), 3), tmp_path / "ball.stl", box=((-4, -4, -4), (4, 4, 4)), chord=0.2)
    ball.write_bytes(change(ball.read_bytes()))
    with pytest.raises(FileProblem, match=why):
        Triangulated.from_stl(ball)
    write_tool(Sphere((0, 0, 0), 3), tmp_path / "ball.ply", box=((-4, -4, -4), (4, 4, 4)), chord=0.2)
    assert capfd.readouterr() == ("", "")


# Refusals ----------------------------------------------------------------------------------------------------


def cube():
    return Box((0, 0, 0), (2.0, 2.0, 2.0)).triangles(ALL)


def without(surface, *ids):
    return Triangles(surface.points, np.delete(surface.triangles, ids, axis=0))


def with_row(surface, *rows):
    return Triangles(surface.points, np.vstack([surface.triangles, *rows]))


def test_holes_are_refused_with_their_places():
    surface = cube()
    at = surface.points[surface.triangles[0]]
    with pytest.raises(HoleInSurface, match="must be closed") as found:
        Triangulated(without(surface, 0))
    around = re.escape("(" + ", ".join(f"{c:.6g}" for c in at.mean(axis=0)) + ")")
    assert re.search(rf"rim of length 6.82843, 3 open edges, around {around}", str(found.value))
    assert Triangulated(without(surface, 0), open=True).gap([[0.0, 0.0, 5.0]])[0][0] > 0


def test_turned_triangles_are_refused_with_their_places():
    surface = cube()
    turned = surface.triangles.copy()
    turned[3] = turned[3, ::-1]
    with pytest.raises(TurnedNormals, match=r"3 edges, at \("):
        Triangulated(Triangles(surface.points, turned))
    with pytest.raises(TurnedNormals, match="volume -8"):
        Triangulated(Triangles(surface.points, surface.triangles[:, ::-1]))


def test_a_swept_section_that_is_wider_than_its_curve_is_refused_as_folded():
    turn, inner = np.linspace(0.0, 0.5, 6), np.array([0.0, 5.0, 12.0])
    radius = 10.0 - inner  # of a plate along a circle of 10; its inner side lies beyond the centre
    points = np.stack([np.outer(radius, np.cos(turn)), np.outer(radius, np.sin(turn)), np.zeros((3, 6))], axis=2)
    at = np.arange(18).reshape(3, 6)
    a, b, c, d = at[:-1, :-1].ravel(), at[1:, :-1].ravel(), at[1:, 1:].ravel(), at[:-1, 1:].ravel()
    plate = Triangles(points.reshape(-1, 3), np.vstack([np.c_[a, b, c], np.c_[a, c, d]]))
    with pytest.raises(UnfitTriangles, match=r"folded.*\n.*\n.*edges?, at \("):
        Triangulated(plate, open=True)
    whole = plate.triangles[[0, 1, 2, 3, 4, 10, 11, 12, 13, 14]]
    gap = Triangulated(Triangles(plate.points, whole), open=True).gap([[7.0, 2.0, 0.5]])[0][0]
    assert abs(gap) == pytest.approx(0.5)


def test_other_triangles_that_are_no_surface():
    surface = cube()
    a, b, c = surface.triangles[0]
    with pytest.raises(UnfitTriangles, match="more than two"):
        Triangulated(with_row(surface, [(a, b, c)]))
    line = Triangles(np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0.0)]), np.array([(0, 1, 2)]))
    with pytest.raises(UnfitTriangles, match=r"no area.*\n.*\n.*1 triangle, at \(1, 0, 0\)"):
        Triangulated(line)
    with pytest.raises(InvalidValue, match="an edge is sharp must be a number between 0 and 90"):
        Triangulated(surface, sharp=120.0)
    with pytest.raises(TurnedNormals, match="looks away"):
        Triangulated(surface, np.tile([0.0, 0.0, 1.0], (16, 3, 1)))


# Offsets -----------------------------------------------------------------------------------------------------


def test_offset_and_counterpart(rng):
    x = rng.uniform(-4, 4, (200, 3))
    for mine, true in zip(Sphere((0, 0, 0), 2.0).offset(0.5).gap(x), Sphere((0, 0, 0), 2.5).gap(x), strict=True):
        assert np.abs(mine - true).max() < 1e-14
    bowl = Sphere((0, 0, 0), 2.0).counterpart(0.5)
    for mine, true in zip(bowl.gap(x), Sphere((0, 0, 0), 2.5, inside=True).gap(x), strict=True):
        assert np.abs(mine - true).max() < 1e-14
    drawn = bowl.triangles(ALL, 0.01)
    assert np.abs(bowl.gap(drawn.points)[0]).max() < 0.01
    assert np.einsum("ti,ti->t", drawn.area_vectors, -drawn.corners.mean(axis=1)).min() > 0
    with pytest.raises(InvalidValue, match="must be finite"):
        Sphere((0, 0, 0), 2.0).offset(math.nan).kernel()


# A run -------------------------------------------------------------------------------------------------------


def test_a_strip_over_a_bar_of_triangles():
    """The force of the exact cylinder to the error of the surface over the penetration."""
    bar = Cylinder((0, 0, -5.0), "y", 5.0)
    made = tube(40)
    along_y = Triangles(5.0 * made.points[:, [1, 2, 0]] - (0, 0, 5), made.triangles)
    forces = []
    for tool in (bar, Triangulated(along_y, open=True)):
        made = strip(12.0, 2.0, 0.8, (12, 1)).moved((0.0, 0.0, 0.4))
        model = Model(made, "ANS3DEAS", material=mt.NeoHooke(E=5e3, nu=0.3))
        model.symmetry("x0", normal="x")
        model.fix([0], "y")
        model.contact("lower", tool, penalty=100.0, points=3, name="tool")
        push = model.prescribe("x1_upper", "z", "push")
        forces.append(solve(model, Move(push, -2.0, steps=5), frames=0, progress=False)["push_force"])
    assert abs(forces[0][-1]) > 1.0
    np.testing.assert_allclose(forces[1], forces[0], rtol=1e-3)


def test_the_forces_do_not_depend_on_the_way_of_the_sheet():
    """Points keep the nearest triangles of the evaluations before: a model without them finds the same bits."""
    x, y = np.meshgrid(np.linspace(-2.0, 12.0, 29), np.linspace(-2.0, 6.0, 17), indexing="ij")
    at = np.arange(x.size).reshape(x.shape)
    a, b, c, d = at[:-1, :-1].ravel(), at[1:, :-1].ravel(), at[1:, 1:].ravel(), at[:-1, 1:].ravel()
    points = np.stack([x, y, 0.3 * np.sin(x) * np.cos(y)], axis=-1).reshape(-1, 3)
    tool = Triangulated(Triangles(points, np.vstack([np.c_[a, b, c], np.c_[a, c, d]])), open=True).moved((0, 0, 0.1))

    def lying():
        model = Model(strip(10.0, 4.0, 0.5, (8, 4)), "ANS3DEAS", material=mt.NeoHooke(E=5e3, nu=0.3))
        model.contact("lower", tool, penalty=100.0, points=2, name="tool")
        return model

    model = lying()
    for step in (0.0, 0.05, 0.6, 3.0, -3.0, 0.01, 0.3, 0.02):
        way = model.system.x.copy()
        way[: model.mesh.points.size] += np.tile([step, 0.3 * step, 0.01 * step], len(model.mesh.points))
        found, fresh = model.evaluate(way), lying().evaluate(way)
        assert np.array_equal(found.residual, fresh.residual)
        assert np.array_equal(found.values, fresh.values)
        assert np.abs(found.residual).max() > 0.1
