"""Surfaces of other programs, thickened to sheets."""

from __future__ import annotations

import meshio
import numpy as np
import pytest

import umform as uf
from umform.errors import FoldedElement, InvalidValue, MeshError, WrongCellType
from umform.mesh import grid, read, read_shell, thicken
from umform_book.linear_algebra import linear_solution


def surface_of(points_of, shape, nodes):
    """Quadrilaterals of 4, 8 or 9 nodes over the unit square mapped by a function."""
    flat = grid(*(np.linspace(0, 1, n + 1) for n in shape), [0, 1], "hex8" if nodes == 4 else "hex18")
    half = flat.connectivity.shape[1] // 2
    quads = flat.connectivity[:, :half][:, :nodes]
    used, quads = np.unique(quads, return_inverse=True)
    return points_of(flat.points[used][:, :2]), quads.reshape(-1, nodes)


def half_flipped(quads):
    turned = {4: [0, 3, 2, 1], 8: [0, 3, 2, 1, 7, 6, 5, 4], 9: [0, 3, 2, 1, 7, 6, 5, 4, 8]}[quads.shape[1]]
    out = quads.copy()
    out[1::3] = out[1::3][:, turned]
    return out


def cylinder(radius):
    return lambda q: np.column_stack([radius * np.sin(q[:, 0]), 2 * q[:, 1], radius * np.cos(q[:, 0])])


def sphere(radius):
    def points(q):
        a, b = 1.2 * (q - 0.5).T
        x = np.column_stack([np.tan(a), np.tan(b), np.ones(len(a))])
        return radius * x / np.linalg.norm(x, axis=1)[:, None]

    return points


@pytest.mark.parametrize("nodes", [4, 8, 9])
@pytest.mark.parametrize(("surface", "low"), [("middle", -0.1), ("lower", 0.0), ("upper", -0.2)])
def test_a_plane_is_thickened_exactly(nodes, surface, low, build):
    def warped(q):
        x = 2 * q
        return np.column_stack([x + 0.1 * np.sin(3 * x[:, ::-1]), 0 * q[:, 0]])

    X, quads = surface_of(warped, (4, 3), nodes)
    made = thicken(X, half_flipped(quads), 0.2, {"rim": np.flatnonzero(X[:, 0] < 0.3)}, surface=surface)
    assert made.cell == ("hex8" if nodes == 4 else "hex18")
    np.testing.assert_allclose(build.thickness_vectors(made)[..., 2], 0.2, rtol=1e-14)
    np.testing.assert_allclose(np.unique(np.round(made.points[:, 2], 12)), [low, low + 0.2], atol=1e-12)
    np.testing.assert_array_equal(made.nodes("rim"), np.union1d(made.nodes("rim_lower"), made.nodes("rim_upper")))
    np.testing.assert_allclose(made.points[made.nodes("rim_upper"), 2], low + 0.2)
    assert len(made.face_set("lower")) == len(made.face_set("upper")) == 12


@pytest.mark.parametrize("nodes", [4, 8, 9])
@pytest.mark.parametrize("shape", [cylinder, sphere])
def test_the_thickness_of_a_curved_shell_converges(nodes, shape):
    """Distance of the faces along the radius, with an error of order h^2."""
    errors = []
    for n in (4, 8, 16):
        X, quads = surface_of(shape(5.0), (n, n), nodes)
        made = thicken(X, half_flipped(quads), 0.4)
        x = made.points * ((1, 0, 1) if shape is cylinder else (1, 1, 1))
        radius = np.linalg.norm(x, axis=1)
        sides = np.sort(np.stack([radius[made.nodes("lower")], radius[made.nodes("upper")]]), axis=0)
        errors.append(np.abs(sides[1] - sides[0] - 0.4).max() / 0.4)
    assert errors[-1] < 2e-3
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 1.8).all(), (errors, orders)


