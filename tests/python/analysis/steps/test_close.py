"""Tools that are closed by their way until the sheet answers with a force, and are held by the force from then on."""

from __future__ import annotations

import numpy as np
import pytest

from umform import Close, Cylinder, Move, Plane, Release, resume, solve
from umform import materials as mt
from umform.analysis.newton.options import NewtonOptions
from umform.errors import InvalidValue, NoConvergence
from umform.mesh import strip
from umform.model import Model

STEEL = mt.J2(E=206e3, nu=0.3, hardening=mt.Swift(565.32, 0.007117, 0.2589))


def held(gap=3.0, friction=None):
    """A strip on a die, under a holder that hovers over it, and a tool that pulls at its end."""
    mesh = strip(20.0, 2.0, 0.8, (10, 1))
    model = Model(mesh, material=STEEL)
    model.symmetry("x0", "x")
    model.fix(lambda x, y, z: y > -1.0, "y")
    die, holder = model.tool("die", Plane((0, 0, -0.4))), model.tool("holder", Plane((0, 0, 0.4 + gap), (0, 0, -1)))
    model.contact("lower", die, friction=friction, penalty=2e3, name="under")
    model.contact("upper", holder, friction=friction, penalty=2e3, name="over")
    return model, model.press(holder, "z", "hold")


def beam(gap=2.0):
    """A strip that is clamped at both ends under a cylinder that hovers over it: it yields where it is pressed."""
    model = Model(strip(40.0, 4.0, 1.0, (16, 1)), material=STEEL)
    model.fix("x0")
    model.fix("x1")
    punch = model.tool("punch", Cylinder((20.0, 0.0, 10.5 + gap), "y", 10.0))
    model.contact("upper", punch, penalty=1e4, points=4, name="top")
    return model, punch


@pytest.mark.parametrize("friction", [None, 0.1])
def test_a_holder_lands_on_its_force_and_keeps_it(friction):
    model, hold = held(friction=friction)
    pull = model.prescribe("x1_lower", "x", "pull")
    result = solve(model, [Close(hold, force=-80.0), Move(pull, 0.1, steps=3)])
    landed = np.flatnonzero(result["hold"] == -80.0)[0]
    np.testing.assert_allclose(result["holder_fz"][landed:], 80.0, rtol=1e-9)
    np.testing.assert_allclose(result["hold"], -result["holder_fz"], rtol=1e-9, atol=1e-9)  # what the way takes
    assert result["time"][landed] == 1.0
    assert result["hold_way"][landed] < -3.0
    assert result["over_penetration"].max() < 0.03
    balance = result.balance()
    energy = balance.external_work[landed]
    assert abs(balance.drift[landed]) * balance.external_work.max() < 5e-3 * energy
    assert "hold_way" in result.events[0]


def test_a_tool_that_is_closed_twice_with_a_force_stays():
    model, hold = held()
    result = solve(model, [Close(hold, force=-80.0), Close(hold, force=-80.0)])
    assert result["step"].tolist().count(2) == 1
    np.testing.assert_allclose(result["hold_way"][-2:], result["hold_way"][-1], rtol=1e-12)


def test_the_last_increment_of_closing_converges_quadratically():
    model, punch = beam()
    result = solve(model, Close(model.press(punch, "z", "press"), force=-200.0), options=NewtonOptions(residual=1e-11))
    residuals = [record.residual for record in result.iterations[-1]]
    assert result["press"][-1] == -200.0
    assert result["punch_fz"][-1] == pytest.approx(200.0, rel=1e-9)
    assert residuals[-2] < 1e-4
    assert residuals[-1] < max(100.0 * residuals[-2] ** 1.7, 1e-11)


def test_the_force_is_met_where_other_increments_are_loose():
    model, punch = beam()
    press = model.press(punch, "z", "press")
    result = solve(model, Close(press, force=-200.0), options=NewtonOptions(residual=0.2, increment=1.0))
    assert result["punch_fz"][-1] == pytest.approx(200.0, rel=1e-8)


