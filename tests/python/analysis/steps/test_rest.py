"""A sheet that is loose at first rests on weak springs, which are removed once tools hold it."""

from __future__ import annotations

import numpy as np
import pytest

from umform import Close, Cylinder, Move, Plane, resume, solve
from umform import materials as mt
from umform.errors import InvalidValue, RigidBodyMotion
from umform.mesh import strip
from umform.model import Model

STEEL = mt.J2(E=206e3, nu=0.3, hardening=mt.Swift(565.32, 0.007117, 0.2589))


def loose(friction=None, supported=True):
    """A blank that floats between a die and a holder."""
    model = Model(strip(20.0, 2.0, 0.8, (10, 1)), material=STEEL)
    if supported:
        model.symmetry("x0", "x")
        model.fix(lambda x, y, z: y > -1.0, "y")
    rule = {"penalty": 2e3, "friction": friction}
    model.contact("lower", Plane((0, 0, -1.0)), name="die", **rule)
    holder = model.contact("upper", Plane((0, 0, 1.4), (0, 0, -1)), name="holder", **rule)
    return model, model.press(holder, "z", "hold")


@pytest.mark.parametrize(("friction", "supported"), [(None, True), (0.2, False)])
def test_springs_carry_the_sheet_until_contact_holds_it(friction, supported):
    """With friction that sticks a sheet is held that has no support at all."""
    model, hold = loose(friction, supported)
    model.rest()
    result = solve(model, Close(hold, force=-200.0))
    acts, energy = result["rest_acts"], result["rest_energy"]
    assert acts[0] == 1.0
    assert acts[-1] == 0.0
    assert (np.diff(acts) <= 0.0).all()
    assert 0.0 < energy[-1] < 1e-6 * result["external_work"][-1]
    assert energy[-1] == energy.max()
    assert result["die_fz"][-1] == pytest.approx(-200.0, rel=1e-9)
    assert result["holder_fz"][-1] == pytest.approx(200.0, rel=1e-9)
    assert "let go" in result.events[-1]
    assert not any("springs" in warning for warning in result.warnings)
    np.testing.assert_allclose(model.u.reshape(-1, 3)[:, 2], -0.6, atol=0.02)


def test_springs_that_still_act_at_the_end_are_a_warning():
    """Two frictionless planes leave a blank three motions."""
    model, hold = loose(supported=False)
    model.rest()
    result = solve(model, Close(hold, force=-200.0))
    assert result["rest_acts"][-1] == 1.0
    assert any("still act" in warning for warning in result.warnings)


def test_springs_stay_while_they_carry_part_of_the_load():
    """Springs with 1.5 % of the forces of contact would let the sheet jump."""
    model, hold = loose()
    model.rest(stiffness=10.0)
    result = solve(model, Close(hold, force=-200.0))
    assert result["rest_acts"][-1] == 1.0
    assert result["die_fz"][-1] == pytest.approx(-200.0 + 10.0 * 0.6, rel=1e-2)


def test_springs_with_too_much_energy_are_a_warning():
    model, hold = loose()
    model.rest(stiffness=1.0)
    result = solve(model, Close(hold, force=-1000.0))
    assert result["rest_acts"][-1] == 0.0
    assert result["rest_energy"][-1] == pytest.approx(0.5 * 0.6**2, rel=0.1)
    assert any("smaller stiffness" in warning for warning in result.warnings)


def test_a_loose_sheet_that_tools_will_hold_rests_on_springs_by_itself():
    """As with a call of rest(), to the last bit; the run says so, and for what."""
    model, hold = loose(0.2, supported=False)
    by_itself = solve(model, Close(hold, force=-200.0))
    assert "the sheet is loose" in by_itself.events[0]
    assert "translation z" in by_itself.events[0]
    assert by_itself["rest_acts"][[0, -1]].tolist() == [1.0, 0.0]
    assert 0.0 < by_itself["rest_energy"][-1] < 1e-6 * by_itself["external_work"][-1]
    assert not [text for text in by_itself.warnings if "external work" not in text]
    other, hold = loose(0.2, supported=False)
    other.rest()
    np.testing.assert_array_equal(solve(other, Close(hold, force=-200.0))["holder_fz"], by_itself["holder_fz"])
    again = solve(model, Move(model.controls[0], -250.0, steps=1))  # the tools hold it now
    assert [term.name for term in model.system.others] == ["rest"]
    assert again["rest_acts"][-1] == 0.0