def test_the_thickness_may_vary():
    X, quads = surface_of(lambda q: np.column_stack([q, 0 * q[:, 0]]), (3, 3), 8)
    made = thicken(X, quads, 0.1 + X[:, 0] ** 2)
    half = len(made.points) // 2
    x, t = made.points[:half, 0], made.points[half:, 2] - made.points[:half, 2]
    np.testing.assert_allclose(t, 0.1 + x**2, rtol=1e-12)


@pytest.mark.parametrize("angle", [30.0, 90.0])
def test_a_kink_keeps_the_thickness_of_both_sides(angle):
    a = np.radians(angle)
    X = np.array([(x, y, 0) for x in (-2.0, -1.0, 0.0) for y in (0.0, 1.0)]
                 + [(s * np.cos(a), y, s * np.sin(a)) for s in (1.0, 2.0) for y in (0.0, 1.0)])  # fmt: skip
    quads = np.array([(2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1) for k in range(4)])
    made = thicken(X, quads, 0.2)
    count = len(X)
    offset = made.points[count:] - made.points[:count]
    for normal, nodes in (((0, 0, 1), range(6)), ((-np.sin(a), 0, np.cos(a)), range(4, 10))):
        np.testing.assert_allclose(offset[list(nodes)] @ normal, 0.2, rtol=1e-13)
    if angle == 90.0:
        with pytest.raises(InvalidValue, match="too sharp") as caught:
            thicken(X, quads, 0.2, kink=80.0)
        assert caught.value.where.startswith(("node 4,", "node 5,"))
        assert "90.0 degrees" in caught.value.value


def test_a_corner_of_three_faces_keeps_the_thickness_of_all():
    X = np.array([(x, y, z) for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)])
    made = thicken(X, [(0, 4, 5, 1), (0, 2, 6, 4), (0, 1, 3, 2)], 0.1, surface="lower", kink=120.0)
    moved = made.points[made.nodes("upper")] - made.points[made.nodes("lower")]
    np.testing.assert_allclose(np.abs(moved[0]), 0.1, rtol=1e-12)


def test_too_thick_for_its_radius(build):
    X, quads = surface_of(cylinder(0.5), (8, 2), 4)
    assert build.volume(thicken(X, quads, 0.9)) == pytest.approx(0.9 * 0.5 * 1 * 2, rel=0.01)
    with pytest.raises(FoldedElement, match="12 of 16 cells fold") as caught:
        thicken(X, quads, 1.1)
    assert "near (" in caught.value.where


def test_surfaces_that_branch_or_have_no_normal_are_refused():
    X = np.array(
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, -1, 0), (1, -1, 0), (0, 0, 1), (1, 0, 1)], dtype=float
    )
    with pytest.raises(MeshError, match="more than two cells") as caught:
        thicken(X, [(0, 1, 3, 2), (4, 5, 1, 0), (0, 1, 7, 6)], 0.1)
    assert "near (0.5, 0, 0)" in caught.value.where
    with pytest.raises(MeshError, match="no normal"):
        thicken(X * (1, 0, 0), [(0, 1, 3, 2)], 0.1)
    for wrong in (0.0, -1.0, np.nan, [0.1, 0.1]):
        with pytest.raises(InvalidValue, match="thickness"):
            thicken(X, [(0, 1, 3, 2)], wrong)
    with pytest.raises(InvalidValue, match="surface"):
        thicken(X, [(0, 1, 3, 2)], 0.1, surface="top")
    with pytest.raises(WrongCellType):
        thicken(X, [(0, 1, 3)], 0.1)


# Files ------------------------------------------------------------------------------------------------------

SHELL = """\
*NODE
1, 0., 0., 0.
2, 1., 0.1, 0.
3, 2., 0., 0.
4, 0., 1., 0.
5, 0.9, 1.2, 0.
6, 2., 1., 0.
99, 5., 5., 5.
*ELEMENT, TYPE=S4R
1, 1, 2, 5, 4
2, 2, 5, 6, 3
*NSET, NSET=left
1, 4
*ELSET, ELSET=second
2
"""


