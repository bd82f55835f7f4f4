"""Hexahedra of other programs, turned so that their third direction is the thickness."""

from __future__ import annotations

import meshio
import numpy as np
import pytest

from umform.errors import InvalidValue, MeshError, NotFinite, WrongCellType
from umform.io.cells import HEX18, MIDDLE_TOLERANCE, to_vtk
from umform.mesh import orient, read, read_shell, strip, thicken
from umform.mesh.directions import CORNERS
from umform.mesh.mesh import FACE_NODES
from umform.mesh.orient import MIDDLE_TOLERANCE as OURS
from umform.mesh.orient import NATURAL


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


# Hexahedra --------------------------------------------------------------------------------------------------


def test_tables_are_those_of_the_files():
    layers = np.concatenate([np.column_stack([FACE_NODES, np.full(9, t)]) for t in (-1, 1, 0)])
    np.testing.assert_array_equal(NATURAL, layers[list(HEX18.vtk_nodes)])
    np.testing.assert_array_equal(NATURAL[:8], CORNERS)
    assert OURS == MIDDLE_TOLERANCE


@pytest.mark.parametrize("layers", [1, 2])
@pytest.mark.parametrize("through", ["thinnest", "z", [0.2, 0.1, 1.0], "lower"])
def test_cells_numbered_any_way_are_turned_to_the_thickness(layers, through, build):
    made = strip(6.0, 4.0, 0.6, (3, 2), layers=layers)
    turned = orient(made.points, shuffled(made.connectivity, CORNERS), made.sets, through=through)
    expected = np.broadcast_to([0, 0, 0.6 / layers], (6 * layers, 4, 3))
    np.testing.assert_allclose(build.thickness_vectors(turned), expected)
    for side in ("lower", "upper"):
        np.testing.assert_array_equal(turned.nodes(side), made.nodes(side))
        assert len(turned.face_set(side)) == 6
        out = turned.points[turned.facets(side)]
        normal = np.cross(out[:, 1] - out[:, 0], out[:, 2] - out[:, 0])[:, 2]
        assert (normal * (1 if side == "upper" else -1) > 0).all()
    assert turned.sets.keys() == made.sets.keys()
    assert build.volume(turned) == pytest.approx(6 * 4 * 0.6)


def test_the_sense_and_left_handed_cells(build):
    made = strip(6.0, 4.0, 0.6, (3, 2))
    down = orient(made.points, shuffled(made.connectivity, CORNERS), made.sets, through="-z")
    np.testing.assert_array_equal(down.nodes("x0_upper"), made.nodes("x0_upper"))
    rows = down.face_set("lower")
    np.testing.assert_allclose(down.points[down.connectivity[rows[:, 0], :4]][..., 2], 0.3)
    mirrored = made.points * (1, -1, 1)  # cells that meshio would hand on inside out
    np.testing.assert_allclose(build.thickness_vectors(orient(mirrored, made.connectivity))[..., 2], 0.6)


def test_a_fine_mesh_of_one_layer_is_thinnest_from_face_to_face(build):
    """Cells that are longer through the thickness than in the surface."""
    made = strip(4.0, 3.0, 1.0, (16, 12))
    turned = orient(made.points, shuffled(made.connectivity, CORNERS))
    np.testing.assert_allclose(build.thickness_vectors(turned)[..., 2], 1.0)


def test_an_unstructured_surface_leaves_one_direction(build):
    """Three cells around an edge: the thickness is found though it is longer than the body is wide."""
    X = np.array([(0, 0), (1, 0), (0.5, 0.9), (-0.5, 0.9), (-1, 0), (-0.5, -0.9), (0.5, -0.9)], dtype=float)
    quads = np.array([(0, 1, 2, 3), (0, 3, 4, 5), (0, 5, 6, 1)])
    points = np.concatenate([np.column_stack([X, np.full(7, z)]) for z in (0.0, 5.0)])
    turned = orient(points, shuffled(np.concatenate([quads, quads + 7], axis=1), CORNERS))
    np.testing.assert_allclose(build.thickness_vectors(turned)[..., 2], 5.0)


