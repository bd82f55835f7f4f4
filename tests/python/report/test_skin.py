"""The skin of a part for renderers: faces and edges as the shape functions have them, whole parts, files with tools."""

import h5py
import numpy as np
import pytest

import umform as uf
from umform.io.vtkhdf_reader import frames_in
from umform.report.part import Part
from umform.report.rendering import creases, rolling_lines
from umform.report.skin import skin_of
from umform.report.stored_scene import read_frame
from umform.report.symmetry import Mirror
from umform.surfaces.triangles import Triangles

RADIUS = 10.0


def on_cylinder(cell, count, angle=np.pi / 2):
    """A strip of unit thickness bent around the y-axis, as a part."""
    strip = uf.mesh.strip(1.0, 2.0, 1.0, (count, 2), cell=cell)
    X = strip.points
    r, a = RADIUS + X[:, 2], angle * X[:, 0]
    x = np.c_[r * np.sin(a), X[:, 1], r * np.cos(a)]
    return Part.deformed(X, strip.connectivity, {"displacement": x - X, "height": X[:, 2]}, {})


def inner_radius_error(part, parts=8):
    """Largest distance of points of the upper and lower faces from their cylinders."""
    skin = skin_of(part, "height", parts)
    r = np.hypot(skin.points[:, 0], skin.points[:, 2])
    flat = np.isclose(np.abs(skin.values), 0.5)
    return np.abs(r - RADIUS - skin.values)[flat].max()


@pytest.mark.parametrize(("cell", "order"), [("hex8", 2), ("hex18", 4)])
def test_faces_on_a_cylinder_are_as_round_as_the_shape_functions(cell, order):
    """A chord is off by h^2, a parabola through three points by h^4 at the middle of its halves."""
    coarse, fine = (inner_radius_error(on_cylinder(cell, count)) for count in (3, 6))
    assert np.log2(coarse / fine) == pytest.approx(order, abs=0.15)
    assert inner_radius_error(on_cylinder("hex18", 6)) < 1e-4 * RADIUS


def test_normals_are_those_of_the_curved_faces_and_sharp_at_the_edges():
    skin = skin_of(on_cylinder("hex18", 4), "height", 4)
    radial = skin.points * [1.0, 0.0, 1.0] / np.hypot(skin.points[:, 0], skin.points[:, 2])[:, None]
    assert np.linalg.norm(skin.normals, axis=1) == pytest.approx(1.0, abs=0.01)
    count = 2 * 4 * 2 * 25  # points of the faces of the sheet, which come first: below and above
    sign = np.sign(skin.values[:count])
    assert np.einsum("pi,pi->p", skin.normals[:count], radial[:count]) * sign == pytest.approx(1.0, abs=2e-3)
    across = np.einsum("pi,pi->p", skin.normals[count:], radial[count:])
    assert across == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
def test_lines_are_the_edges_of_the_elements_and_no_others(cell):
    nx, ny = 5, 2
    skin = skin_of(on_cylinder(cell, nx), None, 4)
    along = 2 * (nx * (ny + 1) + ny * (nx + 1))  # below and above
    assert sum(map(len, skin.lines)) == along + 2 * (nx + ny)  # and those through the thickness at the rim
    curved = skin.lines[0]
    assert curved.shape[1] == (5 if cell == "hex18" else 2)
    r = np.hypot(curved[..., 0], curved[..., 2])
    assert np.ptp(r, axis=1).max() < (2e-3 if cell == "hex18" else 1e-9)  # the ends of a chord are on the cylinder


