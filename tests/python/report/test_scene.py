"""What the page draws in space: numbers that come back from the packing, normals, places of tools, what is left out."""

import json
import zlib
from base64 import b64decode

import numpy as np
import pytest
from matplotlib.colors import to_hex

import umform as uf
from umform.plotting import COLOUR_MAP
from umform.report.facets import smooth_groups
from umform.report.looks import MILLIMETRES
from umform.report.packing import Quantised
from umform.report.part import Part, plane_strain
from umform.report.patches import Surface
from umform.report.scene import scene_of
from umform.report.skin import skin_of
from umform.report.stored_scene import read_frame
from umform.report.symmetry import Mirror
from umform.results.shape import Shape


def unpacked(data):
    """Record and arrays, read as the page reads them."""
    raw = zlib.decompress(b64decode(data), wbits=31)
    length = int.from_bytes(raw[:4], "little")
    head, arrays = json.loads(raw[4 : 4 + length]), {}
    for name, entry in head["arrays"].items():
        block = raw[4 + length + entry["start"] :][: entry["bytes"]]
        if "type" in entry:
            kind = {"Float32Array": "<f4", "Uint32Array": "<u4"}[entry["type"]]
            arrays[name] = np.frombuffer(block, kind)
        else:
            low, high = np.frombuffer(block, np.uint8).reshape(2, entry["frames"], -1).astype(np.uint16)
            codes = np.cumsum(low + 256 * high, axis=0, dtype=np.uint16)
            arrays[name] = entry["low"] + entry["step"] * codes
    return head, arrays