def test_where_no_tool_will_hold_a_loose_sheet_it_is_refused():
    """Two frictionless planes leave three motions; a holder that does not move leaves all; a model may be strict."""
    model, hold = loose(supported=False)
    with pytest.raises(RigidBodyMotion, match=r"in 6 ways(.|\n)*leave free rotation about z"):
        solve(model, Close(hold, force=-200.0))
    model, _ = loose()
    with pytest.raises(RigidBodyMotion, match=r"translation z(.|\n)*no step moves"):
        solve(model, Move(model.force("upper", (1.0, 0.0, 0.0), "pull"), 1.0, steps=1))
    model, hold = loose()
    model.carries_loose_sheet = False
    with pytest.raises(RigidBodyMotion, match=r"translation z(.|\n)*switched off"):
        solve(model, Close(hold, force=-200.0))
    for stiffness in (0.0, -1.0, np.nan):
        with pytest.raises(InvalidValue, match="spring"):
            model.rest(stiffness)


@pytest.mark.parametrize("below", [None, 1e3])
def test_a_tool_that_loses_the_sheet_is_an_event_where_something_holds_it(below):
    """A pad on a stop below the end of a strip that is lifted off it: told once, with what holds it now."""
    model = Model(strip(20.0, 2.0, 0.8, (10, 1)), material=STEEL)
    model.fix("x0")
    pad = model.contact("lower", Cylinder((18.0, 0.0, -20.39), "y", 20.0), penalty=2e3, name="pad")
    push = model.press(pad, "z", "push") if below else model.spring(pad, "z", 50.0, 5.0, "push")
    if below:
        model.stop(push, at=0.05, stiffness=below)
    tip = model.prescribe("x1_lower", "z", "tip")
    start = Move([push, tip], [5.0, 0.0], steps=1) if below else Move(tip, -0.01, steps=1)
    result = solve(model, [start, Move(tip, 3.0, steps=3), Move(tip, 3.5, steps=1)], progress=False)
    told = [event for event in result.events if "lost the sheet" in event]
    assert result["pad_active"][-1] == 0
    assert not any("lost the sheet" in warning for warning in result.warnings)
    assert len(told) == 1
    assert told[0].startswith("step 2, time ")
    assert ("a stop holds it" if below else "a spring holds it") in told[0]
    assert "push_way" in told[0]


@pytest.mark.parametrize("stop", [4, -3])
def test_a_run_with_springs_is_taken_up_to_the_last_bit(tmp_path, stop):
    def run(path, until=None, work=solve):
        model, hold = loose(0.2, supported=False)
        model.rest()
        steps = [Close(hold, force=-200.0), Move(hold, -250.0, steps=2)]
        if work is resume:
            return resume(path, model, steps, every=0.0), model
        commits, commit = iter(range(1000)), model.system.commit

        def stopping(evaluation):
            commit(evaluation)
            if next(commits) == until:
                raise KeyboardInterrupt

        model.system.commit = stopping
        try:
            return solve(model, steps, checkpoint=path, every=0.0), model
        except KeyboardInterrupt:
            return None, model

    whole, first = run(tmp_path / "whole")
    assert len(whole) > 8
    assert run(tmp_path / "part", until=stop % len(whole))[0] is None
    taken_up, second = run(tmp_path / "part", work=resume)
    for column in whole.columns():
        np.testing.assert_array_equal(taken_up[column], whole[column], err_msg=column)
    np.testing.assert_array_equal(second.u, first.u)
