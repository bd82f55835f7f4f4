"""What the page draws in space: numbers that come back from the packing, normals, places of tools, what is left out."""

import json
import zlib
from base64 import b64decode

import numpy as np
import pytest

import umform as uf
from umform.report.facets import smooth_groups
from umform.report.packing import Quantised
from umform.report.scene import scene_of
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


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
def test_positions_and_fields_come_back(cell):
    result = bent(cell=cell)
    head, arrays = unpacked(scene_of(result).data)
    faces, points = arrays["faces"].reshape(-1, 4), arrays["points"].reshape(-1, 3)
    assert [mark["row"] for mark in head["frames"]] == [frame.number for frame in result.frames]
    for number in range(len(result.frames)):
        shape = Shape.of(result, number)
        x = points + arrays["displacements"][number].reshape(-1, 3)
        np.testing.assert_allclose(x[faces], shape.points[shape.quads], atol=2e-5)
        for name in ("thickness_change", "displacement"):
            values = arrays[f"field {name}"][number][faces].mean(axis=1)
            expected = (
                shape.values[name]
                if name in shape.values
                else np.linalg.norm(result.frames[number].points["displacement"], axis=1)[shape.quads].mean(axis=1)
            )
            np.testing.assert_allclose(values, expected, atol=2e-5 * max(np.abs(expected).max(), 0.5))


def test_fields_of_cells_belong_to_the_cells_of_the_faces():
    steel = uf.J2(kappa=175e3, mu=80.77e3, hardening=uf.Linear(yield_stress=160, modulus=500))
    model = uf.Model(uf.mesh.strip(8, 2, 0.5, (4, 1)), "ANS3DEAS", material=steel)
    model.fix("x0", "xyz")
    result = uf.solve(model, uf.Move(model.prescribe("x1", "z", name="end"), to=1.0, steps=4), progress=False, frames=9)
    head, arrays = unpacked(scene_of(result).data)
    (field,) = [field for field in head["fields"] if field["name"] == "plastic_strain_max"]
    assert (field["on"], field["label"], field["map"]) == ("cells", "plastic strain max", "viridis")
    expected = Shape.of(result).values["plastic_strain_max"]
    assert expected.max() > 0.001
    got = arrays["field plastic_strain_max"][-1][arrays["owners"]]
    np.testing.assert_allclose(got, expected, atol=1e-5 * expected.max())


def test_a_field_with_two_signs_has_a_scale_about_zero(result):
    fields = {field["name"]: field for field in unpacked(scene_of(result).data)[0]["fields"]}
    change = np.concatenate([frame.points["thickness_change"] for frame in result.frames])
    assert change.min() < 0 < change.max()
    assert fields["thickness_change"]["map"] == "coolwarm"
    assert not fields["contact_pressure"]["symmetric"]
    assert "contact_gap" not in fields  # not a number where there is no facet


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
    moved = arrays["displacements"].reshape(-1, 3)
    assert np.linalg.norm(moved, axis=1).max() == pytest.approx(
        np.linalg.norm(model.u.reshape(-1, 3), axis=1).max(), rel=1e-4
    )


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
