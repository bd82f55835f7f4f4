"""Meshes of other programs: hexahedra turned to the thickness, surfaces thickened."""

from __future__ import annotations

import meshio
import numpy as np
import pytest

import umform as uf
from umform import _core
from umform.errors import FoldedElement, InvalidValue, MeshError, WrongCellType
from umform.io.cells import HEX18, MIDDLE_TOLERANCE, to_vtk
from umform.mesh import grid, orient, read, read_shell, strip, thicken
from umform.mesh.directions import CORNERS
from umform.mesh.mesh import FACE_NODES
from umform.mesh.orient import MIDDLE_TOLERANCE as OURS
from umform.mesh.orient import NATURAL
from umform.verification.linear_algebra import linear_solution


def rotations():
    """The 24 ways to put a hexahedron into its own place: orders of its corners."""
    orders = []
    for axes in np.stack(np.meshgrid(*[range(3)] * 3, indexing="ij"), -1).reshape(-1, 3):
        for signs in np.stack(np.meshgrid(*[(-1, 1)] * 3, indexing="ij"), -1).reshape(-1, 3):
            R = np.zeros((3, 3), dtype=int)
            R[range(3), axes] = signs
            if round(np.linalg.det(R)) == 1:
                orders.append(R)
    return orders


def shuffled(cells, natural):
    """Each cell renumbered by a rotation of its own."""
    turns = rotations()
    assert len(turns) == 24
    rows = []
    for k, cell in enumerate(cells):
        order = [int(np.flatnonzero((natural == x).all(axis=1))[0]) for x in natural @ turns[(7 * k + 5) % 24]]
        rows.append(cell[order])
    return np.array(rows)


def thickness_vectors(mesh):
    half = mesh.connectivity.shape[1] // 2
    return mesh.points[mesh.connectivity[:, half:]] - mesh.points[mesh.connectivity[:, :half]]


def volume(mesh):
    x, w = _core.gauss(3)
    q = np.stack(np.meshgrid(x, x, x, indexing="ij"), -1).reshape(-1, 3)
    dN = _core.shell_functions(mesh.connectivity.shape[1], q)[1]
    J = np.linalg.det(np.einsum("qia,eak->eqik", dN, mesh.points[mesh.connectivity]))
    return float((J @ np.einsum("i,j,k->ijk", w, w, w).ravel()).sum())


# Hexahedra --------------------------------------------------------------------------------------------------


def test_tables_are_those_of_the_files():
    layers = np.concatenate([np.column_stack([FACE_NODES, np.full(9, t)]) for t in (-1, 1, 0)])
    np.testing.assert_array_equal(NATURAL, layers[list(HEX18.vtk_nodes)])
    np.testing.assert_array_equal(NATURAL[:8], CORNERS)
    assert OURS == MIDDLE_TOLERANCE


@pytest.mark.parametrize("layers", [1, 2])
@pytest.mark.parametrize("through", ["thinnest", "z", [0.2, 0.1, 1.0], "lower"])
def test_cells_numbered_any_way_are_turned_to_the_thickness(layers, through):
    made = strip(6.0, 4.0, 0.6, (3, 2), layers=layers)
    turned = orient(made.points, shuffled(made.connectivity, CORNERS), made.sets, through=through)
    np.testing.assert_allclose(thickness_vectors(turned), np.broadcast_to([0, 0, 0.6 / layers], (6 * layers, 4, 3)))
    for side in ("lower", "upper"):
        np.testing.assert_array_equal(turned.nodes(side), made.nodes(side))
        assert len(turned.face_set(side)) == 6
        out = turned.points[turned.facets(side)]
        normal = np.cross(out[:, 1] - out[:, 0], out[:, 2] - out[:, 0])[:, 2]
        assert (normal * (1 if side == "upper" else -1) > 0).all()
    assert turned.sets.keys() == made.sets.keys()
    assert volume(turned) == pytest.approx(6 * 4 * 0.6)