def test_closing_gives_what_a_press_gives_that_touched_before():
    """The way over which the tool came does not matter to the sheet, be it far away or too near."""
    near, far = [], []
    for gap, found in ((-0.01, near), (2.0, far)):
        model, punch = beam(gap)
        press = model.press(punch, "z", "press")
        solve(model, Close(press, force=-20.0), options=NewtonOptions(residual=1e-12))
        found.append(model.u.copy())
    np.testing.assert_allclose(near[0], far[0], atol=1e-7 * np.abs(far[0]).max())


def test_a_sprung_pad_is_closed_with_a_force_beside_the_spring():
    model, punch = beam()
    force = model.spring(punch, "-z", stiffness=40.0, preload=0.0, name="pad")
    result = solve(model, Close(force, force=120.0))
    assert result["punch_fz"][-1] == pytest.approx(120.0 - 40.0 * result["pad_way"][-1], rel=1e-9)
    assert result["pad_way"][-1] > 2.0


def test_a_tool_is_closed_to_a_smaller_force_too():
    model, punch = beam()
    press = model.press(punch, "z", "press")
    result = solve(model, [Close(press, force=-150.0), Close(press, force=-60.0)])
    assert result["punch_fz"][-1] == pytest.approx(60.0, rel=1e-9)
    assert result["press_way"][-1] > result["press_way"].min()


def test_a_hair_that_is_too_far_is_taken_back():
    """A stiff holder that would press a thousand times too hard at the first touch."""
    model, hold = held()
    for pair in model.contacts:
        pair.penalty = 1e5
    result = solve(model, Close(hold, force=-1.0))
    assert result["holder_fz"][-1] == pytest.approx(1.0, rel=1e-8)  # round-off of the gaps
    assert result["holder_fz"].max() <= 1.0 + 1e-8


@pytest.mark.parametrize("stop", [1, 3, 5])
def test_a_run_that_closes_a_tool_is_taken_up_to_the_last_bit(tmp_path, stop):
    def run(path, until=None, again=False):
        model, hold = held(friction=0.2)
        pull = model.prescribe("x1_lower", "x", "pull")
        steps = [Close(hold, force=-80.0), Move(pull, 0.05, steps=2)]
        if again:
            return solve_again(path, model, steps), model
        if until is not None:
            count = iter(range(1000))
            commit = model.system.commit

            def stopping(evaluation):
                commit(evaluation)
                if next(count) == until:
                    raise KeyboardInterrupt

            model.system.commit = stopping
            with pytest.raises(KeyboardInterrupt):
                solve(model, steps, checkpoint=path, every=0.0)
            return None, model
        return solve(model, steps), model

    def solve_again(path, model, steps):
        return resume(path, model, steps, every=0.0)

    whole, first = run(tmp_path / "whole")
    assert len(whole) > stop + 2
    run(tmp_path / "part", until=stop)
    taken_up, second = run(tmp_path / "part", again=True)
    for column in whole.columns():
        np.testing.assert_array_equal(taken_up[column], whole[column], err_msg=column)
    np.testing.assert_array_equal(second.u, first.u)


# A force over the stroke ----------------------------------------------------------------------------------------


def over_stroke(stroke):
    """A holder force that grows with the stroke."""
    return -80.0 - 400.0 * stroke


@pytest.mark.parametrize("law", [over_stroke, [(0.02, -88.0), (0.0, -80.0)]])
def test_a_holder_force_follows_the_stroke(law):
    model, hold = held(friction=0.1)
    pull = model.prescribe("x1_lower", "x", "pull")
    result = solve(model, [Close(hold, force=-80.0), Move(pull, 0.03, steps=3, follow={hold: law})])
    wanted = [-84.0, -88.0, -88.0 if isinstance(law, list) else -92.0]
    np.testing.assert_allclose(result["hold"][-3:], wanted, rtol=1e-12)
    np.testing.assert_allclose(result["holder_fz"], -result["hold"], rtol=1e-8, atol=1e-6)


