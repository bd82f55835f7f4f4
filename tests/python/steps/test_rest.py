"""A sheet that lies loosely at first rests on weak springs, which let go once tools hold it."""

from __future__ import annotations

import numpy as np
import pytest

from umform import Close, Move, Plane, resume, solve
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


def test_springs_with_too_much_energy_are_a_warning():
    model, hold = loose()
    model.rest(stiffness=1.0)
    result = solve(model, Close(hold, force=-1000.0))
    assert result["rest_acts"][-1] == 0.0
    assert result["rest_energy"][-1] == pytest.approx(0.5 * 0.6**2, rel=0.1)
    assert any("smaller stiffness" in warning for warning in result.warnings)


def test_without_springs_a_loose_sheet_is_refused():
    model, hold = loose()
    with pytest.raises(RigidBodyMotion, match="translation z"):
        solve(model, Close(hold, force=-200.0))
    for stiffness in (0.0, -1.0, np.nan):
        with pytest.raises(InvalidValue, match="spring"):
            model.rest(stiffness)


@pytest.mark.parametrize("stop", [4, 17])
def test_a_run_with_springs_is_taken_up_to_the_last_bit(tmp_path, stop):
    def run(path, until=None, work=solve):
        model, hold = loose(0.2, supported=False)
        model.rest()
        steps = [Close(hold, force=-200.0), Move(hold, -250.0, steps=2)]
        if work is resume:
            return resume(path, model, steps, every=0.0), model
        commits, commit = iter(range(1000)), model.commit

        def stopping(evaluation):
            commit(evaluation)
            if next(commits) == until:
                raise KeyboardInterrupt

        model.commit = stopping
        try:
            return solve(model, steps, checkpoint=path, every=0.0), model
        except KeyboardInterrupt:
            return None, model

    whole, first = run(tmp_path / "whole")
    assert len(whole) > stop + 2
    assert run(tmp_path / "part", until=stop)[0] is None
    taken_up, second = run(tmp_path / "part", work=resume)
    for column in whole.columns():
        np.testing.assert_array_equal(taken_up[column], whole[column], err_msg=column)
    np.testing.assert_array_equal(second.u, first.u)