def test_the_sense_and_left_handed_cells():
    made = strip(6.0, 4.0, 0.6, (3, 2))
    down = orient(made.points, shuffled(made.connectivity, CORNERS), made.sets, through="-z")
    np.testing.assert_array_equal(down.nodes("x0_upper"), made.nodes("x0_upper"))
    rows = down.face_set("lower")
    np.testing.assert_allclose(down.points[down.connectivity[rows[:, 0], :4]][..., 2], 0.3)
    mirrored = made.points * (1, -1, 1)  # cells that meshio would hand on inside out
    np.testing.assert_allclose(thickness_vectors(orient(mirrored, made.connectivity))[..., 2], 0.6)


def test_a_fine_mesh_of_one_layer_is_thinnest_from_face_to_face():
    """Cells that are longer through the thickness than in the surface."""
    made = strip(4.0, 3.0, 1.0, (16, 12))
    turned = orient(made.points, shuffled(made.connectivity, CORNERS))
    np.testing.assert_allclose(thickness_vectors(turned)[..., 2], 1.0)


def test_an_unstructured_surface_leaves_one_direction():
    """Three cells around an edge: the thickness is found though it is longer than the body is wide."""
    X = np.array([(0, 0), (1, 0), (0.5, 0.9), (-0.5, 0.9), (-1, 0), (-0.5, -0.9), (0.5, -0.9)], dtype=float)
    quads = np.array([(0, 1, 2, 3), (0, 3, 4, 5), (0, 5, 6, 1)])
    points = np.concatenate([np.column_stack([X, np.full(7, z)]) for z in (0.0, 5.0)])
    turned = orient(points, shuffled(np.concatenate([quads, quads + 7], axis=1), CORNERS))
    np.testing.assert_allclose(thickness_vectors(turned)[..., 2], 5.0)


def test_two_bodies_and_a_closed_shell():
    one, other = strip(6.0, 4.0, 0.6, (3, 2)), strip(5.0, 0.4, 4.0, (4, 1))
    points = np.concatenate([one.points, other.points + np.array([0, 20, 0])])
    cells = np.concatenate([one.connectivity, other.connectivity + len(one.points)])
    turned = orient(points, shuffled(cells, CORNERS))
    rise = thickness_vectors(turned)
    np.testing.assert_allclose(rise[:6, :, 2], 0.6)
    np.testing.assert_allclose(rise[6:, :, 1], 0.4)
    angle = np.arange(8) * np.pi / 4
    ring = np.array([(r * np.cos(a), y, r * np.sin(a)) for y in (0.0, 6.0) for r in (5.0, 4.0) for a in angle])
    number = np.arange(32).reshape(2, 2, 8)
    nxt = np.roll(number, -1, axis=2)
    cells = np.stack([number[0, 0], nxt[0, 0], nxt[0, 1], number[0, 1], number[1, 0], nxt[1, 0], nxt[1, 1],
                      number[1, 1]], axis=1)  # fmt: skip
    closed = orient(ring, cells)
    radius = np.hypot(closed.points[:, 0], closed.points[:, 2])
    np.testing.assert_allclose(radius[closed.connectivity[:, :4]], 4.0)


@pytest.mark.parametrize("number", [20, 27])
def test_quadratic_cells_become_hex18_exactly(number):
    flat = strip(6.0, 4.0, 0.6, (2, 2), cell="hex18")
    bent = flat.transformed(lambda x: x + np.column_stack([0 * x[:, 0], 0 * x[:, 0], 0.1 * x[:, 0] * x[:, 1]]))
    vtk = to_vtk(HEX18, bent.points, bent.connectivity)
    cells = shuffled(vtk.connectivity, NATURAL)[:, :number]
    sets = {"x0": np.flatnonzero(vtk.points[:, 0] < 1e-9)}
    turned = orient(vtk.points, cells, sets, through="z")
    assert turned.cell == "hex18"
    assert len(turned.points) == len(bent.points)
    assert volume(turned) == pytest.approx(volume(bent), rel=1e-12)
    np.testing.assert_allclose(thickness_vectors(turned), np.broadcast_to([0, 0, 0.6], (4, 9, 3)), atol=1e-12)
    np.testing.assert_allclose(
        np.unique(np.round(turned.points[turned.nodes("x0")], 9), axis=0),
        np.unique(np.round(bent.points[bent.nodes("x0")], 9), axis=0),
    )


