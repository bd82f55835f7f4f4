"""Friction: return to the bound, exact tangent, history in the frame of the tool, energies, laws, and bad input."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import umform as uf
from umform import materials as mt
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidFriction, InvalidValue, NoConvergence
from umform.mesh import strip
from umform.model import Model
from umform.model.contact.face_basis import in_face_basis
from umform.model.contact.friction import friction_kernel
from umform.surfaces import Arc, Cylinder, Extruded, Line, Plane, Profile, Sphere, Torus, Triangulated, UserSurface

ELASTIC = mt.NeoHooke(E=1000.0, nu=0.3)
ELEMENT = {"hex8": "ANS3DEAS", "hex18": "MI9K3DEAS"}
#: Of central differences: their error falls with its square, and with stiff places it is the larger part of the whole.
STEP = 2.5e-7
#: One law of each kind; the tests of the tangent go through all of them.
LAWS = {
    "constant": 0.3,
    "decaying": uf.Friction(0.4, kinetic=0.2, decay=0.02),
    "capped": uf.Friction(0.4, cap=0.4),
    "table": uf.Friction([(0.0, 0.1), (2.0, 0.4), (5.0, 0.2)]),
    "region": uf.FrictionByRegion(0.1, [uf.Region((-10, -10, -10), (1, 10, 10), 0.4)]),
    "function": lambda pressure, slip, z: 0.3 * pressure / (1.0 + 0.2 * pressure) * math.exp(-slip),
}


def egg(x):
    """An ellipsoid below the plate as a function of the user."""
    x = x + np.array([0.0, 0.0, 3.0])
    A = np.diag([1 / 36.0, 1 / 49.0, 1 / 9.0])
    s = np.sqrt(np.einsum("qi,ij,qj->q", x, A, x))
    Ax = x @ A
    H = 3.0 * (A / s[:, None, None] - np.einsum("qi,qj->qij", Ax, Ax) / s[:, None, None] ** 3)
    return 3.0 * (s - 1), 3.0 * Ax / s[:, None], H


def rim():
    """A flank, an arc of radius 1 and a plane top, whose joints lie below the plate."""
    corner = [Line((1.8, -5.0), (1.8, -1.0)), Arc((1.8, -1.0), (0.8, 0.0), (0.8, -1.0)), Line((0.8, 0.0), (-5.0, 0.0))]
    return Profile(corner, closed=False)


TOOLS = {
    "plane": Plane((0.0, 0.0, 0.0), (0.2, -0.1, 1.0)),
    "cylinder": Cylinder((0.0, 0.0, -3.0), (0.3, 1.0, 0.1), 3.0),
    "rim": Extruded(rim()),
    "sphere": Sphere((0.0, 0.0, -3.0), 3.0),
    "bowl": Sphere((0.0, 0.0, 6.0), 6.0, inside=True),
    "torus": Torus((0.0, 0.0, -1.0), (0.0, 0.0, 1.0), 2.0, 1.0),
    "user": UserSurface(egg),
    "triangles": Triangulated(Sphere((0.0, 0.0, -3.0), 3.0).triangles(((-4, -4, -7), (4, 4, 1)), 0.05)),
}


def rubbing_plate(build, rng, tool, cell="hex8", points=3, friction=0.3, slip=0.01):
    """A plate that touches a tool in part, after an increment in which it touched it in another part."""
    mesh = build.jittered(strip(2.0, 1.5, 0.2, (3, 2), cell=cell), 0.1).moved((0.0, 0.0, 0.1))
    model = Model(mesh, ELEMENT[cell], material=ELASTIC)
    contact = model.contact("lower", tool, penalty=50.0, points=points, friction=friction, slip=slip)
    shift, turn = np.array([0.3, 0.2, 0.0]), np.array([0.1, -0.05, 2.0])
    model.set_motion(contact, lambda time: (shift, turn), about=(0.2, 0.1, 0.0))
    full = build.full_tangent(contact.block, len(mesh.points))
    u = 0.02 * rng.normal(size=full.size)

    def touch(u):
        for _ in range(2):
            gaps = np.sort(contact.locate(u, contact.pose).gap)
            inner = gaps[int(0.35 * len(gaps)) : int(0.65 * len(gaps)) + 1]
            widest = np.diff(inner).argmax()
            shift[2] += inner[widest : widest + 2].mean()
        contact.locate(u, contact.pose)

    touch(u)
    contact.block.begin()
    for way in (0.0, 0.004):  # the second time tractions along the tool are there
        u = u + np.tile([way, -way, 0.0], len(mesh.points))
        full(u)
        contact.block.commit()
    u = u + 0.02 * rng.normal(size=u.size) + np.tile([0.01, 0.006, 0.0], len(mesh.points))
    turn[:] += (0.01, 0.02, -0.03)
    touch(u)
    return contact, full, u


# The tangent -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", TOOLS)
@pytest.mark.parametrize(("cell", "points"), [("hex8", 3), ("hex8", "nodes"), ("hex18", 4)])
@pytest.mark.parametrize("slip", [0.5, 0.002])
def test_tangent_is_the_derivative_of_the_force(build, rng, name, cell, points, slip):
    """On all kinds of tools, which move and turn; the sheet touches in the increment, lets go, sticks and slips."""
    contact, full, u = rubbing_plate(build, rng, TOOLS[name], cell, points, slip=slip)
    _, K = full(u)
    found = contact.block.found()
    counts = np.bincount(found.active, minlength=3)
    assert counts[0] > 0 and counts[1 if slip == 0.5 else 2] > 0
    if slip == 0.002:
        assert np.abs(K - K.T).max() > 1e-3 * np.abs(K).max()
    for _ in range(3):
        du = rng.normal(size=u.size)
        difference = (full.force(u + STEP * du) - full.force(u - STEP * du)) / (2 * STEP)
        assert build.relative_error(K @ du, difference) < 2e-7


@pytest.mark.parametrize("law", LAWS)
def test_tangent_of_each_law(build, rng, law):
    contact, full, u = rubbing_plate(build, rng, TOOLS["bowl"], friction=LAWS[law], slip=0.002)
    _, K = full(u)
    assert (contact.block.found().active == 2).any()
    for _ in range(3):
        du = rng.normal(size=u.size)
        difference = (full.force(u + STEP * du) - full.force(u - STEP * du)) / (2 * STEP)
        assert build.relative_error(K @ du, difference) < 5e-7


@pytest.mark.parametrize("name", TOOLS)
def test_tractions_lie_in_the_tool_and_within_the_bound_to_round_off(build, rng, name):
    contact, full, u = rubbing_plate(build, rng, TOOLS[name], slip=0.002)
    full(u)
    found = contact.block.found()
    tangential = found.traction - found.pressure[:, None] * found.normal
    size = np.linalg.norm(tangential, axis=1)
    normal = found.pressure * np.linalg.norm(found.normal, axis=1)  # of a function that is no distance
    assert np.abs((tangential * found.normal).sum(axis=1)).max() < 1e-14 * normal.max()
    assert (size <= 0.3 * normal * (1 + 1e-13)).all()
    slips = found.active[found.points] == 2
    assert slips.any()
    np.testing.assert_allclose(size[slips], 0.3 * normal[slips], rtol=1e-13)


def test_evaluate_changes_no_history_and_gives_the_same_twice(build, rng):
    contact, full, u = rubbing_plate(build, rng, TOOLS["bowl"])
    before = contact.block.state
    first = full.force(u)
    full.force(u + 0.01 * rng.normal(size=u.size))
    np.testing.assert_array_equal(full.force(u), first)
    np.testing.assert_array_equal(contact.block.state, before)


@pytest.mark.parametrize("name", ["plane", "cylinder", "sphere", "bowl"])
def test_a_sheet_and_a_tool_that_move_together_feel_no_friction(build, rng, name):
    """The history lives in the frame of the tool: tractions turn with both."""
    mesh = strip(2.0, 1.5, 0.2, (3, 2)).moved((0.0, 0.0, 0.1))
    model = Model(mesh, material=ELASTIC)
    contact = model.contact("lower", TOOLS[name], penalty=50.0, points=3, friction=0.3, slip=0.01)
    shift, turn = np.zeros(3), np.zeros(3)
    model.set_motion(contact, lambda time: (shift, turn))
    full = build.full_tangent(contact.block, len(mesh.points))
    u = 0.03 * rng.normal(size=(len(mesh.points), 3)) - (0.0, 0.0, 0.1)
    contact.locate(0 * u.ravel(), contact.pose)
    contact.block.begin()
    full(u.ravel())
    contact.block.commit()
    before = contact.block.found()
    shift[:], turn[:] = (0.4, -0.2, 0.1), (0.2, 0.5, -0.3)
    Q = Rotation.from_rotvec(turn).as_matrix()
    moved = (mesh.points + u) @ Q.T + shift - mesh.points
    contact.locate(moved.ravel(), contact.pose)
    full(moved.ravel())
    after = contact.block.found()
    assert before.points.size > 3
    np.testing.assert_allclose(after.traction, before.traction @ Q.T, atol=1e-12)
    np.testing.assert_allclose(after.elastic_slip, before.elastic_slip @ Q.T, atol=1e-14)


# A block on a table ------------------------------------------------------------------------------------------


def block(friction=0.2, nu=0.0, **settings):
    """A block on a table, whose upper face is held by controls; without a lateral strain the pressure is uniform."""
    model = Model(strip(4.0, 3.0, 1.0, (3, 2)), material=mt.SVK(E=1000.0, nu=nu))
    ways = {axis: model.prescribe("upper", axis, f"way_{axis}") for axis in "xyz"}
    settings = {"penalty": 1000.0, "slip": 0.01} | settings
    model.contact("lower", Plane((0, 0, -0.5)), friction=friction, name="table", **settings)
    return model, ways


def test_a_block_sticks_slips_and_turns_back():
    """The force grows with the elastic slip up to mu N, falls on the way back, and comes to - mu N."""
    model, ways = block()
    steps = [Move(ways["z"], -0.01, steps=2), Move(ways["x"], 0.2, steps=8), Move(ways["x"], -0.1, steps=8)]
    result = solve(model, steps)
    fx, fz = result["table_fx"], result["table_fz"]
    assert abs(fx[2]) < 1e-9 * abs(fz[2])
    assert fx[10] == pytest.approx(-0.2 * fz[10], rel=1e-3)  # of the sheet on the tool: along its way
    assert fx[-1] == pytest.approx(0.2 * fz[-1], rel=1e-3)
    assert -0.2 * -fz[11] < fx[11] < -0.2 * fz[11]
    assert result["table_slipping"][2] == 0 and result["table_slipping"][-1] == result["table_active"][-1]
    assert result["iterations"].max() < 9
    for records in result.iterations[3:]:
        assert records[-1].residual < max(1e3 * records[-2].residual ** 1.7, 1e-10)


def test_friction_does_not_depend_on_the_direction():
    forces = []
    for angle in (0.0, 0.7, 2.5):
        model, ways = block()
        x, y = 0.2 * math.cos(angle), 0.2 * math.sin(angle)
        result = solve(model, [Move(ways["z"], -0.01, steps=1), Move([ways["x"], ways["y"]], [x, y], steps=5)])
        force = np.array([result["table_fx"][-1], result["table_fy"][-1]])
        np.testing.assert_allclose(force / np.linalg.norm(force), [x / 0.2, y / 0.2], atol=2e-3)
        forces.append(np.linalg.norm(force))
    np.testing.assert_allclose(forces, forces[0], rtol=1e-3)


def test_increments_at_rest_move_nothing():
    model, ways = block()
    steps = [Move(ways["z"], -0.01, steps=1), Move(ways["x"], 0.004, steps=2), Move(ways["x"], 0.004, steps=50)]
    result = solve(model, steps)
    assert 0.0 < result["table_fx"][3] < 0.2 * -result["table_fz"][3]
    np.testing.assert_allclose(result["table_fx"][3:], result["table_fx"][3], rtol=1e-12)
    np.testing.assert_allclose(result["table_friction_work"][3:], result["table_friction_work"][3], atol=1e-15)


def test_a_sheet_that_is_pressed_on_at_once_is_not_pulled_sideways():
    """First touch: it slides from where it touched, not from where it came."""
    pulls = []
    for gap in (0.0, 0.3):
        model = Model(strip(4.0, 3.0, 1.0, (3, 2)), material=mt.SVK(E=1e6, nu=0.0))  # all but rigid
        x, z = (model.prescribe("upper", axis, axis) for axis in "xz")
        model.fix("upper", "y")
        model.contact("lower", Plane((0, 0, -0.5 - gap)), penalty=1000.0, friction=0.2, slip=10.0, name="table")
        way = 0.003  # of sliding while it presses: all that friction may feel, with a stiffness that never slips
        total = gap + 0.01
        solve(model, Move([x, z], [way * total / 0.01, -total], steps=1))
        pulls.append(model.contacts[0].resultant()[0][0])
    assert pulls[0] > 0.0
    assert pulls[1] == pytest.approx(pulls[0], rel=1e-2)


def test_the_work_of_friction_closes_the_balance():
    """With the square of the increments; what is dissipated never falls."""
    drifts = []
    for steps in (10, 20, 40):
        model, ways = block(nu=0.3)
        result = solve(
            model,
            [
                Move(ways["z"], -0.02, steps=steps // 2),
                Move(ways["x"], 0.1, steps=steps),
                Move(ways["x"], 0.0, steps=steps),
            ],
            options=NewtonOptions(residual=1e-11),
        )
        work = result["friction_work"]
        assert (np.diff(work) > -1e-6 * work[-1]).all()
        assert work[-1] > 0.2 * abs(result["external_work"][-1])
        drifts.append(np.abs(result.balance().drift).max())
    assert drifts[2] < 0.1 * drifts[0]
    assert drifts[2] < 1e-4


@pytest.mark.parametrize("rule", [{"points": 2}, {"points": "nodes"}, {"cells": 3}, {"augmented": True, "slip": 1e-4}])
def test_the_work_of_friction_is_exact_in_few_increments(rule):
    """Of a block drawn to and fro under a constant force, wherever in an increment it begins to slip."""
    for steps in (3, 10):
        model, ways = block(**rule)
        moves = [Move(ways["z"], -0.01, steps=1), Move(ways["z"], -0.01, steps=20)]
        moves += [Move(ways["x"], to, steps=steps) for to in (0.2, 0.05)]
        result = solve(model, moves, frames=0)
        normal = -result["table_fz"][-1]
        there, back = result["table_elastic_slip"][[21 + steps, -1]]  # of the ends of both ways
        shear = 0.2 * normal / 12.0 / (1000.0 / 2.0)  # of the block: the upper face goes that much farther at first
        slid = 0.2 - there - shear + 0.15 - there - back - 2.0 * shear
        np.testing.assert_allclose(-result["table_fz"][21:], normal, rtol=2e-3)
        assert result["friction_work"][-1] == pytest.approx(0.2 * normal * slid, rel=2e-3)
        drift = result.balance().drift
        assert np.abs(drift[21:] - drift[21]).max() < 3e-3  # multipliers do a work before


@pytest.mark.parametrize("rule", [{"points": 2}, {"points": "nodes"}, {"cells": 3}])
def test_the_work_of_points_that_leave_the_tool_and_touch_it_closes_the_balance(rule):
    """A block is drawn off the edge of a table and back, or the table below it, straight or about an axis."""
    works = []
    for mover in ("block", "table", "turning table"):
        model = Model(strip(4.0, 1.0, 1.0, (8, 1)), material=mt.SVK(E=1e4, nu=0.0))
        everything = np.arange(len(model.mesh.points))
        way = model.prescribe(everything, "x", "way")
        model.fix(everything, "y")
        press = model.prescribe("upper", "z", "press")
        table = model.tool("table", uf.Box((-4.0, 0.0, -2.5), (12.0, 20.0, 4.0), radius=0.5))
        model.contact("lower", table, penalty=1e4, friction=0.3, slip=1e-4, name="table", **rule)
        if mover == "table":
            way = model.drive(table, "-x")
        if mover == "turning table":
            way = model.turn(table, "z", about=(0.0, -8.0, 0.0))
        far = 0.3 if mover == "turning table" else 3.0
        steps = [Move(press, -1e-3, steps=1), Move(way, far, steps=20), Move(way, 0.3 * far, steps=20)]
        result = solve(model, steps, frames=0)
        assert result["table_active"][1] > 2 and result["table_active"][21] == 0 and result["table_active"][-1] > 2
        assert np.abs(result.balance().drift).max() < 0.01
        works.append(result["friction_work"][-1])
    assert works[1] == pytest.approx(works[0], rel=1e-9)
    assert works[2] == pytest.approx(works[0], rel=0.1)  # another way: 8 to 9 % more in short increments


def test_multipliers_take_the_elastic_slip_and_the_creep_away():
    model, ways = block(augmented=True, penetration=1e-5, slip=1e-5, penalty=1000.0)
    result = solve(model, [Move(ways["z"], -0.01, steps=2), Move(ways["x"], 0.0015, steps=30)])
    found = model.contacts[0].found
    assert not found.slipping.any()
    assert np.linalg.norm(found.elastic_slip, axis=1).max() <= 1e-5
    stiff, ways = block(slip=1e-7, penalty=1e6)
    other = solve(stiff, [Move(ways["z"], -0.01, steps=2), Move(ways["x"], 0.0015, steps=30)])
    assert result["table_fx"][-1] == pytest.approx(other["table_fx"][-1], rel=0.02)


def test_multipliers_in_the_basis_of_the_face_leave_no_penetration_that_it_could_take_away():
    """With 36 points a face on a sphere the fit of the gaps is closed, and what is left is the shape of the face."""
    mesh, forces = strip(4.0, 4.0, 1.0, (4, 4)), {}
    for points in (2, 6):
        model = Model(mesh, material=mt.SVK(E=1000.0, nu=0.3))
        way = model.prescribe("upper", "z", "way")
        model.fix("upper", "x")
        model.fix("upper", "y")
        settings = {"penalty": 2e4, "penetration": 1e-4, "augmented": True, "friction": 0.2, "slip": 1e-4}
        contact = model.contact("lower", Sphere((2.0, 2.0, -10.5), 10.0), points=points, name="ball", **settings)
        result = solve(model, Move(way, -0.1, steps=4))
        assert not contact.loose(contact.found)
        assert result["ball_penetration"][-1] <= 1e-4
        assert (contact.found.penetration > 2e-3) == (points == 6)
        forces[points] = result["ball_fz"][-1]
    assert forces[6] == pytest.approx(forces[2], rel=0.1)


def test_the_fit_of_a_face_is_a_least_squares_fit_over_held_points(rng):
    mesh = strip(2.0, 1.0, 0.2, (2, 1))
    contact = Model(mesh, material=ELASTIC).contact("lower", Plane((0, 0, -0.1)), points=4)
    N, area = contact.block.shape_values, contact.block.areas
    held = rng.random(area.size) < 0.7
    nodal = rng.normal(size=4)
    exact = np.tile(N[0] @ nodal, 2)
    np.testing.assert_allclose(in_face_basis(exact, held, area, N), np.where(held, exact, 0.0), atol=1e-12)
    values = rng.normal(size=(area.size, 3))
    fit = in_face_basis(values, held, area, N)
    rest = (np.where(held[:, None], values, 0.0) - fit) * area[:, None]
    np.testing.assert_allclose(np.einsum("qa,eqk->eak", N[0], rest.reshape(2, 16, 3)), 0.0, atol=1e-12)


@pytest.mark.parametrize("steps", [1, 4])
@pytest.mark.parametrize("down", [-0.01, -0.1])
def test_no_place_goes_farther_than_the_allowed_elastic_slip_before_it_slips(down, steps):
    """Whatever the pressure, and in however many increments it comes."""
    allowed = 1e-3
    model, ways = block(slip=allowed)
    solve(model, Move(ways["z"], down, steps=steps))
    lower = model.mesh.nodes("lower")
    while True:
        before = np.abs(model.u.reshape(-1, 3)[lower, 0]).max()
        result = solve(model, Move(ways["x"], ways["x"].value - 0.05 * down, steps=1))
        assert result["table_elastic_slip"][-1] <= allowed * (1.0 + 1e-12)
        if result["table_slipping"][-1] > 0:
            break
        assert before <= allowed
    assert before > 0.3 * allowed


# Laws and bad input ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", LAWS)
def test_bounds_are_what_the_law_says_and_have_right_derivatives(law):
    kernel = friction_kernel(LAWS[law])
    for pressure, slip in ((0.7, 0.01), (1.3, 0.0), (3.0, 0.5), (9.0, 0.03)):
        value, by_pressure, by_slip = kernel.bound(pressure, slip, (0.5, 0.0, 0.0))
        d = 1e-6

        def at(p, s, kernel=kernel):
            return kernel.bound(p, s, (0.5, 0.0, 0.0))[0]

        assert by_pressure == pytest.approx((at(pressure + d, slip) - at(pressure - d, slip)) / (2 * d), abs=1e-6)
        assert by_slip == pytest.approx((at(pressure, slip + d) - at(pressure, slip)) / d, rel=1e-4, abs=1e-6)
        assert value >= 0.0


def test_values_of_laws():
    assert uf.Friction(0.2).bound(5.0) == pytest.approx(1.0)
    assert uf.Friction(0.2, cap=0.7).bound(5.0) == pytest.approx(0.7)
    assert uf.Friction(0.2, kinetic=0.1, decay=2.0).bound(5.0, 2.0) == pytest.approx(5.0 * (0.1 + 0.1 / math.e))
    assert uf.Friction([(1.0, 0.1), (3.0, 0.3)]).bound(2.0) == pytest.approx(0.4)
    assert uf.Friction([(1.0, 0.1), (3.0, 0.3)]).bound(9.0) == pytest.approx(2.7)
    by_region = friction_kernel(LAWS["region"])
    assert by_region.bound(1.0, 0.0, (0.5, 0, 0))[0] == pytest.approx(0.4)
    assert by_region.bound(1.0, 0.0, (1.5, 0, 0))[0] == pytest.approx(0.1)


@pytest.mark.parametrize(
    "wrong",
    [
        -0.1,
        2.5,
        math.nan,
        "smooth",
        [],
        [(0.0, 0.1), (0.0, 0.2)],
        [(3.0, 0.1), (1.0, 0.2)],
    ],
)
def test_coefficients_that_make_no_sense_are_refused(wrong):
    model = Model(strip(4.0, 3.0, 1.0, (3, 2)), material=ELASTIC)
    with pytest.raises(InvalidFriction):
        model.contact("lower", Plane((0, 0, -0.5)), friction=wrong)
    assert not model.contacts and not model.tools


@pytest.mark.parametrize("keys", [{"kinetic": 0.1}, {"decay": 1.0}, {"kinetic": 0.1, "decay": -1.0}, {"cap": 0.0}])
def test_laws_that_make_no_sense_are_refused(keys):
    with pytest.raises(InvalidFriction):
        uf.Friction(0.2, **keys)


def test_a_slip_that_is_not_positive_is_refused():
    model = Model(strip(4.0, 3.0, 1.0, (3, 2)), material=ELASTIC)
    with pytest.raises(InvalidValue, match="elastic slip"):
        model.contact("lower", Plane((0, 0, -0.5)), friction=0.1, slip=0.0)


def test_a_slip_without_friction_is_refused():
    """With a coefficient of zero it is kept, so that a study may vary the coefficient alone."""
    model = Model(strip(4.0, 3.0, 1.0, (3, 2)), material=ELASTIC)
    with pytest.raises(InvalidFriction, match=r"contact tool1, slip[\s\S]*give friction"):
        model.contact("lower", Plane((0, 0, -0.5)), slip=0.01)
    with pytest.raises(InvalidFriction, match="give friction"):
        model.self_contact("lower", slip=0.01)
    model.contact("lower", Plane((0, 0, -0.5)), friction=0.0, slip=0.01)


@pytest.mark.parametrize("answer", [math.nan, -1.0, "rough", np.zeros(2)])
def test_a_function_that_answers_nonsense_is_named(answer):
    model, ways = block(friction=lambda p, s, z: answer if p > 5.0 else 0.1 * p, slip=None)
    with pytest.raises(NoConvergence, match="function of friction"):
        solve(model, Move(ways["z"], -0.1, steps=2))


def test_no_friction_is_no_friction():
    """A coefficient of zero costs nothing: the tangent stays symmetric."""
    model = Model(strip(4.0, 3.0, 1.0, (3, 2)), material=ELASTIC)
    contact = model.contact("lower", Plane((0, 0, -0.5)), friction=0)
    assert contact.symmetric and contact.friction is None
