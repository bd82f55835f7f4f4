"""Equivalent draw beads: exact tangent, resultant, reversal, what they may at most, energies, bad input."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from umform import materials as mt
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Free, Move
from umform.errors import InvalidBead, InvalidValue
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import Cylinder, Plane, Sphere, UserSurface

ELASTIC = mt.NeoHooke(E=1000.0, nu=0.3)


def tilted(x):
    """Three times the distance to a plane, as a function of the user."""
    n = np.array([0.1, -0.05, 1.0])
    n = n / np.linalg.norm(n)
    return 3.0 * (x @ n), np.tile(3.0 * n, (len(x), 1)), np.zeros((len(x), 3, 3))


TOOLS = {
    "plane": Plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "cylinder": Cylinder((0.0, 0.0, -3.0), (0.0, 1.0, 0.0), 3.0),
    "sphere": Sphere((0.0, 0.0, -5.0), 5.0),
    "bowl": Sphere((0.0, 0.0, 6.0), 6.0, inside=True),
    "user": UserSurface(tilted),
}
CURVES = {
    "straight": ([(0.3, -0.5, 0.0), (0.1, 0.5, 0.0)], False),
    "corner": ([(0.5, -0.4, 0.0), (0.1, 0.1, 0.0), (0.4, 0.6, 0.0)], False),
    "closed": ([(0.5, -0.3, 0.0), (0.4, 0.5, 0.0), (-0.3, 0.4, 0.0), (-0.5, -0.2, 0.0)], True),
    "fine": ([(0.7 * math.cos(a), 0.5 * math.sin(a), 0.0) for a in np.linspace(0.0, 4.0, 15)], False),
}


def drawn_plate(build, rng, tool, curve, closed, cell="hex8", slip=0.01, way=0.05):
    """A plate near a tool that moves and turns, after an increment that has called the bead up in part."""
    mesh = build.jittered(strip(2.0, 1.5, 0.2, (3, 2), cell=cell), 0.1)
    height = 0.13 if isinstance(tool, UserSurface) else 0.17  # where the bead fades, with three times the gap
    mesh = mesh.moved((0.0, 0.0, height))
    model = Model(mesh, {"hex8": "ANS3DEAS", "hex18": "MI9K3DEAS"}[cell], material=ELASTIC)
    die = model.tool("die", tool)
    bead = model.bead("lower", die, curve, closed=closed, restraint=7.0, uplift=3.0, width=1.0, slip=slip, points=6)
    shift, turn = np.array([0.03, 0.02, 0.0]), np.array([0.02, -0.03, 0.3])
    model.set_motion(die, lambda time: (shift, turn), about=(0.2, 0.1, 0.0))
    full = build.full_tangent(bead.block, len(mesh.points))
    u = 0.02 * rng.normal(size=full.size)
    bead.locate(u, bead.pose)
    bead.block.begin()
    full(u)
    bead.block.commit()
    step = np.array([0.9 * way, 0.3 * way, -0.01])
    u = u + np.tile(step, len(mesh.points)) + 0.2 * way * rng.normal(size=u.size)
    bead.locate(u, bead.pose)
    full(u)
    bead.block.commit()
    turn[:] += (0.01, 0.02, -0.02)
    u = u + np.tile(0.3 * step, len(mesh.points)) + 0.2 * way * rng.normal(size=u.size)
    bead.locate(u, bead.pose)
    return bead, full, u


@pytest.mark.parametrize("name", TOOLS)
@pytest.mark.parametrize("curve", CURVES)
@pytest.mark.parametrize("slip", [0.5, 0.02, 0.001])
def test_tangent_is_the_derivative_of_the_force(build, rng, name, curve, slip):
    bead, full, u = drawn_plate(build, rng, TOOLS[name], *CURVES[curve], slip=slip)
    _, K = full(u)
    counts = np.bincount(bead.block.found().active, minlength=3)
    assert counts[0] > 0 and counts[1 if slip == 0.5 else 2] > 0
    assert np.abs(K - K.T).max() > 1e-3 * np.abs(K).max()
    for _ in range(3):
        du = rng.normal(size=u.size)
        difference = (full.force(u + 1e-6 * du) - full.force(u - 1e-6 * du)) / 2e-6
        assert build.relative_error(K @ du, difference) < 1e-6


def test_tangent_on_faces_of_nine_nodes(build, rng):
    _, full, u = drawn_plate(build, rng, TOOLS["bowl"], *CURVES["corner"], cell="hex18", slip=0.02)
    _, K = full(u)
    du = rng.normal(size=u.size)
    difference = (full.force(u + 1e-6 * du) - full.force(u - 1e-6 * du)) / 2e-6
    assert build.relative_error(K @ du, difference) < 1e-6


def test_a_sheet_and_a_tool_that_move_together_feel_the_same_bead(build, rng):
    mesh = strip(2.0, 1.5, 0.2, (3, 2)).moved((0.0, 0.0, 0.12))
    model = Model(mesh, material=ELASTIC)
    die = model.tool("die", TOOLS["bowl"])
    bead = model.bead("lower", die, *CURVES["corner"][:1], restraint=7.0, uplift=3.0, width=1.0, slip=0.1)
    shift, turn = np.zeros(3), np.zeros(3)
    model.set_motion(die, lambda time: (shift, turn))
    full = build.full_tangent(bead.block, len(mesh.points))
    u = 0.03 * rng.normal(size=(len(mesh.points), 3))
    full(u.ravel())
    bead.block.commit()
    before = bead.block.found()
    shift[:], turn[:] = (0.4, -0.2, 0.1), (0.2, 0.5, -0.3)
    Q = Rotation.from_rotvec(turn).as_matrix()
    moved = (mesh.points + u) @ Q.T + shift - mesh.points
    bead.locate(moved.ravel(), bead.pose)
    full(moved.ravel())
    after = bead.block.found()
    assert np.linalg.norm(before.elastic_slip, axis=1).max() > 0.01
    np.testing.assert_allclose(after.traction, before.traction @ Q.T, atol=1e-11)
    np.testing.assert_allclose(after.elastic_slip, before.elastic_slip @ Q.T, atol=1e-13)


# Resultants --------------------------------------------------------------------------------------------------


def rigid_way(bead, way):
    """What is found when all points go a way (n, 3), each within the plane of the tool."""
    block = bead.block
    full = np.zeros(block.dofs)
    bead.locate(full, bead.pose)
    block.begin()
    bead.locate(way.ravel(), bead.pose)
    return block.found()


@pytest.mark.parametrize("place", [0.0, 0.13, 0.37])
def test_the_resultant_is_restraint_times_length(place):
    """Elements as long as half the band are enough, wherever the line lies; 9-node faces too."""
    for cell in ("hex8", "hex18"):
        mesh = strip(8.0, 6.0, 0.2, (8, 6), cell=cell).moved((0.0, 0.0, 0.1))
        model = Model(mesh, {"hex8": "ANS3DEAS", "hex18": "MI9K3DEAS"}[cell], material=ELASTIC)
        die = model.tool("die", TOOLS["plane"])
        line = [(4 + place, 1.1, 0.0), (4 + place, 4.6, 0.0)]
        bead = model.bead("lower", die, line, restraint=7.0, uplift=3.0, width=2.0)
        found = rigid_way(bead, np.tile([0.2, 0.1, 0.0], (len(mesh.points), 1)))
        force = found.force.sum(axis=0)
        np.testing.assert_allclose(force, [7.0 * 3.5, 0.0, -3.0 * 3.5], atol=1e-3 * 7.0 * 3.5)


def test_the_resultant_of_a_closed_line_is_that_of_its_length():
    mesh = strip(8.0, 8.0, 0.2, (8, 8)).moved((-4.0, 0.0, 0.1))
    y = mesh.points[:, 1].mean()
    model = Model(mesh, material=ELASTIC)
    die = model.tool("die", TOOLS["plane"])
    angles = np.linspace(0.0, 2.0 * math.pi, 60, endpoint=False)
    circle = np.stack([2.5 * np.cos(angles), y + 2.5 * np.sin(angles), 0 * angles], axis=1)
    bead = model.bead("lower", die, circle, closed=True, restraint=7.0, width=2.0, slip=1e-5)
    way = -1e-4 * (mesh.points - (mesh.points[:, 0].mean(), y, 0.1)) * (1.0, 1.0, 0.0)
    found = rigid_way(bead, way)
    force, total = found.force.sum(axis=0), float(found.area @ np.linalg.norm(found.traction, axis=1))
    assert total == pytest.approx(7.0 * bead.line.length, rel=1e-3)
    assert np.abs(force).max() < 2e-3 * total
    radial = found.x - (mesh.points[:, 0].mean(), y, 0.0)
    along = np.cross(found.traction, radial)[:, 2]
    assert np.abs(along).max() < 0.03 * np.abs(found.traction).max() * 2.5


def test_a_way_along_the_line_is_free():
    mesh = strip(8.0, 6.0, 0.2, (8, 6)).moved((0.0, 0.0, 0.1))
    model = Model(mesh, material=ELASTIC)
    bead = model.bead("lower", model.tool("die", TOOLS["plane"]), [(4, 0, 0), (4, 6, 0)], restraint=7.0, width=2.0)
    found = rigid_way(bead, np.tile([0.0, 0.3, 0.0], (len(mesh.points), 1)))
    assert found.points.size > 10
    assert np.abs(found.force).max() < 1e-12


def test_a_bead_fades_with_the_gap():
    """In full up to a quarter of the thickness, nothing from half of it on, smooth between."""
    forces = []
    for gap in np.linspace(-0.02, 0.12, 29):
        mesh = strip(8.0, 6.0, 0.2, (8, 6)).transformed(lambda x, gap=gap: x + np.array([0.0, 0.0, 0.1 + gap]))
        model = Model(mesh, material=ELASTIC)
        bead = model.bead("lower", model.tool("die", TOOLS["plane"]), [(4, 1, 0), (4, 5, 0)], restraint=7.0, width=2.0)
        forces.append(rigid_way(bead, np.tile([0.3, 0.0, 0.0], (len(mesh.points), 1))).force[:, 0].sum())
    forces = np.array(forces) / 28.0
    np.testing.assert_allclose(forces[:15], 1.0, rtol=1e-3)
    assert (np.diff(forces) < 1e-12).all() and (forces[25:] == 0.0).all()
    assert forces[19] == pytest.approx(0.5, abs=0.01)
    assert np.abs(np.diff(forces)).max() < 0.16


# A strip that is drawn through ---------------------------------------------------------------------------------


def drawn_strip(uplift=0.0, E=2e5, **settings):
    """A strip on a bed under a lid, with a bead across the bed, pulled at one end."""
    mesh = strip(40.0, 3.0, 1.0, (20, 1)).moved((0.0, 0.0, 0.5))
    model = Model(mesh, material=mt.NeoHooke(E=E, nu=0.3))
    model.fix(lambda x, y, z: y > -1, "y")
    pull = model.prescribe("x1", "x", "pull")
    bed = model.contact("lower", Plane(), penalty=2e3, name="bed")
    model.contact("upper", Plane((0, 0, 1), (0, 0, -1)), penalty=2e3, name="lid")
    bead = model.bead(
        "lower", bed, [(15.3, -10, 0), (15.3, 10, 0)], restraint=50.0, uplift=uplift, width=6.0, **settings
    )
    return model, pull, bead


def test_a_strip_that_is_drawn_through_pulls_with_the_restraint():
    """Element after element passes the band: the force stays, and turns with the way."""
    model, pull, _ = drawn_strip(uplift=20.0)
    result = solve(model, [Move(pull, 0.5, steps=4), Move(pull, 7.0, steps=26), Move(pull, 2.0, steps=20)])
    force = result["pull_force"]
    np.testing.assert_allclose(force[4:31], 50.0 * 3.0, rtol=1.5e-3)
    np.testing.assert_allclose(force[33:], -50.0 * 3.0, rtol=1.5e-3)
    np.testing.assert_allclose(result["bead_restraint"][4:31], 150.0, rtol=1.5e-3)
    np.testing.assert_allclose(result["bead_lift"][1:], 60.0, rtol=1.5e-3)
    np.testing.assert_allclose(result["bed_fx"][4:31], 150.0, rtol=1.5e-3)
    np.testing.assert_allclose(result["bead_slipping"][-1], result["bead_active"][-1])
    assert np.ptp(result["bead_work"][[4, 30]]) == pytest.approx(150.0 * 6.5, rel=2e-3)
    assert result["lid_fz"][20] == pytest.approx(-result["bed_fz"][20], rel=1e-6) and result["lid_fz"][20] > 60.0
    assert np.median(result["iterations"][5:]) <= 5


def test_no_point_bears_more_than_its_bound():
    model, pull, bead = drawn_strip(slip=0.05)
    for way in (0.02, 0.2, 1.0, 0.7):
        solve(model, Move(pull, way, steps=3))
        found = bead.found.held
        weight = 15 / 16 * np.maximum(1.0 - ((found.x[:, 0] - 15.3) / 3.0) ** 2, 0.0) ** 2 / 3.0
        near = np.clip(2.0 * found.gap / bead.line.off - 1.0, 0.0, 1.0)
        bound = bead.line.restraint * weight * (1.0 - near**2 * (3 - 2 * near))
        size = np.linalg.norm(found.traction[:, :2], axis=1)
        assert (size <= bound * (1 + 1e-9)).all()
        slips = found.active[found.points] == 2
        np.testing.assert_allclose(size[slips], bound[slips], rtol=1e-9)
        assert slips.any() or way == 0.02


def test_increments_at_rest_move_nothing():
    model, pull, _ = drawn_strip(slip=0.05)
    result = solve(model, [Move(pull, 0.03, steps=2), Move(pull, 0.03, steps=50)])
    assert 0.0 < result["bead_restraint"][2] < 150.0
    np.testing.assert_allclose(result["bead_restraint"][2:], result["bead_restraint"][2], rtol=1e-9)
    np.testing.assert_allclose(result["bead_work"][2:], result["bead_work"][2], atol=1e-12)


def test_the_work_of_a_bead_closes_the_balance():
    drifts = []
    for steps in (10, 20, 40):
        model, pull, _ = drawn_strip(E=2e3, slip=0.05)
        moves = [Move(pull, 4.0, steps=steps), Move(pull, 3.0, steps=steps // 2)]
        result = solve(model, moves, options=NewtonOptions(residual=1e-11))
        work = result["friction_work"]
        np.testing.assert_array_equal(work, result["bead_work"])
        assert (np.diff(work) > -1e-4 * work[-1]).all() and work[-1] > 0.2 * result["external_work"][-1]
        drifts.append(np.abs(result.balance().drift).max())
    assert drifts[2] < 0.1 * drifts[0]
    assert drifts[2] < 2e-5


def test_points_that_enter_and_leave_the_band_do_the_work_of_the_lift_only():
    """Their lift depends on the place: no energy of a gap, as points of contact have, is missing in it."""
    model, pull, bead = drawn_strip(uplift=20.0)
    solve(model, Move(pull, 0.5, steps=2))
    before = bead.found
    solve(model, Move(pull, 3.0, steps=1))
    assert (bead.found.active != before.active).any()
    assert bead.work_of_touch == 0.0


def test_a_bead_goes_with_the_tool_that_is_removed():
    model, pull, bead = drawn_strip()
    solve(model, Move(pull, 0.5, steps=3))
    load = model.remove(bead)
    assert bead not in model.system.terms and bead not in model.contacts[0].tool.pairs
    result = solve(model, Move(load, 0.0, steps=3))
    assert abs(result["pull_force"][-1]) < 1e-3
    assert "bead_work" not in result.columns()


def test_a_tool_that_opens_takes_its_bead_along():
    """The forces fade, and the work of the bead stays what it was."""
    model, pull, _ = drawn_strip(uplift=20.0)
    bed = model.contacts[0].tool
    result = solve(model, [Move(pull, 0.5, steps=8), Free(bed, steps=3)])
    assert abs(result["pull_force"][-1]) < 1e-6 < result["pull_force"][8]
    np.testing.assert_array_equal(result["bead_restraint"][9:], 0.0)
    np.testing.assert_allclose(result["bead_work"][9:], result["bead_work"][8], rtol=1e-12)
    assert np.ptp(result.balance().drift[8:]) < 1e-6


# Bad input ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"restraint": -1.0}, "restraint"),
        ({"restraint": math.nan}, "restraint"),
        ({"uplift": -1.0}, "uplift"),
        ({"width": 0.0}, "width"),
        ({"slip": -0.1}, "slip"),
        ({"curve": [(4, 0, 0)]}, "at least 2 points"),
        ({"curve": [(4, 0), (4, 6)]}, "at least 2 points"),
        ({"curve": [(4, 0, 0), (4, 6, 0)], "closed": True}, "at least 3 points"),
        ({"curve": [(4, 0, 0), (4, 0, 0), (4, 6, 0)]}, "are the same"),
        ({"curve": [(4, 0, 3), (4, 6, 3)]}, "beside its tool"),
        ({"curve": [(4, 0, 0), (4, 1, 0)]}, "shorter"),
        ({"width": 0.2}, "narrower"),
        ({"points": 0}, "1 to 10"),
    ],
)
def test_beads_that_make_no_sense_are_refused(wrong, said):
    model = Model(strip(8.0, 6.0, 0.2, (8, 6)), material=ELASTIC)
    die = model.tool("die", Plane((0, 0, -0.1)))
    given = {"curve": [(4, 0, 0), (4, 6, 0)], "restraint": 7.0, "width": 2.0} | wrong
    with pytest.raises(InvalidBead, match=said):
        model.bead("lower", die, **given)
    assert not model.system.others and not die.pairs


def test_a_bead_needs_a_tool_of_the_model_and_a_name_of_its_own():
    model = Model(strip(8.0, 6.0, 0.2, (8, 6)), material=ELASTIC)
    line = {"curve": [(4, 0, 0), (4, 6, 0)], "restraint": 7.0, "width": 2.0}
    with pytest.raises(InvalidBead, match="on a tool of the model"):
        model.bead("lower", Plane((0, 0, -0.1)), **line)
    die = model.tool("die", Plane((0, 0, -0.1)))
    assert model.bead("lower", die, **line).name == "bead"
    assert model.bead("lower", die, **line).name == "bead2"
    with pytest.raises(InvalidValue, match="taken"):
        model.bead("lower", die, name="bead", **line)