def test_a_shell_from_abaqus(tmp_path):
    (tmp_path / "a.inp").write_text(SHELL)
    made = read_shell(tmp_path / "a.inp", 0.2, surface="lower")
    assert made.connectivity.shape == (2, 8)
    assert len(made.points) == 12
    np.testing.assert_allclose(made.points[made.nodes("left_upper")], [(0, 0, 0.2), (0, 1, 0.2)])
    np.testing.assert_array_equal(np.unique(made.points[made.nodes("second"), 0]), [0.9, 1.0, 2.0])


@pytest.mark.parametrize("kind", ["quad", "quad8", "quad9"])
def test_a_shell_from_gmsh(tmp_path, kind):
    nodes = {"quad": 4, "quad8": 8, "quad9": 9}[kind]
    X, quads = surface_of(lambda q: np.column_stack([q, 0.1 * q[:, 0] ** 2]), (2, 2), nodes)
    edge = quads[:, [3, 0]][X[quads[:, 0], 0] < 1e-9]
    tags = [np.full(len(quads), 2), np.full(len(edge), 1)]
    mesh = meshio.Mesh(
        X, [(kind, quads), ("line", edge)], cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={"left": np.array([1, 1]), "sheet": np.array([2, 2])},
    )  # fmt: skip
    meshio.write(tmp_path / "a.msh", mesh, file_format="gmsh22", binary=False)
    made = read_shell(tmp_path / "a.msh", 0.05)
    assert made.cell == ("hex8" if nodes == 4 else "hex18")
    assert len(made.nodes("sheet")) == len(made.points)
    assert {"left", "left_lower", "left_upper"} <= made.sets.keys()
    assert len(made.nodes("left_lower")) == 3
    with pytest.raises(WrongCellType, match="hexahedra"):
        read(tmp_path / "a.msh", through="z")


def test_triangles_and_mixed_orders_are_refused(tmp_path):
    X = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)], dtype=float)
    meshio.write_points_cells(tmp_path / "a.vtu", X, [("quad", [[0, 1, 2, 3]]), ("triangle", [[1, 4, 2]])])
    with pytest.raises(WrongCellType) as caught:
        read_shell(tmp_path / "a.vtu", 0.1)
    assert caught.value.value == "1 quad, 1 triangle"
    assert "recombine" in caught.value.remedy


# Mechanics --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("nodes", "element"), [(4, "ANS3DEAS"), (8, "DISP9K3DEAS"), (9, "DISP9K3DEAS")])
def test_patch_test_on_a_thickened_plate(nodes, element):
    """A state of constant strain on a distorted plate that came as a surface of mixed orientation."""

    def distorted(q):
        inner = np.prod(np.sin(np.pi * q), axis=1)
        return np.column_stack([4 * q[:, 0] + 0.3 * inner, 3 * q[:, 1] - 0.2 * inner, 0 * inner])

    X, quads = surface_of(distorted, (3, 3), nodes)
    rim = np.flatnonzero((X[:, 0] % 4 < 1e-9) | (np.abs(X[:, 0] - 4) < 1e-9) | (np.abs(X[:, 1] - 1.5) > 1.5 - 1e-9))
    made = thicken(X, half_flipped(quads), 0.2, {"rim": rim})
    nu = 0.3
    model = uf.Model(made, element, material=uf.SVK(E=1000.0, nu=nu))
    model.fix("rim")
    gradient = 1e-3 * np.array([[1.0, 0.4, 0.0], [0.4, -0.7, 0.0], [0.0, 0.0, -nu / (1 - nu) * 0.3]])
    exact = made.points @ gradient
    found = linear_solution(model, prescribed=exact)
    free = np.setdiff1d(np.arange(len(made.points)), made.nodes("rim"))
    assert len(free) >= 8
    np.testing.assert_allclose(found[free], exact[free], atol=1e-11 * np.abs(exact).max())