def test_each_outer_face_is_there_once():
    skin = skin_of(on_cylinder("hex18", 5), None, 3)
    assert len(skin.owners) == 2 * 5 * 2 + 2 * (5 + 2)
    assert skin.areas.sum() == pytest.approx(2 * 2.0 * np.pi / 2 * RADIUS + 2 * np.pi / 2 * RADIUS + 2 * 2.0, rel=5e-3)
    outside = np.einsum("fi,fi->f", skin.directions, skin.middles - skin.middles.mean(axis=0))
    above = np.hypot(skin.middles[:, 0], skin.middles[:, 2]) > RADIUS + 0.4
    assert (outside[above] > 0.0).all()


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
def test_mirrored_parts_join_without_a_gap(cell):
    """At the planes there are no faces, no lines through the thickness, and one normal on both sides."""
    mesh = uf.mesh.disc(10.0, 1.0, (2, 2), part="quarter", cell=cell)
    X = mesh.points
    u = np.zeros_like(X)
    u[:, 2] = 0.05 * (X[:, 0] ** 2 + X[:, 1] ** 2)
    way = np.tile([1.0, 2.0, 0.0], (len(mesh.connectivity), 1))
    part = Part.deformed(X, mesh.connectivity, {"displacement": u}, {"rolling": way, "strain": np.arange(len(way))})
    whole = part.whole([Mirror(0, 0.0), Mirror(1, 0.0)])
    assert len(whole.cells) == 4 * len(part.cells)
    skin = skin_of(whole, "displacement", 2)
    rim = np.hypot(*skin.middles.T[:2]) > 9.0
    assert (np.abs(skin.directions[:, 2])[~rim] > 0.5).all()  # all others are below and above
    assert np.abs(skin.directions[:, 2])[rim].min() < 0.5
    on = np.flatnonzero(np.abs(skin.points[:, 0]) < 1e-12)
    middle = on[np.hypot(*skin.points[on].T[:2]) < 8.0]
    assert np.abs(skin.normals[middle, 0]).max() < 2e-3
    ends = np.concatenate([skin.points[skin.quads[:, [0, 1]]], skin.points[skin.quads[:, [1, 2]]]])
    ends = np.concatenate([ends, skin.points[skin.quads[:, [2, 3]]], skin.points[skin.quads[:, [3, 0]]]])
    keys = np.sort(np.unique(np.round(ends, 9).reshape(-1, 3), axis=0, return_inverse=True)[1].reshape(-1, 2), axis=1)
    assert (np.unique(keys, axis=0, return_counts=True)[1] == 2).all()  # closed: each edge has two sides
    signs = np.sign(whole.cellwise["rolling"][:: len(part.cells), :2])
    assert sorted(map(tuple, signs)) == [(-1, -1), (-1, 1), (1, -1), (1, 1)]
    assert (np.ptp(whole.cellwise["strain"].reshape(4, -1), axis=0) == 0.0).all()


def test_means_of_cells_at_corners():
    strip = uf.mesh.strip(3.0, 1.0, 1.0, (3, 1))
    part = Part.deformed(strip.points, strip.connectivity, {}, {"strain": np.array([1.0, 3.0, 7.0])})
    skin = skin_of(part, "strain", 2)
    for x, value in ((0.0, 1.0), (0.5, 1.5), (1.0, 2.0), (2.0, 5.0), (3.0, 7.0)):
        assert skin.values[np.isclose(skin.points[:, 0], x)] == pytest.approx(value)


def test_lines_along_the_rolling_direction():
    """On the faces that it lies in, and on no others."""
    sheet = uf.mesh.strip(2.0, 1.0, 1.0, (2, 1))
    directions = np.array([[0.6, 0.8, 0.0], [0.0, 1.0, 0.0]])
    ends = rolling_lines(skin_of(Part.deformed(sheet.points, sheet.connectivity, {}, {})), directions)
    along = ends[:, 1] - ends[:, 0]
    way = along / np.linalg.norm(along, axis=1, keepdims=True)
    middle = ends.mean(axis=1)
    first = middle[:, 0] < 1.0
    above = np.abs(middle[:, 2]) > 0.5
    assert above.sum() == 4
    assert np.abs(way[first & above]) == pytest.approx(np.tile([0.6, 0.8, 0.0], (2, 1)), abs=1e-6)
    assert np.abs(way[~first & above]) == pytest.approx(np.tile([0.0, 1.0, 0.0], (2, 1)), abs=1e-6)
    assert len(ends) == 5  # above and below both cells; the end of the second, which its direction lies in