def test_two_bodies_and_a_closed_shell(build):
    one, other = strip(6.0, 4.0, 0.6, (3, 2)), strip(5.0, 0.4, 4.0, (4, 1))
    points = np.concatenate([one.points, other.points + np.array([0, 20, 0])])
    cells = np.concatenate([one.connectivity, other.connectivity + len(one.points)])
    turned = orient(points, shuffled(cells, CORNERS))
    rise = build.thickness_vectors(turned)
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
def test_quadratic_cells_become_hex18_exactly(number, build):
    flat = strip(6.0, 4.0, 0.6, (2, 2), cell="hex18")
    bent = flat.transformed(lambda x: x + np.column_stack([0 * x[:, 0], 0 * x[:, 0], 0.1 * x[:, 0] * x[:, 1]]))
    vtk = to_vtk(HEX18, bent.points, bent.connectivity)
    cells = shuffled(vtk.connectivity, NATURAL)[:, :number]
    sets = {"x0": np.flatnonzero(vtk.points[:, 0] < 1e-9)}
    turned = orient(vtk.points, cells, sets, through="z")
    assert turned.cell == "hex18"
    assert len(turned.points) == len(bent.points)
    assert build.volume(turned) == pytest.approx(build.volume(bent), rel=1e-12)
    np.testing.assert_allclose(build.thickness_vectors(turned), np.broadcast_to([0, 0, 0.6], (4, 9, 3)), atol=1e-12)
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


# Files -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".inp", ".msh"])
def test_solids_with_the_thickness_along_another_direction(tmp_path, suffix, build):
    made = strip(6.0, 4.0, 0.6, (3, 2))
    cells = shuffled(made.connectivity, CORNERS)
    mesh = meshio.Mesh(made.points, [("hexahedron", cells)], point_sets={"left": made.nodes("x0")})
    path = tmp_path / f"a{suffix}"
    meshio.write(path, mesh, file_format="abaqus" if suffix == ".inp" else "gmsh22")
    turned = read(path, "thinnest")
    np.testing.assert_allclose(build.thickness_vectors(turned)[..., 2], 0.6)
    if suffix == ".inp":
        np.testing.assert_array_equal(turned.nodes("left"), made.nodes("x0"))
    with pytest.raises(WrongCellType, match="quadrilaterals"):
        read_shell(path, 0.1)


@pytest.mark.parametrize(("suffix", "number"), [(".inp", 20), (".vtu", 20), (".vtu", 27)])
def test_quadratic_solids_from_files(tmp_path, suffix, number, build):
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
    np.testing.assert_allclose(build.thickness_vectors(turned)[..., 2], 0.6)
    if suffix == ".inp":
        assert len(turned.nodes("left")) == len(made.nodes("x0"))


def test_groups_of_cells_become_node_sets(tmp_path):
    made = strip(6.0, 4.0, 0.6, (3, 2))
    mesh = meshio.Mesh(made.points, [("hexahedron", made.connectivity)], cell_sets={"first": [np.array([0, 1])]})
    meshio.write(tmp_path / "a.inp", mesh)
    nodes = np.unique(made.connectivity[:2])
    for through in (None, "z"):
        np.testing.assert_array_equal(read(tmp_path / "a.inp", through).nodes("first"), nodes)


def test_points_that_are_no_numbers_are_named_with_their_file(tmp_path):
    flat = [("quad", [[0, 1, 2, 3]])]
    meshio.write(tmp_path / "a.vtu", meshio.Mesh([(0, 0, 0), (1, 0, 0), (np.nan, 1, 0), (0, 1, 0)], flat))
    with pytest.raises(NotFinite, match="not finite") as caught:
        read_shell(tmp_path / "a.vtu", 0.1)
    assert caught.value.where == f"{tmp_path / 'a.vtu'}, point 2"