def test_a_law_that_cannot_be_followed_is_refused():
    model, hold = held()
    pull = model.prescribe("x1_lower", "x", "pull")
    for law in ([0.0, 1.0], [(0.0, np.nan), (1.0, 2.0)], [(0.0, 1.0), (0.0, 2.0)]):
        with pytest.raises(InvalidValue, match="function or a table"):
            Move(pull, 1.0, follow={hold: law})
    with pytest.raises(InvalidValue, match="follows another one"):
        Move([pull, hold], [1.0, 2.0], follow={hold: over_stroke})
    with pytest.raises(InvalidValue, match="belongs to another model"):
        solve(held()[0], Move(pull, 1.0, follow={hold: over_stroke}))


# What cannot be --------------------------------------------------------------------------------------------------


def test_a_tool_that_moves_away_from_the_sheet_finds_no_answer():
    model, hold = held()
    with pytest.raises(NoConvergence, match=r"does not meet the sheet") as caught:
        solve(model, Close(hold, force=80.0))
    assert "tool holder" in str(caught.value)
    assert caught.value.result["hold_way"][-1] > 3.0


def test_a_sheet_that_gives_way_answers_no_force():
    model, punch = beam()
    with pytest.raises(NoConvergence, match=r"the sheet gives way"):
        solve(model, Close(model.press(punch, "z", "press"), force=-500.0, way=2.1))


def test_a_step_refuses_what_no_force_presses():
    model, punch = beam()
    press = model.press(punch, "z", "press")
    way = model.controls[1]
    with pytest.raises(InvalidValue, match="pressed tool"):
        Close(way, force=1.0)
    for force in (0.0, np.nan):
        with pytest.raises(InvalidValue, match="finite force"):
            Close(press, force=force)
    with pytest.raises(InvalidValue, match="largest way"):
        Close(press, force=1.0, way=-1.0)
    for step in (Move(way, -1.0), Release(way)):
        with pytest.raises(InvalidValue, match="way of a tool that a force presses"):
            solve(model, step)
    other, _ = held()
    with pytest.raises(InvalidValue, match="belongs to another model"):
        solve(other, Close(press, force=1.0))


def test_a_tool_that_loses_the_sheet_is_named():
    """Of two tools the one whose force goes over zero; and one under which the sheet gives way."""
    model, punch = beam()
    press = model.press(punch, "z", "press")
    with pytest.raises(NoConvergence, match="the way of tool punch, which press presses, is not determined"):
        solve(model, [Close(press, force=-100.0), Move(press, 20.0, steps=4)])
    tip = Model(strip(20.0, 2.0, 0.5, (10, 1)), material=mt.SVK(E=206e3, nu=0.3))
    tip.fix("x0")
    ball = tip.tool("ball", Cylinder((19.0, 0.0, 2.75), "y", 2.5))
    tip.contact("upper", ball, penalty=1e4, points=4)
    push = tip.press(ball, "z", "push")
    with pytest.raises(NoConvergence, match=r"tool ball, pressed with push = -\S+, holds the sheet"):
        solve(tip, [Close(push, force=-5.0), Move(push, -200.0, steps=5, cuts=4)])


def test_increments_in_contact_are_not_longer_than_the_largest():
    ways = {}
    for largest in (None, 0.2):
        model, punch = beam()
        step = Close(model.press(punch, "z", "press"), force=-200.0, increment=largest)
        ways[largest] = np.abs(np.diff(solve(model, step)["press_way"]))
    assert ways[None][2:].max() > 0.25
    assert ways[0.2][2:].max() <= 0.2 * (1.0 + 1e-9)


def test_the_increment_of_the_force_is_not_longer_where_the_sheet_begins_to_yield():
    """From the elastic slope the force seems near; on a yielding cantilever the tool travels eight times as far."""
    model = Model(
        strip(20.0, 2.0, 1.0, (16, 1)), material=mt.J2(E=206e3, nu=0.3, hardening=mt.Swift(400.0, 0.004, 0.22))
    )
    model.fix("x0")
    roller = model.contact("upper", Cylinder((16.0, 0.0, 2.0), "y", 1.0), points=5)
    result = solve(model, Close(model.press(roller, "-z", "press"), force=5.0, increment=0.1))
    assert np.diff(result["press_way"])[2:].max() <= 0.1 * (1.0 + 1e-9)
    assert result["press"][-1] == pytest.approx(5.0, rel=1e-12)
    assert np.abs(result.balance().drift).max() < 0.01
