"""Tools as things of a model: ways, turns, forces, springs, several pairs to one tool, poses as part of the state."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue, NoConvergence
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import Cylinder, Plane

STEEL = mt.J2(E=210e3, nu=0.3, hardening=mt.Linear(160.0, 500.0))
TIGHT = NewtonOptions(residual=1e-12, increment=1e-9)


def beam(material=STEEL, cells=(16, 1), friction=None):
    """A strip that is clamped at both ends under a cylinder that overlaps it by a hair."""
    model = Model(strip(40.0, 4.0, 1.0, cells), material=material, thickness_points=5)
    model.fix("x0")
    model.fix("x1")
    tool = model.tool("punch", Cylinder((20.0, 0.0, 10.48), "y", 10.0))
    model.contact("upper", tool, penalty=1e4, points=4, friction=friction, name="top")
    return model, tool


# Forces ------------------------------------------------------------------------------------------------------


def test_a_punch_that_a_force_presses_stands_where_a_driven_one_has_this_force():
    model, punch = beam(mt.SVK(E=210e3, nu=0.3))
    press = model.press(punch, "z", "press")
    result = solve(model, Move(press, -150.0, steps=6), options=TIGHT)
    np.testing.assert_allclose(result["punch_fz"][1:], -result["press"][1:], rtol=1e-9)  # the sheet holds the press
    driven, tool = beam(mt.SVK(E=210e3, nu=0.3))
    way = driven.drive(tool, "z", "way")
    other = solve(driven, Move(way, float(result["press_way"][-1]), steps=6), options=TIGHT)
    assert other["way_force"][-1] == pytest.approx(-150.0, rel=1e-9)
    np.testing.assert_allclose(model.u, driven.u, atol=1e-9 * np.abs(driven.u).max())


def test_newton_converges_quadratically_with_the_way_among_the_unknowns():
    model, punch = beam()
    press = model.press(punch, "z", "press")
    result = solve(model, Move(press, -200.0, steps=8), options=NewtonOptions(residual=1e-11))
    for records in result.iterations[2:]:
        last, final = records[-2].residual, records[-1].residual
        assert last < 1e-4
        assert final < max(100.0 * last**1.7, 1e-11)
    assert result["iterations"][2:].max() < 9


@pytest.mark.parametrize("friction", [None, 0.3])
@pytest.mark.parametrize("moved", ["press", "turn", "support"])
def test_rows_columns_and_corner_of_the_border_are_derivatives(moved, friction, rng):
    """The whole bordered tangent against central differences of residual and equation."""
    model, punch = beam(mt.SVK(E=210e3, nu=0.3), friction=friction)
    model.turn(punch, "y", (15.0, 0.0, 2.0), "tilt").value = 0.02 if moved == "turn" else 0.0
    press = model.press(punch, (0.3, 0.0, -1.0), "press")
    press.value = 50.0
    x = model.system.x.copy()
    x[: model.u.size] += 1e-3 * rng.normal(size=model.u.size)
    x[-1] = 0.05
    evaluation = model.evaluate(x)
    assert 0 < evaluation.active.sum() < evaluation.active.size
    border, dofs, step = evaluation.border, model.u.size, 1e-6
    for _ in range(3):
        dx = np.concatenate([rng.normal(size=dofs), [0.0]])
        ahead, behind = (model.evaluate(x + sign * step * dx).residual[-1] for sign in (1, -1))
        assert border.rows[0] @ dx[:dofs] == pytest.approx((ahead - behind) / (2 * step), rel=1e-6, abs=1e-6)
    dz = np.zeros(x.size)
    dz[-1] = 1.0
    ahead, behind = (model.evaluate(x + sign * step * dz).residual for sign in (1, -1))
    column = (ahead - behind) / (2 * step)
    np.testing.assert_allclose(border.columns[0], column[:dofs], atol=1e-6 * np.abs(column).max())
    assert border.corner[0, 0] == pytest.approx(column[-1], rel=1e-7)


def test_tools_of_another_model_are_refused():
    model, _ = beam()
    _, tool = beam()
    for call in (lambda: model.drive(tool, "z"), lambda: model.press(tool.pairs[0], "z")):
        with pytest.raises(InvalidValue, match="the model has no such tool"):
            call()
    with pytest.raises(InvalidValue, match="the model has no such tool"):
        model.contact("lower", tool)
    assert [one.name for one in model.tools] == ["punch"]


def test_a_tool_follows_a_way_and_moves_in_time_by_a_function():
    model, punch = beam()
    pad = model.tool("pad", Cylinder((20.0, 0.0, 10.0), "y", 2.0))
    with pytest.raises(InvalidValue, match="follows the way of another tool"):
        model.attach(pad, model.press(punch, "z", name="force"))
    with pytest.raises(InvalidValue, match="a motion in time is a function"):
        model.set_motion(pad, (0.0, 0.0, -1.0))


def test_a_spring_shares_the_force_with_the_sheet():
    model, punch = beam(mt.SVK(E=210e3, nu=0.3))
    force = model.spring(punch, "-z", stiffness=40.0, preload=30.0, name="pad")
    result = solve(model, Move(force, 25.0, steps=5), options=TIGHT)
    pushed = 30.0 - 40.0 * result["pad_way"] + result["pad"]  # what spring and press exert along -z
    np.testing.assert_allclose(result["pad_way_force"][1:], pushed[1:], rtol=1e-9)
    assert result["pad_way"][-1] > 0.05


def test_a_tool_that_touches_nothing_cannot_be_pressed():
    model = Model(strip(40.0, 4.0, 1.0, (8, 1)), material=STEEL)
    model.fix("x0")
    contact = model.contact("upper", Cylinder((20.0, 0.0, 11.0), "y", 10.0), penalty=1e4)
    press = model.press(contact, "z", "press")
    with pytest.raises(NoConvergence, match="not determined"):
        solve(model, Move(press, -1.0, steps=1))


def test_a_way_is_given_or_found_but_not_both():
    model, punch = beam()
    model.drive(punch, "z", "stroke")
    controls = list(model.controls)
    with pytest.raises(InvalidValue, match="driven and pressed"):
        model.press(punch, (0.0, 1.0, 1.0), "press")
    assert model.controls == controls
    assert len(punch.ways) == 1
    model.press(punch, "x", "push")  # across it is another way


# Moments, stops, tools that follow --------------------------------------------------------------------------


@pytest.mark.parametrize("friction", [None, 0.3])
@pytest.mark.parametrize("moved", ["turn", "way", "sheet", "angle"])
def test_the_equation_of_a_moment_has_exact_rows_columns_and_corner(moved, friction, rng):
    """Against central differences, beside a way that is found too and a turn that comes later."""
    model, punch = beam(mt.SVK(E=210e3, nu=0.3), friction=friction)
    moment = model.press_turn(punch, "y", (14.0, 0.0, 3.0), "moment")
    model.turn(punch, (0.3, 1.0, 0.0), (18.0, 0.0, 1.0), "tilt").value = 0.01
    press = model.press(punch, (0.3, 0.0, -1.0), "press")
    moment.value, press.value = 40.0, 50.0
    x = model.system.x.copy()
    dofs = model.u.size
    x[:dofs] += 1e-3 * rng.normal(size=dofs)
    x[dofs:] = 0.004, 0.05  # angle and way
    border, step, dx = model.evaluate(x).border, 1e-6, np.zeros(x.size)
    if moved == "turn":
        tilt = next(control for control in model.controls if control.name == "tilt")
        found = model.evaluate(x, rates={tilt: 0.7}).predictor

        def residual(fraction):
            tilt.value = 0.01 + 0.7 * fraction
            return model.evaluate(x).residual

        difference = (residual(step) - residual(-step)) / (2 * step)
    else:
        if moved == "sheet":
            dx[:dofs] = rng.normal(size=dofs)
        dx[dofs:] = {"sheet": (0.0, 0.0), "angle": (1.0, 0.0), "way": (0.0, 1.0)}[moved]
        difference = (model.evaluate(x + step * dx).residual - model.evaluate(x - step * dx).residual) / (2 * step)
        found = np.concatenate([dx[dofs:] @ border.columns, border.rows @ dx[:dofs] + border.corner @ dx[dofs:]])
    compared = slice(dofs, None) if moved == "sheet" else slice(None)
    scale = np.abs(difference[compared]).max()
    assert scale > 1.0
    np.testing.assert_allclose(found[compared], difference[compared], atol=3e-6 * scale)


def test_a_moment_turns_a_tool_until_the_sheet_answers():
    model, punch = beam(mt.SVK(E=210e3, nu=0.3))
    moment = model.press_turn(punch, "y", (0.0, 0.0, 10.0), "moment")
    result = solve(model, Move(moment, 2000.0, steps=4), options=TIGHT)
    np.testing.assert_allclose(result["moment_way_force"][1:], result["moment"][1:], rtol=1e-9)
    about = result["punch_my"] - 10.0 * result["punch_fx"]  # at (0, 0, 10)
    np.testing.assert_allclose(about[1:], -result["moment"][1:], rtol=1e-9)  # increments may be cut
    assert result["moment"][-1] == 2000.0
    assert 1e-4 < result["moment_way"][-1] < 0.2


def test_a_stop_takes_what_the_sheet_does_not():
    """A punch that would go deeper lies on distance blocks from -0.3 on."""
    model, punch = beam(mt.SVK(E=210e3, nu=0.3))
    press = model.press(punch, "z", "press")
    model.stop(press, at=-0.3, stiffness=1e4, below=True)
    result = solve(model, Move(press, -1000.0, steps=5), options=TIGHT)
    way, sheet = result["press_way"], result["punch_fz"]
    blocks = 1e4 * np.maximum(-0.3 - way, 0.0)
    np.testing.assert_allclose((sheet + blocks)[1:], -result["press"][1:], rtol=1e-9)
    assert blocks[1] < blocks[-1]
    assert -0.4 < way[-1] < -0.3
    free, other = beam(mt.SVK(E=210e3, nu=0.3))
    driven = solve(free, Move(free.drive(other, "z", "way"), float(way[-1]), steps=5), options=TIGHT)
    assert driven["punch_fz"][-1] == pytest.approx(sheet[-1], rel=1e-8)


def test_a_tool_follows_the_way_of_another_one_at_its_distance():
    """A pad on a spring in a punch: its spring feels the way that it has in the punch."""
    model, punch = beam(mt.SVK(E=210e3, nu=0.3))
    pad = model.tool("pad", Cylinder((20.0, 0.0, -10.48), "y", 10.0))
    model.contact("lower", pad, penalty=1e4, points=4, name="bottom")
    stroke = model.drive(punch, "z", "stroke")
    model.attach(pad, stroke)
    model.spring(pad, "z", stiffness=500.0, preload=20.0, name="gas")
    result = solve(model, Move(stroke, -0.3, steps=4), options=TIGHT)
    assert pad.pose_now[1][2] == pytest.approx(-0.3 + result["gas_way"][-1], abs=1e-12)
    np.testing.assert_allclose(result["pad_fz"][1:], -(20.0 - 500.0 * result["gas_way"])[1:], rtol=1e-8)
    np.testing.assert_allclose(-result["stroke_force"], result["punch_fz"] + result["pad_fz"], rtol=1e-12, atol=1e-12)
    assert np.abs(result.balance().drift).max() < 0.02
    for wrong in (stroke, model.controls[-1]):
        with pytest.raises(InvalidValue, match="follows the way"):
            model.attach(pad, wrong)


def test_stops_and_moments_that_make_no_sense_are_refused():
    model, punch = beam()
    press, way = model.press(punch, "z", "press"), model.drive(punch, "x", "slide")
    model.press_turn(punch, "y", (1.0, 0.0, 0.0), "moment")
    for stiffness in (0.0, -1.0, np.nan):
        with pytest.raises(InvalidValue, match="the force per length beyond must be positive"):
            model.stop(press, at=0.0, stiffness=stiffness)
    with pytest.raises(InvalidValue, match="presses no tool"):
        model.stop(way, at=0.0, stiffness=1.0)
    with pytest.raises(InvalidValue, match="driven and pressed"):
        model.press_turn(punch, "-y", (1.0, 2.0, 0.0), "again")  # the same line
    model.press_turn(punch, "y", (1.0, 0.0, 0.1), "beside")


# Ways and turns ----------------------------------------------------------------------------------------------


def test_a_turn_is_a_control_like_a_translation(rng):
    """Its pose is that of the motion in time with the same rotation, its force the moment on the sheet."""
    model, punch = beam()
    turn = model.turn(punch, "y", (20.0, 0.0, 0.5), "roll")
    timed, tool = beam()
    timed.set_motion(tool, lambda time: (np.zeros(3), np.array([0.0, 0.3, 0.0])), about=(20.0, 0.0, 0.5))
    turn.value = 0.3
    for a, b in zip(punch.pose_now, tool.pose_now, strict=True):
        np.testing.assert_allclose(a, b, atol=1e-14)
    evaluation = model.evaluate(model.system.x)
    force, moment = punch.resultant(evaluation.found, model.system.ranks)
    expected = (moment - np.cross([20.0, 0.0, 0.5], force))[1]
    assert turn.force(evaluation, model.system.ranks) == pytest.approx(-expected, abs=1e-12)


@pytest.mark.parametrize("friction", [None, 0.3])
def test_the_predictor_of_a_turning_tool_is_a_derivative(friction, rng):
    model, punch = beam(mt.SVK(E=210e3, nu=0.3), friction=friction)
    turn, way = model.turn(punch, "y", (15.0, 0.0, 0.0), "tilt"), model.drive(punch, (1.0, 0.0, -0.2), "slide")
    u = 1e-3 * rng.normal(size=model.u.size)
    rates = {turn: 0.7, way: 1.3}
    found = model.evaluate(u, rates=rates).predictor

    def residual(fraction):
        turn.value, way.value = (0.05 + fraction * rates[turn], 0.04 + fraction * rates[way])
        return model.evaluate(u).residual

    turn.value, way.value = 0.05, 0.04
    found = model.evaluate(u, rates=rates).predictor
    difference = (residual(1e-6) - residual(-1e-6)) / 2e-6
    np.testing.assert_allclose(found, difference, atol=2e-6 * np.abs(difference).max())


@pytest.mark.parametrize("friction", [None, 0.3])
@pytest.mark.parametrize("moved", ["turn", "press", "sheet"])
def test_the_predictor_of_a_pressed_tool_is_a_derivative(moved, friction, rng):
    """In its equation too: a turn of the tool, the force and the sheet move the balance of forces."""
    model, punch = beam(mt.SVK(E=210e3, nu=0.3), friction=friction)
    turn, press = model.turn(punch, "y", (15.0, 0.0, 0.0), "tilt"), model.press(punch, "z", "press")
    rates = {"turn": {turn: 0.7}, "press": {press: 900.0}, "sheet": {}}[moved]
    x, du = model.system.x.copy(), rng.normal(size=model.u.size) * (moved == "sheet")
    x[: du.size] += 1e-3 * rng.normal(size=du.size)
    x[-1] = -0.05

    def equation(fraction):
        turn.value, press.value = 0.02 + fraction * rates.get(turn, 0.0), -50.0 + fraction * rates.get(press, 0.0)
        return model.evaluate(x + fraction * np.append(du, 0.0)).residual[-1]

    difference = (equation(1e-6) - equation(-1e-6)) / 2e-6
    turn.value, press.value = 0.02, -50.0
    found = model.evaluate(x, du=du if moved == "sheet" else None, rates=rates or None).predictor[-1]
    assert abs(difference) > 1.0
    assert found == pytest.approx(difference, rel=1e-6)


def test_turns_come_first_in_the_order_in_which_they_were_made():
    model, punch = beam()
    first, second = model.turn(punch, "z", (1.0, 0.0, 0.0), "first"), model.turn(punch, "x", (0.0, 2.0, 0.0), "second")
    way = model.drive(punch, "y", "way")
    first.value, second.value, way.value = np.pi / 2, np.pi / 2, 5.0
    rotation, shift = punch.pose_now
    # (2, 0, 0) turns about z at (1, 0, 0) to (1, 1, 0), then about x at (0, 2, 0) to (1, 2, -1), and goes 5 along y.
    np.testing.assert_allclose(rotation @ [2.0, 0.0, 0.0] + shift, [1.0, 7.0, -1.0], atol=1e-12)


# One tool, several pairs -------------------------------------------------------------------------------------


def test_columns_and_work_are_those_of_the_tool_over_all_its_pairs():
    """A die under both halves of a strip, as one pair and as two of the same tool: the same run."""

    def pressed(halves):
        model = Model(strip(20.0, 2.0, 1.0, (8, 1)), material=mt.SVK(E=1000.0, nu=0.3))
        model.symmetry("x0", "x")
        model.symmetry(lambda x, y, z: y < 1e-9, "y")
        bed = model.tool("bed", Plane((0.0, 0.0, -0.5)))
        lower = model.mesh.face_set("lower")
        parts = [lower[:4], lower[4:]] if halves else [lower]
        for k, part in enumerate(parts):
            model.contact(part, bed, penalty=100.0, points=3, name=f"half{k}")
        lift = model.drive(bed, "z", "lift")
        load = model.force("x0_upper", (0.0, 0.0, -1.0), "load")
        return solve(model, [Move(load, 2.0, steps=2), Move(lift, 0.5, steps=3)], options=TIGHT)

    one, two = pressed(False), pressed(True)
    for column in ("bed_fz", "bed_my", "lift_force", "external_work", "contact_energy"):
        np.testing.assert_allclose(two[column], one[column], rtol=1e-9, atol=1e-9)
    assert [name for name in two.columns() if name.startswith("half")] == [
        f"half{k}_{what}" for k in (0, 1) for what in ("penetration", "penetration_energy", "penalty", "active")
    ]


# The pose is a part of the state -----------------------------------------------------------------------------


def test_after_a_failed_run_the_pose_is_where_the_control_says():
    """Pushed through a clamped sheet by a thousand thicknesses: nothing of the attempt is left."""
    model, punch = beam(cells=(8, 1))
    stroke = model.drive(punch, "z", "stroke")
    solve(model, Move(stroke, -0.2, steps=2))
    saved, force = model.system.snapshot(), model.contacts[0].resultant()[0]
    with pytest.raises(NoConvergence):
        solve(model, Move(stroke, -1000.0, steps=1, cuts=0))
    assert stroke.value == -0.2
    np.testing.assert_array_equal(punch.pose_now[1], [0.0, 0.0, -0.2])
    model.system.restore(saved)
    found = model.evaluate(model.system.x).found[model.contacts[0]]
    np.testing.assert_allclose(found.resultant()[0], force, rtol=1e-9)


# Names -------------------------------------------------------------------------------------------------------


def die(model):
    return model.contact("lower", Plane((0, 0, -5)), penalty=1.0, name="die")


def die_tool(model):
    return model.tool("die", Plane((0, 0, -5)))


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (lambda m: m.force("x0", (0, 0, 1), "a"), lambda m: m.force("x1", (0, 0, 1), "a_force")),
        (lambda m: m.force("x0", (0, 0, 1), "a_force"), lambda m: m.force("x1", (0, 0, 1), "a")),
        (die, lambda m: m.force("x1", (0, 0, 1), "die_fx")),
        (lambda m: m.force("x1", (0, 0, 1), "die_my"), die_tool),
        (lambda m: m.force("x1", (0, 0, 1), "die_active"), die),
        (die_tool, die),
    ],
)  # fmt: skip
def test_two_things_that_would_write_one_column_are_refused(first, second):
    model = Model(strip(10.0, 1.0, 0.5, (4, 1)), material=STEEL)
    first(model)
    before = list(model.controls), list(model.contacts), list(model.tools)
    with pytest.raises(InvalidValue, match="the name is taken"):
        second(model)
    assert (model.controls, model.contacts, model.tools) == before


def test_a_refused_call_leaves_nothing_behind():
    model = Model(strip(10.0, 1.0, 0.5, (4, 1)), material=STEEL)
    model.fix("x0")
    model.force("x1", (0, 0, 1), "taken")
    contact = model.contact("lower", Plane((0, 0, -5)), penalty=1.0, name="die")
    unknowns, ways = model.supports.unknown_count, list(contact.tool.ways)
    for call in (
        lambda: model.prescribe_midline("x1", "z", name="taken"),
        lambda: model.prescribe("x1", "z", name="taken"),
        lambda: model.drive(contact, "z", name="taken"),
        lambda: model.turn(contact, "z", name="taken"),
        lambda: model.press(contact, "z", name="taken"),
        lambda: model.spring(contact, "z", 1.0, name="taken"),
    ):
        with pytest.raises(InvalidValue, match="taken"):
            call()
        assert model.supports.unknown_count == unknowns
        assert contact.tool.ways == ways
        assert contact.tool.presses == []
        assert [control.name for control in model.controls] == ["taken"]


def test_a_solver_sees_the_border_only_where_there_is_one():
    model, punch = beam()
    newton = Newton(model.system)
    solver, evaluation = newton.ready_solver(), model.evaluate(model.system.x)
    solver.factor(evaluation)
    plain = solver.solve(model.system.restrict(np.ones(model.u.size)))
    model.press(punch, "z", "press")
    solver, evaluation = newton.ready_solver(), model.evaluate(model.system.x)
    solver.factor(evaluation)
    whole = solver.solve(model.system.restrict(np.ones(model.u.size + 1)))
    assert whole.size == plain.size + 1


def test_what_is_fixed_when_a_thing_is_made_cannot_be_set():
    """A setting that would have no effect any more is refused, and the kernels keep what they have."""
    model, punch = beam()
    contact, body = model.contacts[0], model.bodies[0]
    for thing, name, value in (
        (contact, "points", 5),
        (contact, "tool", punch),
        (punch, "surface", Plane()),
        (body, "material", STEEL),
        (body, "element", body.element),
        (body, "thickness_points", 9),
    ):
        before = getattr(thing, name)
        with pytest.raises(InvalidValue, match=f"{name} is fixed"):
            setattr(thing, name, value)
        assert getattr(thing, name) is before
    contact.penalty = 2e4  # effective
    assert model.evaluate(model.system.x).found[contact].penalty == contact.block.penalty == 2e4


@pytest.mark.parametrize("first", ["drive", "press"])
@pytest.mark.parametrize(
    ("kind", "direction"), [("way", "-z"), ("way", (0.0, 1.0, 1.0)), ("turn", "y"), ("turn", "-y")]
)
def test_a_tool_is_not_driven_and_pressed_along_one_direction_in_either_order(first, kind, direction):
    """A tool that was pressed could be driven afterwards: its way was given and found."""
    model = uf.Model(uf.mesh.strip(4.0, 1.0, 0.5, (4, 1)), material=uf.SVK(E=1e5, nu=0.3))
    tool = model.tool("lid", uf.Plane((0, 0, 1.0), (0, 0, -1)))
    press, drive = (model.press, model.drive) if kind == "way" else (model.press_turn, model.turn)
    make = [(drive, direction), (press, "z" if kind == "way" else "y")][:: 1 if first == "drive" else -1]
    make[0][0](tool, make[0][1])
    before = len(model.controls)
    with pytest.raises(uf.errors.InvalidValue, match="driven and pressed along the same direction"):
        make[1][0](tool, make[1][1])
    assert len(model.controls) == before
    model.drive(tool, "x")