def test_cells_curved_through_the_thickness_are_refused():
    made = strip(6.0, 4.0, 0.6, (2, 2), cell="hex18")
    vtk = to_vtk(HEX18, made.points, made.connectivity)
    points = vtk.points.copy()
    points[len(made.points)] += (0.1, 0, 0)
    with pytest.raises(WrongCellType, match="1 of 4 cells") as caught:
        orient(points, vtk.connectivity)
    assert "near (" in caught.value.where


def test_what_has_no_clear_thickness_is_refused():
    cube = strip(1.0, 1.2, 1.0, (2, 2), layers=2)
    with pytest.raises(MeshError, match="about as thin") as caught:
        orient(cube.points, cube.connectivity)
    assert caught.value.value == "1, 1, 1.2"
    assert orient(cube.points, cube.connectivity, through="x").nodes("lower").size == 9
    with pytest.raises(MeshError, match="no direction of the cells runs along"):
        orient(cube.points, cube.connectivity, through=[1, 1, 1])
    with pytest.raises(MeshError, match="not the lower face"):
        orient(cube.points, cube.connectivity, {"some": [0, 1, 2]}, through="some")
    with pytest.raises(InvalidValue, match="unknown direction"):
        orient(cube.points, cube.connectivity, through="some")
    twice = np.concatenate([cube.connectivity, cube.connectivity[:1]])
    with pytest.raises(MeshError, match="more than two cells"):
        orient(cube.points, np.concatenate([twice, twice[:1]]))


def test_a_ball_of_hexahedra_is_no_sheet():
    """A cube whose corner is cut into four hexahedra of a tetrahedron: every direction turns into every other."""
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], dtype=float)
    ids, points = {}, []

    def node(*which):
        key = tuple(sorted(which))
        if key not in ids:
            ids[key] = len(points)
            points.append(corners[list(key)].mean(axis=0))
        return ids[key]

    cells = []
    for a, b, c, d in ((0, 1, 2, 3), (1, 2, 0, 3), (2, 0, 1, 3), (3, 1, 0, 2)):
        cells.append([node(a), node(a, b), node(a, b, c), node(a, c),
                      node(a, d), node(a, b, d), node(a, b, c, d), node(a, c, d)])  # fmt: skip
    with pytest.raises(MeshError, match="no direction") as caught:
        orient(np.array(points), np.array(cells))
    assert "no sheet" in caught.value.cause


def moebius(count):
    """Quadrilaterals of a band with a half turn; points and ids."""
    lines = []
    for k in range(count):
        a = 2 * np.pi * k / count
        across = np.array([np.cos(a / 2) * np.cos(a), np.cos(a / 2) * np.sin(a), np.sin(a / 2)])
        lines.append([np.array([5 * np.cos(a), 5 * np.sin(a), 0]) + s * across for s in (-1, 1)])
    X = np.array(lines).reshape(-1, 3)
    quads = [[2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1] for k in range(count - 1)]
    return X, np.array([*quads, [2 * count - 2, 1, 0, 2 * count - 1]])


