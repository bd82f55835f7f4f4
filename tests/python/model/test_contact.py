"""Penalty contact: tangent, uniform pressure, resultants, tools that move, and what user functions may do wrong."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from umform import _core
from umform import materials as mt
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue, NoConvergence, NotFinite, RigidBodyMotion
from umform.mesh import strip
from umform.model import Model
from umform.model.contact.face_basis import hat_functions
from umform.model.terms import forces
from umform.results import fields
from umform.surfaces import Cylinder, Plane, Sphere, UserSurface

ELASTIC = mt.NeoHooke(E=1000.0, nu=0.3)
ELEMENT = {"hex8": "ANS3DEAS", "hex18": "MI9K3DEAS"}
POINTS = [*range(1, 11), "nodes"]


def ellipsoid(x, scale=3.0):
    A = np.diag([1 / 36.0, 1 / 49.0, 1 / 9.0])
    s = np.sqrt(np.einsum("qi,ij,qj->q", x, A, x))
    Ax = x @ A
    H = scale * (A / s[:, None, None] - np.einsum("qi,qj->qij", Ax, Ax) / s[:, None, None] ** 3)
    return scale * (s - 1), scale * Ax / s[:, None], H


#: Tools whose surface touches the plate of the tests from below or lies around it.
TOOLS = {
    "plane": Plane((0.0, 0.0, 0.0), (0.2, -0.1, 1.0)),
    "cylinder": Cylinder((0.0, 0.0, -3.0), (0.3, 1.0, 0.1), 3.0),
    "bore": Cylinder((0.0, 0.0, 6.0), (0.3, 1.0, 0.1), 6.0, inside=True),
    "sphere": Sphere((0.0, 0.0, -3.0), 3.0),
    "bowl": Sphere((0.0, 0.0, 6.0), 6.0, inside=True),
    "ellipsoid": UserSurface(ellipsoid),
}


def plate(cell, build, amount=0.1):
    """A plate of 2 x 1.5 x 0.2 whose lower face is z = 0, with distorted cells."""
    return build.jittered(strip(2.0, 1.5, 0.2, (3, 2), cell=cell), amount).moved((0.0, 0.0, 0.1))


def contact_of(mesh, tool, points, penalty=50.0, cell="hex8", faces="lower"):
    model = Model(mesh, ELEMENT[cell], material=ELASTIC)
    return model, model.contact(faces, tool, penalty=penalty, points=points)


def middle_of_a_void(gaps):
    """A value near the median that is far from all gaps."""
    inner = np.sort(gaps)[int(0.35 * len(gaps)) : int(0.65 * len(gaps)) + 1]
    widest = np.diff(inner).argmax()
    return inner[widest : widest + 2].mean()


@pytest.mark.parametrize("name", TOOLS)
@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("points", [2, 3, 5, "nodes"])
def test_tangent_is_the_derivative_of_the_force(build, rng, name, cell, points):
    """With a tool that is turned and shifted, and a sheet that is partly in touch."""
    mesh = plate(cell, build)
    model, contact = contact_of(mesh, TOOLS[name], points, cell=cell)
    shift, turn = np.array([0.3, 0.2, 0.0]), np.array([0.1, -0.05, 2.0])
    model.set_motion(contact, lambda time: (shift, turn), about=(0.2, 0.1, 0.0))
    full = build.full_tangent(contact.block, len(mesh.points))
    u = 0.05 * rng.normal(size=full.size)
    for _ in range(2):  # move the tool until about half of the points penetrate
        shift[2] += middle_of_a_void(contact.locate(u, contact.pose).gap)
    found = contact.locate(u, contact.pose)
    _, K = full(u)
    assert 0.3 < found.active.mean() < 0.7
    assert np.abs(found.gap).min() > 1e-5  # away from the kink
    np.testing.assert_allclose(K, K.T, atol=1e-13 * np.abs(K).max())
    for _ in range(3):
        du = rng.normal(size=u.size)
        assert build.relative_error(K @ du, build.central_difference(full.force, u, du)) < 1e-7


@pytest.mark.parametrize("name", ["cylinder", "sphere", "bowl"])
def test_a_turned_and_shifted_tool_sees_a_turned_and_shifted_sheet(build, rng, name):
    mesh = plate("hex8", build)
    model, contact = contact_of(mesh, TOOLS[name], 3)
    u = 0.05 * rng.normal(size=(len(mesh.points), 3))
    still = model.evaluate(u.ravel()).found[contact]
    force = still.resultant()[0]
    rotation, centre, shift = Rotation.from_rotvec([0.5, 0.4, -1.2]), np.array([0.3, 0.0, 1.0]), (0.2, 0.5, -1)
    model.set_motion(contact, lambda time: (np.array(shift), rotation.as_rotvec()), about=centre)
    x = (mesh.points + u - centre) @ rotation.as_matrix().T + centre + shift
    moved = contact.locate((x - mesh.points).ravel(), contact.pose)
    np.testing.assert_allclose(moved.gap, still.gap, atol=1e-14)
    np.testing.assert_allclose(moved.normal, still.normal @ rotation.as_matrix().T, atol=1e-13)
    np.testing.assert_allclose(moved.resultant()[0], rotation.as_matrix() @ force, atol=1e-12)


# Uniform pressure -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("points", POINTS)
@pytest.mark.parametrize("face", ["lower", "upper"])
def test_a_flat_block_feels_penalty_times_penetration(build, cell, points, face):
    mesh = strip(2.0, 1.5, 0.2, (3, 2), cell=cell, grading=(2.0, 0.5))
    sign = 1.0 if face == "lower" else -1.0
    tool = Plane((0.0, 0.0, -0.1 * sign), (0.0, 0.0, sign))
    _, contact = contact_of(mesh, tool, points, penalty=50.0, cell=cell, faces=face)
    u = np.zeros((len(mesh.points), 3))
    u[:, 2] = -0.01 * sign
    full = build.full_tangent(contact.block, len(mesh.points))
    found = contact.locate(u.ravel(), contact.pose)
    f, _ = full(u.ravel())
    at = found.points()
    np.testing.assert_allclose(at.pressure, 0.5, rtol=1e-12)
    np.testing.assert_allclose(at.gap, -0.01, rtol=1e-12)
    assert at.area.sum() == pytest.approx(3.0, rel=1e-13)
    np.testing.assert_allclose(found.resultant()[0], [0.0, 0.0, -1.5 * sign], atol=1e-13)
    np.testing.assert_allclose(found.resultant()[1], [-1.5 * sign * 0.75, 1.5 * sign, 0.0], atol=1e-13)
    assert f.reshape(-1, 3).sum(axis=0) == pytest.approx(found.resultant()[0], abs=1e-13)
    if (cell, points) != ("hex18", 1):  # one point does not integrate the biquadratic functions of a face
        expected = -forces.traction_forces(mesh, face, (0.0, 0.0, 0.5 * sign))
        np.testing.assert_allclose(f, expected, atol=1e-13)


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("points", POINTS[1:])
def test_forces_of_uniform_pressure_are_consistent_on_distorted_faces(build, cell, points):
    mesh = plate(cell, build, amount=0.1 if cell == "hex8" else 0.04)
    _, contact = contact_of(mesh, Plane(), points, cell=cell)
    u = np.tile([0.0, 0.0, -0.02], len(mesh.points))
    f = build.full_tangent(contact.block, len(mesh.points)).force(u)
    degree = 2 if cell == "hex8" else 5  # of N_a times the area
    if points == "nodes" or 2 * points - 1 >= degree:
        np.testing.assert_allclose(f, -forces.traction_forces(mesh, "lower", (0, 0, 1.0)), atol=1e-14)
    assert f.sum() == pytest.approx(-3.0, rel=1e-13)


@pytest.mark.parametrize(("cell", "parts"), [("hex8", [1, 1, 1, 1]), ("hex18", [1, 1, 1, 1, 4, 4, 4, 4, 16])])
def test_nodal_rule_has_the_tributary_areas_of_the_shape_functions(cell, parts):
    mesh = strip(2.0, 1.5, 0.2, (1, 1), cell=cell)
    model, contact = contact_of(mesh, Plane(), "nodes", cell=cell)
    np.testing.assert_allclose(
        model.evaluate(model.u).found[contact].area, 3.0 * np.array(parts) / sum(parts), rtol=1e-13
    )


@pytest.mark.parametrize(
    ("cell", "points"),
    [(cell, points) for cell in ELEMENT for points in POINTS if (cell, points) != ("hex18", 1)],
)  # one point on a 9-node facet would hold its centre only
def test_under_a_uniform_traction_the_gap_is_pressure_over_penalty_everywhere(cell, points):
    """In equilibrium, not prescribed: a compressed block on a plane between sliding walls."""
    mesh = strip(2.0, 1.5, 0.5, (3, 2), cell=cell, grading=(1.5, 1.0)).moved((0.0, 0.0, 0.25))
    model, contact = contact_of(mesh, Plane((0.0, 0.0, 1e-3)), points, penalty=400.0, cell=cell)
    for face, normal in (("x0", "x"), ("x1", "x"), ("y0", "y"), ("y1", "y")):
        model.symmetry(face, normal=normal)
    load = model.traction("upper", (0.0, 0.0, -1.0))
    result = solve(model, Move(load, 8.0, steps=1), options=NewtonOptions(residual=1e-13), frames=0)
    at = contact.at_points()
    np.testing.assert_allclose(at.gap, -8.0 / 400.0, rtol=1e-10)
    np.testing.assert_allclose(at.pressure, 8.0, rtol=1e-10)
    assert result["tool1_fz"][-1] == pytest.approx(-8.0 * 3.0, rel=1e-10)
    assert result["tool1_penetration"][-1] == pytest.approx(0.02, rel=1e-10)
    assert result["tool1_active"][-1] == len(at.gap)
    on_faces = mesh.nodes("lower")
    pressure = fields.contact_pressure(model)
    np.testing.assert_allclose(pressure[on_faces], 8.0, rtol=1e-10)
    assert (np.delete(pressure, on_faces) == 0).all()


def standing(gap, element, points):
    """A block of thickness 0.5 between two planes of symmetry that a tool below it alone holds, a gap apart."""
    mesh = strip(2.0, 1.5, 0.5, (3, 2), cell="hex18" if "9K" in element else "hex8").moved((0.0, 0.0, 0.25))
    model = Model(mesh, element, material=ELASTIC)
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    contact = model.contact("lower", Plane((0.0, 0.0, -gap)), penalty=400.0, points=points)
    return model, contact, model.traction("upper", (0.0, 0.0, -1.0))


STANDING = [("ANS3DEAS", 2), ("ANS3DEAS", "nodes"), ("MI9K3DEAS", 3), ("MI9K3DEAS", "nodes")]


@pytest.mark.parametrize(("element", "points"), STANDING)
def test_a_tool_that_just_touches_holds_a_load_driven_block(element, points):
    model, contact, load = standing(0.0, element, points)
    found = model.evaluate(model.u).found[contact]
    assert (found.gap == 0.0).all()
    assert found.active.all()
    solve(model, Move(load, 8.0, steps=2), options=NewtonOptions(residual=1e-13), frames=0)
    np.testing.assert_allclose(contact.at_points().gap, -8.0 / 400.0, rtol=1e-10)
    np.testing.assert_allclose(contact.resultant()[0], [0.0, 0.0, -24.0], atol=1e-9)


@pytest.mark.parametrize(("element", "points"), STANDING)
def test_a_tool_a_hair_away_holds_nothing(element, points):
    model, _, load = standing(1e-9 * 0.5, element, points)
    with pytest.raises(RigidBodyMotion) as caught:
        solve(model, Move(load, 8.0, steps=2), frames=0)
    assert caught.value.value == "free: translation z"
    standing(-1e-9 * 0.5, element, points)[0].system.check()


# Resultants -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("element", "points"), [("ANS3DEAS", 2), ("ANS3DEAS", "nodes"), ("MI9K3DEAS", 3)])
def test_resultant_is_the_reaction_and_the_moment_is_in_balance(build, element, points):
    case = build.free_bending((8, 1), element, points)
    model = case.model
    result = solve(model, Move(case.punch, -1.0, steps=4), options=NewtonOptions(residual=1e-12), frames=0)
    residual = model.evaluate(model.u).residual.reshape(-1, 3)
    fixed = np.setdiff1d(np.arange(model.u.size), model.system.free)
    reaction = np.zeros(model.u.size)
    reaction[fixed] = residual.ravel()[fixed]
    reaction = reaction.reshape(-1, 3)
    force, moment = case.contact.resultant()
    scale = np.linalg.norm(force)
    assert scale > 1.0
    np.testing.assert_allclose(reaction.sum(axis=0), force, atol=1e-8 * scale)
    x = model.positions
    np.testing.assert_allclose(np.cross(x, reaction).sum(axis=0), moment, atol=1e-8 * np.abs(moment).max())
    assert result["punch_force"][-1] == pytest.approx(result["tool_fz"][-1], rel=1e-8)
    assert [result[f"tool_{c}"][-1] for c in ("mx", "my", "mz")] == pytest.approx(list(moment), rel=1e-9)


def test_moment_about_another_point_is_shifted_by_the_force(build):
    mesh = plate("hex8", build)
    model, contact = contact_of(mesh, TOOLS["sphere"], 3)
    found = model.evaluate(np.tile([0.0, 0.0, -0.05], len(mesh.points))).found[contact]
    force, moment = found.resultant()
    about = np.array([3.0, -1.0, 2.0])
    np.testing.assert_allclose(found.resultant(about)[1], moment - np.cross(about, force), atol=1e-13)


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("points", [2, 3, 5, "nodes"])
def test_nodes_do_not_pull_and_carry_what_the_points_carry(build, cell, points):
    """Beside the edge of a contact that covers a part of a face, where a 9-node shape function is negative."""
    mesh = plate(cell, build, amount=0.05)
    model, contact = contact_of(mesh, Sphere((0.2, 0.1, -1.0), 1.0), points, cell=cell)
    u = np.tile([0.0, 0.0, -0.1], len(mesh.points))
    at = model.evaluate(u).found[contact]
    pressure, _ = contact.found_at_nodes(at, u, mesh)
    assert 0 < at.active.sum() < at.active.size
    assert pressure.min() == 0.0
    assert pressure.max() <= at.pressure.max()
    hats = hat_functions(contact.block.shape_values)[0]
    np.testing.assert_allclose(hats.sum(axis=1), 1.0, atol=1e-14)
    areas = np.zeros(len(mesh.points))
    np.add.at(areas, contact.facets, np.einsum("qa,eq->ea", hats, at.area.reshape(len(contact.facets), -1)))
    assert pressure @ areas == pytest.approx(at.pressure @ at.area, rel=1e-12)


def test_hats_of_a_9_node_face_are_bilinear_between_its_nodes():
    N = _core.shell_functions(18, np.array([[-0.5, 0.25, -1.0], [1.0, -1.0, -1.0], [0.0, 0.0, -1.0]]))[0][:, :9]
    quarter = np.zeros(9)
    quarter[[3, 6, 7, 8]] = 0.125, 0.125, 0.375, 0.375  # (-1, 1), (0, 1), (-1, 0) and the centre around (-0.5, 0.25)
    np.testing.assert_allclose(hat_functions(N), [quarter, np.eye(9)[1], np.eye(9)[8]], atol=1e-14)


def test_a_driven_tool_feels_the_force_along_its_way(build):
    """Pushing the tool up is the same as pushing the sheet down."""

    def run(move_tool):
        case = build.free_bending((8, 1))
        control = case.model.drive(case.contact, "z", "ram") if move_tool else case.punch
        result = solve(case.model, Move(control, 1.0 if move_tool else -1.0, steps=4), frames=0)
        return result, case

    tool, sheet = run(True), run(False)
    np.testing.assert_allclose(tool[0]["ram_force"], -tool[0]["tool_fz"], atol=1e-12)
    assert tool[0]["ram_force"][-1] == pytest.approx(-sheet[0]["tool_fz"][-1], rel=1e-7)
    u_tool, u_sheet = (case.model.u.reshape(-1, 3) for _, case in (tool, sheet))
    np.testing.assert_allclose(u_tool - (0, 0, 1.0), u_sheet, atol=1e-6)


def test_a_motion_in_time_equals_a_driven_tool(build):
    def run(motion):
        case = build.free_bending((8, 1))
        if motion:
            case.model.set_motion(case.contact, lambda time: np.array([0.0, 0.0, 0.5 * time]))
            step = Move(case.punch, 0.0, steps=4)
        else:
            step = Move(case.model.drive(case.contact, "z"), 0.5, steps=4)
        solve(case.model, step, frames=0)
        return case.model.u

    np.testing.assert_allclose(run(True), run(False), atol=1e-7)


def test_tools_that_follow_several_controls_add_their_ways(build):
    case = build.free_bending((8, 1))
    up, along = case.model.drive(case.contact, "z"), case.model.drive(case.contact, (3.0, 0.0, 4.0))
    case.contact.locate(case.model.u, case.contact.pose)
    up.value, along.value = 0.5, 2.0
    found = case.contact.locate(case.model.u, case.contact.pose)
    x = found.x
    expected = np.hypot(x[:, 0] - 25 - 1.2, x[:, 2] + 20.5 - 0.5 - 1.6) - 20
    np.testing.assert_allclose(found.gap, expected, atol=1e-13)


# Refusals ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("penalty", [0.0, -1.0, math.nan, math.inf])
def test_a_penalty_must_be_positive(build, penalty):
    with pytest.raises(InvalidValue, match="penalty"):
        contact_of(plate("hex8", build), Plane(), 2, penalty=penalty)


@pytest.mark.parametrize("points", [0, 11, -2, 2.5, "gauss"])
def test_contact_points_out_of_range_are_refused(build, points):
    with pytest.raises(InvalidValue, match="1 to 10"):
        contact_of(plate("hex8", build), Plane(), points)


@pytest.mark.parametrize("points", [np.int64(3), np.int32(3)])
def test_contact_points_may_be_an_integer_of_numpy(build, points):
    _, contact = contact_of(plate("hex8", build), Plane(), points)
    assert type(contact.points) is int
    assert contact.points == 3
    assert contact.block.gaps.size == 9 * len(contact.facets)


def test_a_tool_must_be_a_surface_and_a_name_is_given_once(build):
    mesh = plate("hex8", build)
    with pytest.raises(InvalidValue, match="must be a surface"):
        contact_of(mesh, lambda x: x, 2)
    model = Model(mesh, material=ELASTIC)
    model.contact("lower", Plane(), penalty=1.0, name="die")
    with pytest.raises(InvalidValue, match="same name"):
        model.contact("upper", Plane((0, 0, 9), "-z"), penalty=1.0, name="die")


def test_lateral_faces_cannot_touch_a_tool(build):
    with pytest.raises(InvalidValue, match="lower and upper"):
        contact_of(plate("hex8", build), Plane(), 2, faces="x0")


@pytest.mark.parametrize(
    ("answer", "error", "message"),
    [
        (np.zeros(2), InvalidValue, "three components"),
        ((0.0, 0.0), InvalidValue, "three components"),
        (np.zeros((3, 1)), InvalidValue, "three components"),
        (0.0, InvalidValue, "three components"),
        ((np.zeros(2), np.zeros(3)), InvalidValue, "three components"),
        ((np.zeros(3), np.zeros(2)), InvalidValue, "three components"),
        ((np.zeros(3), np.zeros(3), np.zeros(3)), InvalidValue, "three components"),
        (np.array([0.0, math.nan, 0.0]), NotFinite, "must be finite"),
        ((np.array([0.0, math.inf, 0.0]), np.zeros(3)), NotFinite, "must be finite"),
        ((np.zeros(3), np.array([0.0, 0.0, math.nan])), NotFinite, "must be finite"),
    ],
)
def test_a_motion_must_be_three_finite_numbers_or_two_times_three(build, answer, error, message):
    model, contact = contact_of(plate("hex8", build), Plane(), 2)
    model.set_motion(contact, lambda time: answer)
    model.system.time = 0.5
    with pytest.raises(error, match=message) as caught:
        model.evaluate(model.u)
    assert type(caught.value) is error
    assert caught.value.where == "motion of tool tool1 at time 0.5"


@pytest.mark.parametrize(
    "answer",
    [
        np.array([0.0, 0.0, -0.25]),
        (0.0, 0.0, -0.25),
        [0, 0, -0.25],
        (np.array([0.0, 0.0, -0.25]), np.zeros(3)),
        ((0.0, 0.0, -0.25), (0.0, 0.0, 2.0)),
        (np.array([0.0, 0.0, 0.25]), np.array([math.pi, 0.0, 0.0])),
    ],
)
def test_a_motion_is_a_translation_with_or_without_a_rotation_vector(build, answer):
    """The last one turns the plane upside down and its normal with it."""
    model, contact = contact_of(plate("hex8", build), Plane(), 2)
    model.set_motion(contact, lambda time: answer)
    np.testing.assert_allclose(model.evaluate(model.u).found[contact].gap, 0.25, atol=1e-15)


def pushed_on(build, function):
    """A block that is pushed on a tool given as a function: model and step."""
    mesh = plate("hex8", build)
    model, _ = contact_of(mesh, UserSurface(function, "mine"), 2)
    for face, normal in (("x0", "x"), ("y0", "y")):
        model.symmetry(face, normal=normal)
    return model, Move(model.prescribe("upper", "z"), -0.01, steps=2)


def flat(x):
    return x[:, 2].copy(), np.tile([0.0, 0.0, 1.0], (len(x), 1)), np.zeros((len(x), 3, 3))


def test_a_plane_of_the_user_works_as_the_plane_of_the_house(build):
    model, step = pushed_on(build, flat)
    solve(model, step, frames=0)
    contact = model.contacts[0]
    other, again = pushed_on(build, flat)
    other.contacts[0].block = contact_of(other.mesh, Plane(), 2)[1].block
    solve(other, again, frames=0)
    np.testing.assert_allclose(model.u, other.u, atol=1e-14)
    assert contact.active().all()


def test_wrong_shapes_are_refused_before_the_first_step(build):
    model, step = pushed_on(build, lambda x: (flat(x)[0][:, None], *flat(x)[1:]))
    with pytest.raises(InvalidValue, match="must have shape"):
        solve(model, step, frames=0)


def test_nan_is_refused_before_the_first_step(build):
    model, step = pushed_on(build, lambda x: (np.full(len(x), math.nan), *flat(x)[1:]))
    with pytest.raises(NotFinite, match="not finite"):
        solve(model, step, frames=0)


def test_nan_in_the_middle_of_a_run_cuts_the_step_and_ends_with_its_cause(build):
    def function(x):
        g, n, H = flat(x)
        return np.where(g < -0.004, math.nan, g), n, H

    model, step = pushed_on(build, function)
    with pytest.raises(NoConvergence) as caught:
        solve(model, step, frames=0)
    assert "not finite" in caught.value.cause
    assert np.isfinite(model.u).all()
    assert np.isfinite(model.evaluate(model.u).residual).all()


@pytest.mark.parametrize("error", [RuntimeError("broken tool", 7), KeyError("die"), InvalidValue("bad die", value=3)])
def test_an_error_of_the_users_function_arrives_intact_and_the_model_stays_where_it_was(build, error):
    calls, begun = [], []

    def function(x):
        calls.append(len(x))
        if begun and len(calls) > 6:
            raise error
        return flat(x)

    model, step = pushed_on(build, function)
    calls.clear()  # those of the check of the tool
    begun.append(True)
    with pytest.raises(type(error)) as caught:
        solve(model, step, frames=0)
    assert caught.value is error
    assert len(calls) == 7
    assert step.control.value in (0.0, -0.005)
    assert model.system.time in (0.0, 0.5)
    np.testing.assert_allclose(model.u[step.control.dofs], step.control.value, atol=1e-15)


def test_a_result_of_interrupted_evaluation_is_not_kept(build):
    """After an error of the function the enhanced parameters are those of the converged state."""
    fail = []

    def function(x):
        if fail:
            raise RuntimeError("stop")
        return flat(x)

    model, step = pushed_on(build, function)
    solve(model, step, frames=0)
    clean = model.evaluate(model.u).residual
    again = Move(step.control, -0.02, steps=1)
    fail.append(True)
    with pytest.raises(RuntimeError, match="stop"):
        solve(model, again, frames=0)
    fail.clear()
    np.testing.assert_array_equal(model.evaluate(model.u).residual, clean)