def bent(tool=None, cell="hex8", motion=None):
    """A clamped strip whose end goes up, over a tool that is driven down."""
    strip = uf.mesh.strip(8, 2, 0.5, (4, 1), cell=cell)
    model = uf.Model(strip, "ANS3DEAS" if cell == "hex8" else "MI9K3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    model.fix("x0", "xyz")
    moves = {model.prescribe("x1", "z", name="end"): 0.5}
    if tool is not None:
        moves[model.drive(model.contact("lower", tool, penalty=10.0, name="tool"), "z", name="drop")] = -0.25
        if motion is not None:
            model.set_motion(model.contacts[0], motion)
    steps = [uf.Move(control, to=to, steps=2) for control, to in moves.items()]
    return uf.solve(model, steps, progress=False, frames=10)


@pytest.fixture(scope="module")
def result():
    return bent(uf.Cylinder((4, 0, -3), "y", 2.0))


def surface_in(head, arrays, x):
    """Points of the faces for positions of the nodes, by the matrices of the scene."""
    found = []
    for number in range(len(head["patches"])):
        weights = arrays[f"patches {number} position"].reshape(-1, np.prod(head["patches"][number]["grid"]))
        nodes = arrays[f"patches {number} nodes"].reshape(-1, weights.shape[1])
        found.append(np.einsum("pn,mnc->mpc", weights, x[nodes]).reshape(-1, x.shape[1]))
    return np.concatenate(found)


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
def test_surface_and_fields_are_those_of_the_pictures(cell):
    """The scene interpolates as `skin_of` does, which PyVista draws."""
    result = bent(cell=cell)
    head, arrays = unpacked(scene_of(result).data)
    X, cells = result.model.mesh.points, result.model.mesh.connectivity
    assert [mark["row"] for mark in head["frames"]] == [frame.number for frame in result.frames]
    for number, frame in enumerate(result.frames):
        skin = skin_of(
            Part.deformed(X, cells, frame.points, frame.cells), "thickness_change", head["patches"][0]["points"][0] - 1
        )
        x = arrays["points"].reshape(-1, 3) + arrays["displacements"][number].reshape(-1, 3)
        np.testing.assert_allclose(surface_in(head, arrays, x), skin.points, atol=2e-5)
        values = surface_in(head, arrays, arrays["field thickness_change"][number][:, None])[:, 0]
        np.testing.assert_allclose(values, -100.0 * skin.values, atol=2e-3)


def test_fields_of_cells_are_means_at_the_corners():
    steel = uf.J2(kappa=175e3, mu=80.77e3, hardening=uf.Linear(yield_stress=160, modulus=500))
    model = uf.Model(uf.mesh.strip(8, 2, 0.5, (4, 1)), "ANS3DEAS", material=steel)
    model.fix("x0", "xyz")
    result = uf.solve(model, uf.Move(model.prescribe("x1", "z", name="end"), to=1.0, steps=4), progress=False, frames=9)
    head, arrays = unpacked(scene_of(result).data)
    (field,) = [field for field in head["fields"] if field["name"] == "plastic_strain_max"]
    assert (field["on"], field["label"]) == ("corners", "largest plastic strain")
    strain = result.frames[-1].cells["plastic_strain_max"]
    assert strain.max() > 0.001
    x, got = arrays["points"].reshape(-1, 3)[:, 0], arrays["field plastic_strain_max"][-1]
    for at, mean in ((0.0, strain[0]), (2.0, strain[:2].mean()), (8.0, strain[3])):
        assert got[np.isclose(x, at)] == pytest.approx(mean, rel=1e-3)


def test_fields_have_words_units_and_one_colour_map(result):
    head, _ = unpacked(scene_of(result, MILLIMETRES).data)
    labels = {field["name"]: field["label"] for field in head["fields"]}
    assert labels["thickness_change"] == "thinning, %"
    assert labels["contact_pressure"] == "contact pressure, MPa"
    assert labels["displacement"] == "displacement, mm"
    assert "contact_gap" not in labels  # not a number where there is no facet
    assert len(head["look"]["map"]) == 6 * 64
    assert head["look"]["map"].startswith(to_hex(COLOUR_MAP(0.0))[1:])
    assert head["look"]["map"].endswith(to_hex(COLOUR_MAP(1.0))[1:])
    assert "displacement" in scene_of(result).fields  # without units that nobody has named


def test_faces_in_a_plane_of_symmetry_are_the_last_and_its_normals_lie_in_it():
    """In the whole part there are no faces inside, and no edge where the halves meet."""
    mesh = uf.mesh.strip(4, 2, 0.5, (4, 2), cell="hex18")
    surface = Surface.of(mesh.points, mesh.connectivity, 2, [Mirror(0, 0.0)])
    across = surface.patches[1]
    assert across.inner == 2
    inside = np.abs(mesh.points[across.corner_nodes][:, :, 0]).max(axis=1) < 1e-9
    assert np.flatnonzero(inside).tolist() == [len(inside) - 2, len(inside) - 1]
    (seam,) = surface.seams
    assert len(seam) == 2 * 3 + 2 * 2  # on both faces of the sheet, and at the two rims


def test_tools_stand_where_they_stood(result):
    contact = result.model.contacts[0]
    before = contact.pose[1].copy(), contact.tool.ways[0].value
    head, arrays = unpacked(scene_of(result).data)
    assert head["tools"] == ["tool"]
    poses = arrays["tool 0 poses"].reshape(-1, 3, 4)
    np.testing.assert_allclose(poses[:, 2, 3], [result.rows[mark["row"]]["drop"] for mark in head["frames"]])
    np.testing.assert_array_equal(poses[:, :, :3], np.broadcast_to(np.eye(3), (len(poses), 3, 3)))
    points = arrays["tool 0 points"].reshape(-1, 3)
    depth = 2.0 - np.hypot(points[:, 0] - 4, points[:, 2] + 3)
    assert depth.min() > -1e-6
    assert depth.max() < 5e-4 * 12.0  # the chord error: 1/2000 of the diagonal of the box that is drawn
    np.testing.assert_array_equal(contact.pose[1], before[0])
    assert contact.tool.ways[0].value == before[1]


def test_a_turning_tool_turns():
    result = bent(uf.Cylinder((4, 0, -3), "y", 2.0), motion=lambda time: (np.zeros(3), np.array([0, 0, 0.1 * time])))
    _, arrays = unpacked(scene_of(result).data)
    poses = arrays["tool 0 poses"].reshape(-1, 3, 4)
    times = np.array([frame.time for frame in result.frames])
    np.testing.assert_allclose(poses[:, 0, 0], np.cos(0.1 * times), atol=1e-6)


def floor(x):
    return x[:, 2] + 0.9, np.tile([0.0, 0, 1], (len(x), 1)), np.zeros((len(x), 3, 3))


def test_a_function_is_drawn_from_its_samples():
    scene = scene_of(bent(uf.UserSurface(floor, name="floor")))
    assert scene.tools == ["tool"]
    assert scene.notes == []
    _, arrays = unpacked(scene.data)
    np.testing.assert_allclose(arrays["tool 0 points"].reshape(-1, 3)[:, 2], -0.9, atol=1e-6)


def test_a_function_that_fails_off_the_sheet_is_left_out_with_a_note():
    def shy(x):
        if np.abs(x).max() > 8.5:
            raise ZeroDivisionError("too far away")
        return floor(x)

    scene = scene_of(bent(uf.UserSurface(shy, name="floor")))
    assert scene.tools == []
    (note,) = scene.notes
    assert "The tool tool is not drawn" in note
    assert "fails around the tool" in note


def test_without_frames_the_last_state_is_drawn(result):
    model = result.model
    bare = uf.Result(model)
    head, arrays = unpacked(scene_of(bare).data)
    assert len(head["frames"]) == 1
    assert [field["name"] for field in head["fields"]] == ["displacement"]
    places = arrays["points"].reshape(-1, 3) + arrays["displacements"].reshape(-1, 3)
    assert places.max(axis=0) == pytest.approx(model.positions.max(axis=0), abs=1e-5)
    assert places.min(axis=0) == pytest.approx(model.positions.min(axis=0), abs=1e-5)


def test_quantised_numbers_are_off_by_half_a_step_at_most():
    values = np.random.default_rng(1).normal(size=(7, 50))
    packed = Quantised.of(values)
    assert np.abs(packed.low + packed.step * packed.codes - values).max() <= 0.501 * packed.step
    assert packed.step == pytest.approx(np.ptp(values) / 65535)
    np.testing.assert_array_equal(Quantised.of(np.full((2, 3), 4.0)).low, 4.0)


def test_edges_of_a_box_are_sharp_and_its_sides_are_smooth():
    shape = Shape.displaced(uf.mesh.strip(4, 2, 0.5, (4, 2)), np.zeros((2 * 5 * 3, 3)))
    groups = smooth_groups(shape.points, shape.quads)
    assert groups.max() + 1 == 2 * 15 + 2 * 2 * 5 + 2 * 2 * 3  # points of the six sides, those of edges once for each


def test_a_bend_of_small_angles_is_smooth():
    angles = np.radians(np.arange(0, 91, 15))
    arc = np.array([[np.cos(a), y, np.sin(a)] for a in angles for y in (0.0, 1.0)])
    quads = np.array([[2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2] for i in range(6)])
    assert smooth_groups(arc, quads).max() + 1 == len(arc)
    assert smooth_groups(arc[[0, 1, 12, 13, 6, 7]], np.array([[0, 1, 3, 2], [2, 3, 5, 4]])).max() + 1 == 8


def test_a_tool_of_one_side_gets_an_image_and_one_of_both_a_larger_picture():
    model = uf.Model(uf.mesh.strip(8, 4, 0.5, (4, 2)), "ANS3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    model.symmetry("x0", "x")
    model.fix([0], "y")
    model.contact("lower", uf.Cylinder((5, 0, -2.25), "y", 2.0), penalty=10.0, name="bar")
    model.contact("upper", uf.Plane((0, 0, 0.3), "-z"), penalty=10.0, name="lid")
    push = model.prescribe("x0_lower", "z", name="push")
    result = uf.solve(model, uf.Move(push, to=-0.5, steps=2), progress=False, frames=5)
    head, arrays = unpacked(scene_of(result).data)
    assert head["mirrors"] == [{"axis": 0, "at": 0.0}]
    assert dict(zip(head["tools"], head["toolMirrors"], strict=True)) == {"bar": [0], "lid": []}
    bar, lid = (arrays[f"tool {n} points"].reshape(-1, 3)[:, 0] for n in (0, 1))
    assert bar.min() > 0.0
    assert lid.min() == pytest.approx(-lid.max())


def test_rolling_direction_of_the_cells():
    """One vector for each cell that is seen; a scene without says so."""
    strip = uf.mesh.strip(8, 2, 0.5, (4, 1))
    model = uf.Model(strip, "ANS3DEAS", material=uf.SVK(E=1000.0, nu=0.3), rolling=uf.rolling_at(30))
    model.fix("x0", "xyz")
    result = uf.solve(model, uf.Move(model.prescribe("x1", "z", name="end"), to=2.0, steps=2), progress=False, frames=2)
    scene = scene_of(result)
    head, arrays = unpacked(scene.data)
    shown = arrays["rolling"].reshape(len(result.frames), -1, 3)
    assert scene.rolling
    assert head["rolling"]
    assert shown[-1] == pytest.approx(result.frames[-1].cells["rolling"], abs=1e-3)
    assert not scene_of(bent()).rolling


def test_plane_strain_is_drawn_wide_with_its_tools_in_pages_and_files(tmp_path):
    """A strip of 0.5 mm would be a thread; it is the same in each section."""
    model = uf.Model(uf.mesh.strip(8, 0.5, 0.5, (4, 1)), "ANS3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    model.fix("x0", "xz")
    model.fix(range(len(model.mesh.points)), "y")
    model.contact("lower", uf.Cylinder((4, 0, -3), "y", 2.0), penalty=10.0, name="tool")
    push = model.prescribe("x1", "z", name="push")
    result = uf.solve(model, uf.Move(push, to=-0.2, steps=2), progress=False, frames=2)
    scene = scene_of(result, MILLIMETRES)
    _, arrays = unpacked(scene.data)
    width = np.ptp(arrays["points"].reshape(-1, 3)[:, 1])
    assert width == pytest.approx(0.3 * 8)
    assert np.ptp(arrays["tool 0 points"].reshape(-1, 3)[:, 1]) > width
    assert scene.notes == ["Plane strain: the same in each section, drawn 2.4 mm wide."]
    part, tools = read_frame(result.write(tmp_path / "run.vtkhdf"), -1)
    assert np.ptp(part.points[:, 1]) == pytest.approx(width)
    assert np.ptp(tools["tool"].points[:, 1]) > width
    assert plane_strain(bent().model) is None


def turned(Q, c, *, narrow=False):
    """A quarter, or a strip in plane strain, that was turned and moved into other tools and is bent there."""
    mesh = uf.mesh.strip(8, 0.5 if narrow else 4, 0.5, (4, 2))
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    along = lambda k: "xyz"[int(np.argmax(np.abs(Q[:, k])))]  # noqa: E731
    model.u = (mesh.points @ Q.T + c - mesh.points).ravel()
    model.fix("x0", along(0), here=True)
    model.fix(range(len(mesh.points)) if narrow else "y0", along(1), here=True)
    model.fix([0], along(2), here=True)
    load = model.force("x1", -0.005 * Q[:, 2], name="load")
    return uf.solve(model, uf.Move(load, 1.0, steps=2), progress=False, frames=2)


@pytest.mark.parametrize("narrow", [False, True])
def test_a_part_in_other_tools_has_the_pictures_of_one_that_stayed(narrow, tmp_path):
    """Planes of symmetry and the width of plane strain are those of the place where it lies."""
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    found = []
    for name, Q, c in (
        ("stays", np.eye(3), 0.0),
        ("turned", turn, np.array([10.0, 20.0, 5.0])),
        ("over", np.diag([1.0, -1.0, -1.0]), np.array([0.0, 0.0, 3.0])),
    ):
        result = turned(Q, c, narrow=narrow)
        head, arrays = unpacked(scene_of(result).data)
        part, _ = read_frame(result.write(tmp_path / f"{name}.vtkhdf"), -1)
        places = arrays["points"].reshape(-1, 3) + arrays["displacements"][-1].reshape(-1, 3)
        extents = [np.ptp((x - c) @ Q, axis=0) for x in (places, part.points)]
        inner = [patch["inner"] for patch in head["patches"]]
        seams = [len(arrays[f"seam {k}"]) for k in range(len(head["mirrors"]))]
        found.append((len(part.points), inner, sorted(seams), np.concatenate(extents)))
    for other in found[1:]:
        assert other[:3] == found[0][:3]
        assert other[3] == pytest.approx(found[0][3], abs=1e-5)
