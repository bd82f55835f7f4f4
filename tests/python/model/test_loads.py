"""Dead loads and follower pressure: totals, moments, tangent, and what a model refuses."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from umform import _core
from umform import materials as mt
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue, NotFinite, RigidBodyMotion, ToolSwallowsSheet, WrongCellType
from umform.mesh import Mesh, strip
from umform.model import Model
from umform.model.terms import forces as nodal
from umform.surfaces import Plane, Sphere

LAW = mt.NeoHooke(E=1000.0, nu=0.3)
CELLS = ("hex8", "hex18")
L, W, T = 3.0, 2.0, 0.4
VECTOR = np.array([1.0, -2.0, 3.0])


@pytest.fixture(params=CELLS)
def sheet(request, build):
    """A plate of L x W x T with distorted cells in its inside; its outline is that of a box."""
    return build.jittered(strip(L, W, T, (3, 3), cell=request.param, layers=2), 0.1)


def total_and_moment(made, forces):
    forces = forces.reshape(-1, 3)
    return forces.sum(axis=0), np.cross(made.points, forces).sum(axis=0)


@pytest.mark.parametrize(
    ("face", "area", "centre"),
    [
        ("lower", L * W, (L / 2, W / 2, -T / 2)),
        ("upper", L * W, (L / 2, W / 2, T / 2)),
        ("x0", W * T, (0, W / 2, 0)),
        ("x1", W * T, (L, W / 2, 0)),
        ("y0", L * T, (L / 2, 0, 0)),
        ("y1", L * T, (L / 2, W, 0)),
    ],
)
def test_traction_has_the_right_total_and_moment(sheet, face, area, centre):
    forces = nodal.traction_forces(sheet, face, VECTOR)
    total, moment = total_and_moment(sheet, forces)
    np.testing.assert_allclose(total, area * VECTOR, rtol=1e-13)
    np.testing.assert_allclose(moment, np.cross(centre, area * VECTOR), atol=1e-13)
    loaded = np.flatnonzero(np.abs(forces.reshape(-1, 3)).sum(axis=1))
    np.testing.assert_array_equal(loaded, sheet.nodes(face))


def test_traction_on_several_faces_at_once_is_the_sum(sheet):
    rows = np.concatenate([sheet.face_set(name) for name in ("lower", "x1", "y0")])
    parts = sum(nodal.traction_forces(sheet, name, VECTOR) for name in ("lower", "x1", "y0"))
    np.testing.assert_allclose(nodal.traction_forces(sheet, rows, VECTOR), parts, atol=1e-14)


def test_body_force_has_the_right_total_and_moment(sheet):
    total, moment = total_and_moment(sheet, nodal.body_forces(sheet, VECTOR))
    np.testing.assert_allclose(total, L * W * T * VECTOR, rtol=1e-13)
    np.testing.assert_allclose(moment, np.cross((L / 2, W / 2, 0), L * W * T * VECTOR), atol=1e-13)


@pytest.mark.parametrize("layers", [1, 2])
@pytest.mark.parametrize(("side", "z"), [("lower", -T / 2), ("upper", T / 2)])
@pytest.mark.parametrize(
    ("face", "length", "centre"),
    [("x0", W, (0, W / 2)), ("x1", W, (L, W / 2)), ("y0", L, (L / 2, 0)), ("y1", L, (L / 2, W))],
)
@pytest.mark.parametrize("cell", CELLS)
def test_line_load_has_the_right_total_and_moment(build, cell, face, length, centre, side, z, layers):
    made = build.jittered(strip(L, W, T, (3, 3), cell=cell, layers=layers), 0.1)
    forces = nodal.edge_forces(made, face, side, VECTOR)
    total, moment = total_and_moment(made, forces)
    np.testing.assert_allclose(total, length * VECTOR, rtol=1e-13)
    np.testing.assert_allclose(moment, np.cross((*centre, z), length * VECTOR), atol=1e-13)
    loaded = np.flatnonzero(np.abs(forces.reshape(-1, 3)).sum(axis=1))
    np.testing.assert_array_equal(loaded, made.nodes(f"{face}_{side}"))


def test_nodal_forces_are_the_same_on_each_node(sheet):
    forces = nodal.nodal_forces(sheet, "x1_upper", VECTOR).reshape(-1, 3)
    ids = sheet.nodes("x1_upper")
    np.testing.assert_array_equal(forces[ids], np.tile(VECTOR, (len(ids), 1)))
    assert np.abs(forces).sum() == pytest.approx(len(ids) * 6.0)


def test_consistent_forces_of_a_nine_node_face():
    made = strip(1.0, 1.0, 0.1, (1, 1), cell="hex18")
    forces = nodal.traction_forces(made, "upper", (0, 0, 36.0)).reshape(-1, 3)
    np.testing.assert_allclose(forces[made.connectivity[0, 9:], 2], [1, 1, 1, 1, 4, 4, 4, 4, 16], rtol=1e-13)


def test_a_load_enters_the_residual_with_its_factor(sheet):
    model = Model(sheet, "ANS3DEAS" if sheet.cell == "hex8" else "MI9K3DEAS", material=LAW)
    load = model.traction("upper", VECTOR)
    weight = model.loads.body_force((0, 0, -1.0))
    load.value, weight.value = 2.5, -1.0
    evaluation = model.evaluate(model.u)
    np.testing.assert_allclose(-evaluation.residual, 2.5 * load.vector - weight.vector, atol=1e-12)
    expected = math.hypot(2.5 * np.linalg.norm(load.vector), np.linalg.norm(weight.vector))
    assert evaluation.force_scale == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("load", ["traction", "line_load", "body_force", "force"])
def test_reactions_carry_the_load(build, load):
    model = Model(build.jittered(strip(L, W, T, (3, 3)), 0.1), material=LAW)
    model.fix("x0")
    vector = (0.0, 0.1, 0.05)
    control = {
        "traction": lambda: model.traction("upper", vector),
        "line_load": lambda: model.line_load("x1", "upper", vector),
        "body_force": lambda: model.loads.body_force(vector),
        "force": lambda: model.force("x1", vector),
    }[load]()
    solve(model, Move(control, 1.0, steps=2), frames=0)
    assert control.name == load
    residual = model.evaluate(model.u).residual.reshape(-1, 3)
    applied = control.vector.reshape(-1, 3)
    np.testing.assert_allclose(residual.sum(axis=0), -applied.sum(axis=0), atol=1e-8)
    x = model.positions
    balance = np.cross(x, residual + applied).sum(axis=0)
    np.testing.assert_allclose(balance, 0.0, atol=1e-8)


# Follower pressure ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize("face", ["lower", "upper"])
def test_pressure_tangent_is_the_derivative_of_the_force(build, rng, cell, face):
    made = build.jittered(strip(L, W, T, (2, 2), cell=cell), 0.1, normal=0.05)
    block = _core.pressure_block(made.facets(face), made.points)
    block.pressure = 1.7
    full = build.full_tangent(block, len(made.points))
    u = 0.1 * rng.normal(size=full.size)
    f, K = full(u)
    assert np.abs(K - K.T).max() > 0.01 * np.abs(K).max()
    for _ in range(3):
        du = rng.normal(size=u.size)
        assert build.relative_error(K @ du, build.central_difference(full.force, u, du, 1e-5)) < 1e-9
    Kdu, again = np.zeros(full.size), np.zeros(full.size)
    values = np.zeros(full.pattern.indices.size)
    block.evaluate(u, full.scatter, again, values, du, Kdu)
    np.testing.assert_array_equal(again, f)
    np.testing.assert_allclose(Kdu, K @ du, atol=1e-13)


@pytest.mark.parametrize("cell", CELLS)
@pytest.mark.parametrize(("face", "sign"), [("lower", 1.0), ("upper", -1.0)])
def test_pressure_pushes_against_the_outward_normal_and_turns_with_the_sheet(build, rotation, cell, face, sign):
    made = build.jittered(strip(L, W, T, (3, 3), cell=cell), 0.1)
    block = _core.pressure_block(made.facets(face), made.points)
    block.pressure = 2.0
    full = build.full_tangent(block, len(made.points))
    at_rest = -full.force(np.zeros(full.size)).reshape(-1, 3)
    np.testing.assert_allclose(at_rest.ravel(), nodal.traction_forces(made, face, (0, 0, 2 * sign)), atol=1e-13)
    turned = -full.force((1.5 * made.points @ rotation.T - made.points).ravel()).reshape(-1, 3)
    np.testing.assert_allclose(turned, 1.5**2 * at_rest @ rotation.T, atol=1e-12)


def closed_box(cuts=3):
    """The shell of a cube: cells stand on its surface with their upper faces outside."""
    lines = np.linspace(-1.0, 1.0, cuts + 1)
    faces = []
    for axis, side in itertools.product(range(3), (-1.0, 1.0)):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for i, j in itertools.product(range(cuts), repeat=2):
            corners = np.zeros((4, 3))
            corners[:, axis] = side
            corners[:, a] = lines[[i, i + 1, i + 1, i]]
            corners[:, b] = lines[[j, j, j + 1, j + 1]]
            faces.append(corners if side > 0 else corners[[0, 3, 2, 1]])
    corners = np.concatenate(faces)
    outer, ids = np.unique(np.round(corners, 12), axis=0, return_inverse=True)
    quads = ids.reshape(-1, 4)
    return Mesh(np.concatenate([0.9 * outer, outer]), {"hex8": np.hstack([quads, quads + len(outer)])})


def test_pressure_on_a_closed_surface_is_self_balanced_with_a_symmetric_tangent(build, rng):
    made = closed_box()
    rows = np.stack([np.arange(len(made.connectivity)), np.ones(len(made.connectivity))], axis=1).astype(int)
    block = _core.pressure_block(made.facets(rows), made.points)
    block.pressure = 3.0
    full = build.full_tangent(block, len(made.points))
    u = 0.05 * rng.normal(size=full.size)
    f, K = full(u)
    total, moment = f.reshape(-1, 3).sum(axis=0), np.cross(made.points + u.reshape(-1, 3), f.reshape(-1, 3)).sum(axis=0)
    np.testing.assert_allclose(total, 0.0, atol=1e-12)
    np.testing.assert_allclose(moment, 0.0, atol=1e-12)
    np.testing.assert_allclose(K, K.T, atol=1e-13)
    open_rows = rows[:-1]
    opened = _core.pressure_block(made.facets(open_rows), made.points)
    opened.pressure = 3.0
    K_open = build.full_tangent(opened, len(made.points))(u)[1]
    assert np.abs(K_open - K_open.T).max() > 0.01


@pytest.mark.parametrize(("cell", "element"), [("hex8", "ANS3DEAS"), ("hex18", "MI9K3DEAS")])
def test_a_strip_under_pressure_converges_quadratically(cell, element):
    model = Model(strip(10.0, 2.0, 0.2, (8, 1), cell=cell), element, material=LAW)
    model.fix("x0")
    pressure = model.pressure("lower", "pressure")
    result = solve(model, Move(pressure, 0.004, steps=8), frames=0)
    tip = model.u.reshape(-1, 3)[model.mesh.nodes("x1")]
    assert tip[:, 2].mean() > 4.0  # far beyond small rotations
    assert tip[:, 0].mean() < -1.0
    assert not model.system.pattern.symmetric
    assert result["iterations"][1:].max() <= 8
    for records in result.iterations[1:]:
        before, last = records[-2].residual, records[-1].residual
        assert last < max(1e5 * before**2, 1e-10)
    assert result["pressure"][-1] == result["pressure_force"][-1] == 0.004
    # The reactions balance the pressure on the deformed face.
    residual = model.evaluate(model.u).residual
    residual[model.system.free] = 0.0
    if cell == "hex8":
        x = model.positions[model.mesh.facets("lower")]
        area = 0.5 * np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]).sum(axis=0)  # exact for bilinear faces
        np.testing.assert_allclose(residual.reshape(-1, 3).sum(axis=0), 0.004 * area, atol=1e-9)


# Refusals ---------------------------------------------------------------------------------------------------


@pytest.fixture
def model():
    return Model(strip(L, W, T, (3, 2)), material=LAW)


@pytest.mark.parametrize(
    ("vector", "error"), [((1.0, 2.0), InvalidValue), ((1.0, math.nan, 0.0), NotFinite), (3.0, InvalidValue)]
)
def test_load_vectors_need_three_finite_components(model, vector, error):
    for load in (
        lambda: model.force("x1", vector),
        lambda: model.traction("upper", vector),
        lambda: model.line_load("x1", "upper", vector),
        lambda: model.loads.body_force(vector),
    ):
        with pytest.raises(error):
            load()


def test_line_loads_need_a_lateral_face_and_a_side(model):
    with pytest.raises(InvalidValue, match="lateral"):
        model.line_load("upper", "upper", VECTOR)
    with pytest.raises(InvalidValue, match="lower or on the upper"):
        model.line_load("x1", "middle", VECTOR)


def test_pressure_on_lateral_faces_is_refused(model):
    with pytest.raises(InvalidValue, match="lower and upper"):
        model.pressure("x1")


def test_a_displacement_is_prescribed_once(model):
    model.prescribe("x1", "z", "first")
    with pytest.raises(InvalidValue, match="prescribed twice") as caught:
        model.prescribe("x1_lower", "z", "second")
    assert "first" in str(caught.value)
    assert "second" in str(caught.value)
    model.prescribe("x1", "y")
    model.fix("x0")
    with pytest.raises(InvalidValue, match="prescribed twice") as caught:
        model.prescribe("x0", "x")
    assert f"node {model.mesh.nodes('x0')[0]}," in caught.value.where


@pytest.mark.parametrize("hold", ["fix", "symmetry"])
def test_a_prescribed_displacement_cannot_be_held_too(model, hold):
    model.prescribe("x1", "z", "pull")
    with pytest.raises(InvalidValue, match="prescribed twice") as caught:
        getattr(model, hold)("x1_lower", "z")
    assert caught.value.value == "by pull and by fix or symmetry"
    assert caught.value.where == f"node {model.mesh.nodes('x1_lower')[0]}, direction z"
    model.fix("x1_lower", "xy")  # the other directions are free to be held


def test_a_held_displacement_cannot_be_prescribed_too(model):
    model.fix("x1_lower", "xz")
    with pytest.raises(InvalidValue, match="prescribed twice") as caught:
        model.prescribe("x1", "z", "pull")
    assert caught.value.value == "by fix or symmetry and by pull"
    assert caught.value.where == f"node {model.mesh.nodes('x1_lower')[0]}, direction z"
    assert not model.controls
    model.prescribe("x1", "y", "pull")


def test_names_of_controls_are_unique(model):
    model.force("x1", VECTOR, "pull")
    for taken in ("pull", "time"):
        with pytest.raises(InvalidValue, match="the name is taken: two columns of the history would collide"):
            model.traction("upper", VECTOR, taken)
    assert [model.force("x1", VECTOR).name for _ in range(3)] == ["force", "force2", "force3"]


@pytest.mark.parametrize("direction", ["w", "xy", ""])
def test_directions_are_x_y_z(model, direction):
    with pytest.raises(InvalidValue, match="x, y or z"):
        model.prescribe("x1", direction)


def test_elements_stand_on_their_cells(model):
    with pytest.raises(WrongCellType, match="MI9K3DEAS stands on hex18"):
        Model(model.mesh, "MI9K3DEAS", material=LAW)


@pytest.mark.parametrize(("order", "points"), [(1, 1), (2, 2), (3, 3), (4, 2)])
def test_thickness_points_must_see_the_highest_mode(order, points):
    with pytest.raises(InvalidValue):
        Model(strip(L, W, T, (1, 1)), material=LAW, thickness_order=order, thickness_points=points)


def test_thickness_points_by_default_suit_material_and_order():
    def points(material, **options):
        return Model(strip(L, W, T, (1, 1)), material=material, **options).bodies.only.thickness_points

    assert points(LAW) == 2
    assert points(LAW, thickness_order=3) == 4
    assert points(mt.J2(E=1.0, nu=0.3, hardening=mt.Perfect(1.0))) == 12


@pytest.mark.parametrize(
    ("supports", "motions"),
    [
        ([], ["translation x", "translation y", "translation z"]),
        ([("x0", "x")], []),
        ([("x0", "xz"), ("y0", "y")], None),
        ([("x0", "x"), ("y0", "y")], ["translation z"]),
        ([("lower", "z"), ("y0", "y")], ["translation x"]),
        ([("lower", "z"), ("x0", "x")], ["translation y"]),
        ([("x0_lower", "xyz")], ["rotation about y"]),
        ([("y0_lower", "xyz")], ["rotation about x"]),
    ],
)
def test_rigid_body_motions_left_free_are_named(model, supports, motions):
    for nodes, directions in supports:
        model.fix(nodes, directions)
    if motions is None:
        model.system.check()
        return
    with pytest.raises(RigidBodyMotion) as caught:
        solve(model, [], frames=0)
    for motion in ("translation x", "translation y", "translation z"):
        if len(supports) >= 2:
            assert (motion in caught.value.value) == (motion in motions)
    if len(supports) == 1:
        assert all(motion in caught.value.value for motion in motions)


def test_the_number_of_free_motions_is_told(model):
    with pytest.raises(RigidBodyMotion, match="in 6 ways"):
        model.system.check()
    model.symmetry("x0", "x")
    with pytest.raises(RigidBodyMotion, match="in 3 ways"):
        model.system.check()
    model.fix("y0", "y")
    with pytest.raises(RigidBodyMotion, match="in 1 way "):
        model.system.check()
    model.fix("y0_lower", "z")
    model.fix("y1_lower", "z")
    model.system.check()


def test_friction_holds_the_sheet_along_the_tool_while_it_touches(model):
    contact = model.contact("lower", Plane((0, 0, -T / 2)), penalty=100.0, friction=0.1)
    model.system.check()
    model.set_motion(contact, lambda time: np.array([0.0, 0.0, -0.01]))
    with pytest.raises(RigidBodyMotion, match="in 6 ways"):
        model.system.check()


def test_a_tool_in_touch_holds_the_sheet_and_one_at_a_distance_does_not(model):
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    contact = model.contact("lower", Plane((0, 0, -T / 2)), penalty=100.0)
    model.system.check()
    model.set_motion(contact, lambda time: np.array([0.0, 0.0, -0.01]))
    with pytest.raises(RigidBodyMotion) as caught:
        model.system.check()
    assert "translation z" in caught.value.value


def test_a_tool_on_the_wrong_side_is_refused(model):
    model.fix("x0")
    model.contact("lower", Plane((0, 0, -T / 2)), penalty=100.0, name="right")
    model.system.check()
    model.contact("upper", Plane((0, 0, T / 2), "-z"), penalty=100.0, name="from above")
    model.system.check()
    model.contact("lower", Plane((0, 0, 0.6 * T)), penalty=100.0, name="die")
    with pytest.raises(ToolSwallowsSheet) as caught:
        solve(model, [], frames=0)
    assert "die" in caught.value.where
    assert "gap" in caught.value.value


def test_chords_of_a_formed_sheet_may_overlap_the_radius_of_a_tool(model):
    """Its contact points lie on the tool, its nodes do not: no tool has been placed wrongly."""
    model.fix("x0")
    contact = model.contact("lower", Plane((0, 0, 0.6 * T)), penalty=100.0)
    contact.restore(contact.state())  # its points have a history
    model.system.check()


def test_a_tool_that_touches_with_its_normal_into_the_sheet_is_refused(model):
    """All gaps of the contact points are zero; the far face tells."""
    model.fix("x0")
    model.contact("lower", Plane((0, 0, -T / 2), "-z"), penalty=100.0)
    with pytest.raises(ToolSwallowsSheet):
        model.system.check()


def test_a_contact_point_on_the_axis_of_a_tool_is_refused(model):
    model.fix("x0")
    model.contact("lower", Sphere((0, 0, -T / 2), 0.1 * T), penalty=100.0, points="nodes")
    with pytest.raises(ToolSwallowsSheet, match="no normal"):
        model.system.check()


def test_a_node_without_a_cell_is_refused():
    mesh = strip(4.0, 1.0, T, (2, 1))
    stray = Mesh(np.vstack([mesh.points, [[9.0, 9.0, 9.0]]]), mesh.cells, mesh.sets, mesh.faces)
    model = Model(stray, material=mt.SVK(E=1000.0, nu=0.3))
    model.fix("x0")
    with pytest.raises(RigidBodyMotion, match="belongs to no cell"):
        model.system.check()


def test_a_model_without_a_free_degree_of_freedom_is_refused(model):
    model.fix("x0")
    model.fix(lambda x, y, z: x > -1)
    with pytest.raises(InvalidValue, match="leave some nodes free"):
        model.evaluate(model.u)
