"""Rigid stops of pressed tools, and gaps that they keep: against a sheet as a spring in series, to round-off."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue

E, AREA, PENALTY = 210e3, 40.0, 1e3
#: Force per way of the holder: contact above, the sheet (1 thick, no Poisson effect), contact below.
STIFFNESS = 1.0 / (2.0 / (PENALTY * AREA) + 1.0 / (E * AREA))
#: The holder touches the sheet, which lies on the die, after so much.
FREE = 0.1


def pressed(stop=None, **how):
    """A sheet on a die, under a holder."""
    model = uf.Model(uf.mesh.strip(20.0, 2.0, 1.0, (10, 1)), material=uf.SVK(E=E, nu=0.0))
    model.symmetry("x0", "x")
    model.fix(lambda x, y, z: y > -1.0, "y")
    die = model.contact("lower", uf.Plane((0.0, 0.0, -0.5)), penalty=PENALTY, name="die")
    holder = model.contact("upper", uf.Plane((0.0, 0.0, 0.5 + FREE), (0.0, 0.0, -1.0)), penalty=PENALTY, name="holder")
    hold = model.press(holder, "z", "hold")
    if stop is not None:
        model.stop(hold, stop, below=True, **how)
    return model, hold, die


def forces(result):
    return result["hold_way"][-1], result["holder_fz"][-1], result["hold_stop"][-1]


@pytest.mark.parametrize("depth", [-0.05, 0.0, 0.005, 0.0199])
def test_a_holder_lies_on_its_blocks_and_lifts_off_under_the_largest_force(depth):
    """On the blocks the sheet bears what their height leaves it, and they the rest; with less force it is free."""
    at, borne = -FREE - depth, STIFFNESS * max(depth, 0.0)
    model, hold, _ = pressed(at)
    result = uf.solve(model, [uf.Close(hold, -300.0), uf.Move(hold, -400.0, steps=1)], progress=False)
    way, force, stop = forces(result)
    assert way == pytest.approx(at, abs=1e-14)
    assert result["hold_way"].min() >= at - 1e-14  # on the way there too
    assert force == pytest.approx(borne, rel=2e-3)  # the sheet is not linear
    assert force + stop == pytest.approx(400.0, rel=1e-12)
    if depth > 0.0:
        result = uf.solve(model, uf.Move(hold, -0.5 * borne, steps=1), progress=False)
        way, force, stop = forces(result)
        assert stop == 0.0
        assert force == pytest.approx(0.5 * borne, rel=1e-9)
        assert way > at
        assert result["iterations"].max() <= 4


def test_a_rigid_stop_is_the_limit_of_elastic_ones():
    """The way errs by force over stiffness, which a rigid one takes away; a tool between two goes from one to the
    other."""
    rigid = uf.solve(*_run(pressed(-0.105)), progress=False)
    for stiffness in (1e6, 1e8):
        elastic = uf.solve(*_run(pressed(-0.105, stiffness=stiffness)), progress=False)
        off = rigid["hold_way"][-1] - elastic["hold_way"][-1]
        assert off == pytest.approx(rigid["hold_stop"][-1] / stiffness, rel=0.05)
    model, hold, _ = pressed(-0.105)
    model.fix("x0_lower", "z")  # nothing else holds the sheet once the holder has gone up
    model.hold_director("x0", "z")
    model.stop(hold, -0.05)
    result = uf.solve(model, [uf.Close(hold, -300.0), uf.Move(hold, 70.0, steps=1)], progress=False)
    assert forces(result) == pytest.approx((-0.05, 0.0, -70.0), abs=1e-12)


def test_an_elastic_stop_that_is_not_reached_bears_nothing():
    result = uf.solve(*_run(pressed(-1.0, stiffness=1e3)), progress=False)
    assert result["holder_fz"][-1] == pytest.approx(300.0, rel=1e-9)


def _run(built):
    model, hold, _ = built
    return model, uf.Close(hold, -300.0)


def test_a_gap_between_two_tools_is_kept_while_both_move():
    """The gap is measured between the tools wherever the sheet lies; a die that is lifted takes the holder along."""
    model, hold, die = pressed()
    lift = model.drive(die, "z", "lift")
    with pytest.raises(InvalidValue, match="move together"):
        model.keep_gap(hold, die, 0.995)
    model.attach(model.tools[1], lift)
    model.keep_gap(hold, die, 0.995)
    result = uf.solve(model, [uf.Close(hold, -300.0), uf.Move(lift, 0.5, steps=2)], progress=False)
    way, force, stop = forces(result)
    assert 1.0 + FREE + way == pytest.approx(0.995, abs=1e-14)
    assert force == pytest.approx(STIFFNESS * 0.005, rel=2e-3)
    assert force + stop == pytest.approx(300.0, rel=1e-12)
    np.testing.assert_allclose(model.u.reshape(-1, 3)[:, 2], 0.4975, atol=3e-3)


def test_a_gap_to_a_tool_that_is_driven_alone_afterwards_is_refused_before_the_run():
    """The stop stands still: it kept the gap to where the die was."""
    model, hold, die = pressed()
    model.keep_gap(hold, die, 0.995)
    lift = model.drive(die, "z", "lift")
    with pytest.raises(InvalidValue, match=r"move together[\s\S]*lift[\s\S]*attach\(holder, way\)"):
        uf.solve(model, uf.Close(hold, -300.0), progress=False)
    model.attach(model.tools[1], lift)
    result = uf.solve(model, [uf.Close(hold, -300.0), uf.Move(lift, 0.5, steps=1)], progress=False)
    assert 1.0 + FREE + forces(result)[0] == pytest.approx(0.995, abs=1e-14)


def test_what_makes_no_sense_is_refused():
    model, hold, die = pressed()
    for gap, message in ((-1.0, "positive"), (1.2, "nearer"), (np.nan, "positive")):
        with pytest.raises(InvalidValue, match=message):
            model.keep_gap(hold, die, gap)
    aside = model.press(model.tools[1], "x", "aside")
    with pytest.raises(InvalidValue, match="face each other"):
        model.keep_gap(aside, die, 0.9)
    for other in (None, uf.Plane((0, 0, -1.0), (0, 0, 1))):
        with pytest.raises(InvalidValue, match="no such tool"):
            model.keep_gap(hold, other, 0.9)
    model.stop(hold, -0.2)
    with pytest.raises(InvalidValue, match="no way between"):
        model.stop(hold, -0.1, below=True)
    assert len(model.tools.press_of(hold).stops) == 1


@pytest.mark.parametrize("until", [3, 6])
def test_a_run_on_a_stop_is_taken_up_to_the_last_bit(tmp_path, until):
    def steps(hold):
        return [uf.Close(hold, -100.0), uf.Move(hold, -400.0, steps=2), uf.Move(hold, -50.0, steps=2)]

    model, hold, _ = pressed(-0.105)
    whole = uf.solve(model, steps(hold), progress=False)
    model, hold, _ = pressed(-0.105)
    commits, commit = iter(range(1000)), model.system.commit

    def stopping(evaluation):
        commit(evaluation)
        if next(commits) == until:
            raise KeyboardInterrupt

    model.system.commit = stopping
    with pytest.raises(KeyboardInterrupt):
        uf.solve(model, steps(hold), checkpoint=tmp_path / "run", every=0.0, progress=False)
    model, hold, _ = pressed(-0.105)
    again = uf.resume(tmp_path / "run", model, steps(hold), every=0.0, progress=False)
    for column in whole.columns():
        np.testing.assert_array_equal(again[column], whole[column], err_msg=column)