def test_edges_of_a_tool():
    """Twelve edges of a box; cut, five of its faces are left, and the cut is free."""
    box = uf.Box((0.0, 0.0, 0.0), (4.0, 2.0, 2.0), 0.0).triangles(((-5.0,) * 3, (5.0,) * 3))
    edges, free = creases(box)
    lengths = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
    assert lengths.sum() == pytest.approx(4 * (4.0 + 2.0 + 2.0))
    assert not free.any()
    half = box.beyond((1.0, 0.0, 0.0), (1.0, 0.0, 0.0))
    assert half.points[:, 0].min() == pytest.approx(1.0)
    edges, free = creases(half)
    assert edges[free][..., 0] == pytest.approx(1.0)
    assert np.linalg.norm(edges[free][:, 1] - edges[free][:, 0], axis=1).sum() == pytest.approx(8.0)


@pytest.fixture(scope="module")
def pressed(tmp_path_factory):
    """Half of a strip on a cylinder: a result and its file."""
    model = uf.Model(uf.mesh.strip(12, 4, 0.8, (6, 2)), "ANS3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    model.symmetry("x0", normal="x")
    model.fix([0], "y")
    punch = model.contact("upper", uf.Cylinder((0, 0, 2.4), "y", 2.0), penalty=100, points=2, name="punch")
    model.contact("lower", uf.Cylinder((9, 0, -2.4), "y", 2.0), penalty=100, points=2, name="roll")
    way = model.drive(punch, "-z", name="way")
    result = uf.solve(model, uf.Move(way, 1.0, steps=4), frames=4, progress=False)
    return result, result.write(tmp_path_factory.mktemp("scene") / "run.vtkhdf")


def test_a_file_of_fields_has_the_tools_where_they_stand(pressed):
    result, file = pressed
    part, tools = read_frame(file, -1)
    assert frames_in(file) == len(result.frames)
    assert sorted(tools) == ["punch", "roll"]
    axis = np.array([0.0, 2.4 - 1.0])
    assert np.linalg.norm(tools["punch"].points[:, [0, 2]] - axis, axis=1) == pytest.approx(2.0, abs=0.02)
    roll = tools["roll"].points
    away = np.hypot(np.abs(roll[:, 0]) - 9.0, roll[:, 2] + 2.4)
    assert away == pytest.approx(2.0, abs=0.02)
    assert (roll[:, 0] < 0.0).any()  # its image, which the punch has not
    assert (roll[:, 0] > 0.0).any()
    assert len(part.cells) == 2 * len(result.model.mesh.connectivity)
    n = len(result.model.mesh.points)
    assert part.points[:n] == pytest.approx(result.model.positions)
    assert read_frame(file, -1, whole=False)[0].reference == pytest.approx(result.model.mesh.points)
    first, tools = read_frame(file, 0)
    assert first.points == pytest.approx(first.reference)
    assert np.abs(tools["punch"].points[:, 2].min() - 0.4) < 0.02


def test_a_file_without_tools_is_read(pressed, tmp_path):
    bare = tmp_path / "bare.vtkhdf"
    bare.write_bytes(pressed[1].read_bytes())
    with h5py.File(bare, "a") as file:
        del file["umform"]
    part, tools = read_frame(bare, -1)
    assert tools == {}
    assert len(part.cells) == len(pressed[0].model.mesh.connectivity)


def test_images_of_a_tool_are_seen_from_outside(pressed):
    for tool in read_frame(pressed[1], -1)[1].values():
        out = Triangles(tool.points, tool.triangles).area_vectors
        middle = tool.corners.mean(axis=1)
        axis = np.where(np.abs(middle[:, 0]) < 4.0, 0.0, np.sign(middle[:, 0]) * 9.0)
        assert (out[:, 0] * (middle[:, 0] - axis) >= -1e-9).all()