def test_bands_of_moebius_are_refused():
    X, quads = moebius(24)
    with pytest.raises(MeshError, match="one side only") as caught:
        thicken(X, quads, 0.1)
    assert "near (" in caught.value.where
    # the same as solids: four lines of nodes, joined with a half turn of the section
    count = 24
    section = []
    for k in range(count):
        a = 2 * np.pi * k / count
        radial, axial = np.array([np.cos(a), np.sin(a), 0]), np.array([0, 0, 1.0])
        e1, e2 = np.cos(a / 2) * radial + np.sin(a / 2) * axial, -np.sin(a / 2) * radial + np.cos(a / 2) * axial
        section.append([5 * radial + s * e1 + 0.1 * t * e2 for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    number = np.arange(4 * count).reshape(count, 4)
    nxt = np.concatenate([number[1:], number[:1, [2, 3, 0, 1]]])
    with pytest.raises(MeshError, match="no direction") as caught:
        orient(np.array(section).reshape(-1, 3), np.concatenate([number, nxt], axis=1))
    assert "Moebius" in caught.value.cause


# Surfaces ---------------------------------------------------------------------------------------------------


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
def test_a_plane_is_thickened_exactly(nodes, surface, low):
    def warped(q):
        x = 2 * q
        return np.column_stack([x + 0.1 * np.sin(3 * x[:, ::-1]), 0 * q[:, 0]])

    X, quads = surface_of(warped, (4, 3), nodes)
    made = thicken(X, half_flipped(quads), 0.2, {"rim": np.flatnonzero(X[:, 0] < 0.3)}, surface=surface)
    assert made.cell == ("hex8" if nodes == 4 else "hex18")
    np.testing.assert_allclose(thickness_vectors(made)[..., 2], 0.2, rtol=1e-14)
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


def test_too_thick_for_its_radius():
    X, quads = surface_of(cylinder(0.5), (8, 2), 4)
    assert volume(thicken(X, quads, 0.9)) == pytest.approx(0.9 * 0.5 * 1 * 2, rel=0.01)
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


@pytest.mark.parametrize("suffix", [".inp", ".msh"])
def test_solids_with_the_thickness_along_another_direction(tmp_path, suffix):
    made = strip(6.0, 4.0, 0.6, (3, 2))
    cells = shuffled(made.connectivity, CORNERS)
    mesh = meshio.Mesh(made.points, [("hexahedron", cells)], point_sets={"left": made.nodes("x0")})
    path = tmp_path / f"a{suffix}"
    meshio.write(path, mesh, file_format="abaqus" if suffix == ".inp" else "gmsh22")
    turned = read(path, "thinnest")
    np.testing.assert_allclose(thickness_vectors(turned)[..., 2], 0.6)
    if suffix == ".inp":
        np.testing.assert_array_equal(turned.nodes("left"), made.nodes("x0"))
    with pytest.raises(WrongCellType, match="quadrilaterals"):
        read_shell(path, 0.1)


@pytest.mark.parametrize(("suffix", "number"), [(".inp", 20), (".vtu", 20), (".vtu", 27)])
def test_quadratic_solids_from_files(tmp_path, suffix, number):
    made = strip(6.0, 4.0, 0.6, (2, 2), cell="hex18")
    vtk = to_vtk(HEX18, made.points, made.connectivity)
    used, cells = np.unique(shuffled(vtk.connectivity, NATURAL)[:, :number], return_inverse=True)
    left = np.flatnonzero(vtk.points[used, 0] < 1e-9)
    mesh = meshio.Mesh(vtk.points[used], [(f"hexahedron{number}", cells.reshape(-1, number))])
    if suffix == ".inp":
        mesh.point_sets = {"left": left}
    meshio.write(tmp_path / f"a{suffix}", mesh)
    turned = read(tmp_path / f"a{suffix}", "thinnest")
    assert turned.cell == "hex18"
    assert len(turned.points) == len(made.points)
    np.testing.assert_allclose(thickness_vectors(turned)[..., 2], 0.6)
    if suffix == ".inp":
        assert len(turned.nodes("left")) == len(made.nodes("x0"))


def test_groups_of_cells_become_node_sets(tmp_path):
    made = strip(6.0, 4.0, 0.6, (3, 2))
    mesh = meshio.Mesh(made.points, [("hexahedron", made.connectivity)], cell_sets={"first": [np.array([0, 1])]})
    meshio.write(tmp_path / "a.inp", mesh)
    nodes = np.unique(made.connectivity[:2])
    for through in (None, "z"):
        np.testing.assert_array_equal(read(tmp_path / "a.inp", through).nodes("first"), nodes)


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
