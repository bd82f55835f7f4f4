"""Tools that are opened: their forces fade as dead loads, on a support that holds the part as a rigid body."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from umform import Box, Close, Free, Move, Plane, Release, UDie, resume, solve
from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.errors import InvalidValue, NoConvergence
from umform.history_variables import history_of
from umform.mesh import strip
from umform.model import Model

STEEL = mt.J2(E=206e3, nu=0.3, hardening=mt.Swift(565.32, 0.007117, 0.2589))


@dataclass
class Drawing:
    """A half of a U-bend: strip, die, holder and punch."""

    model: Model
    hold: object
    stroke: object

    @property
    def lower(self):
        """Places of the lower nodes in the plane, from the middle on, over the place of the first one."""
        model = self.model
        points = model.mesh.points
        row = np.flatnonzero((points[:, 2] < 0.1) & (points[:, 1] < 0.1))
        x = (points + model.u.reshape(-1, 3))[row[np.argsort(points[row, 0])]][:, ::2]
        return x - x[0]


def ubend(friction=None, points=5, augmented=False):
    """A small U-bend in plane strain."""
    mesh = strip(60.0, 1.0, 1.0, (30, 1)).transformed(lambda x: np.add(x, (0.0, 0.0, 0.5)))
    model = Model(mesh, "BEND8", material=STEEL)
    model.symmetry("x0", normal="x")
    model.fix(lambda x, y, z: x > -1.0, "y")
    die, holder = model.tool("die", UDie(34.0, 100.0, 4.0, 4.0)), model.tool("holder", Plane((0, 0, 2.0), (0, 0, -1)))
    punch = model.tool("punch", Box((0, 0, 51.0), (31.0, 100.0, 100.0), 4.0))
    rule = {"points": points, "friction": friction, "penetration": 0.02, "augmented": augmented}
    model.contact("lower", die, name="on_die", **rule)
    model.contact("upper", holder, name="under_holder", **rule)
    model.contact("upper", punch, name="under_punch", **rule)
    return Drawing(model, model.press(holder, "z", "hold"), model.drive(punch, "z", "stroke"))


@pytest.mark.parametrize(("friction", "apart"), [(None, 1e-3), (0.1, 5e-3)])
def test_both_springbacks_agree(friction, apart):
    """All tools fade at once, or punch and holder go back in the order in which a press opens.

    With friction a little flows while the press opens, and the way counts.
    """
    faded, opened = ubend(friction), ubend(friction)
    draw = [(Close(each.hold, force=-10.0), Move(each.stroke, -15.0)) for each in (faded, opened)]
    gauge = faded.model.hold_rigid(lambda x, y, z: x < 1e-9, name="gauge")
    assert len(gauge.held) == 1  # symmetry and plane strain hold the rest
    solve(faded.model, draw[0])
    before = faded.lower
    result = solve(faded.model, Free(faded.model.tools, steps=6, on=gauge))
    solve(opened.model, [*draw[1], Move(opened.stroke, 2.0), Release(opened.hold)])
    springback = np.abs(faded.lower - before).max()
    assert springback > 0.5
    assert np.abs(faded.lower - opened.lower).max() < apart * springback
    reactions = result.frames[-1].points["reaction"].ravel()[gauge.held]
    assert np.abs(reactions).max() < 1e-8 * np.abs(result["die_fz"][0])
    np.testing.assert_array_equal(result["hold"][1:], 0.0)
    for tool in ("die", "holder", "punch"):
        np.testing.assert_array_equal(result[f"{tool}_fz"][1:], 0.0)
        np.testing.assert_allclose(result[f"{tool}_left"][1:], np.linspace(1, 0, 7)[1:], atol=1e-12)
    assert np.abs(result.balance().drift).max() < 1e-3
    assert result.balance().force_imbalance.max() < 1e-9


def test_the_opening_is_solved_as_springback_and_the_next_step_is_not(monkeypatch):
    seen = []
    solve_ = Newton.solve

    def watched(self, *arguments, **named):
        seen.append((self.mode().mixed, self.mode().line_search))
        return solve_(self, *arguments, **named)

    monkeypatch.setattr(Newton, "solve", watched)
    part = ubend(0.1)
    gauge = part.model.hold_rigid(lambda x, y, z: x < 1e-9, name="gauge")
    solve(part.model, [Close(part.hold, force=-10.0), Move(part.stroke, -3.0)], progress=False)
    assert set(seen) == {(False, True)}
    seen.clear()
    solve(part.model, Free(part.model.tools, steps=2, on=gauge), progress=False)
    assert set(seen) == {(True, False)}


def test_what_friction_remembered_does_not_come_back():
    """The points of opened tools hold nothing, and a tool that is put back begins where the sheet is then."""
    part = ubend(0.1)
    gauge = part.model.hold_rigid(name="gauge")
    tools, pairs = part.model.tools, part.model.contacts
    result = solve(part.model, [Close(part.hold, force=-10.0), Move(part.stroke, -2.0)])
    assert any(history_of(pair.block)["held"].any() for pair in pairs)
    result = solve(part.model, [Free(tools, steps=4, on=gauge), Move(part.stroke, 30.0, steps=1)])
    work = result["on_die_friction_work"]
    np.testing.assert_allclose(work, work[0], rtol=1e-12)
    for pair in pairs:
        for name in ("held", "tangential traction", "tangential multiplier"):
            np.testing.assert_array_equal(history_of(pair.block)[name], 0.0)
        assert not pair.found.active.any()
    with pytest.raises(InvalidValue, match="not open"):
        part.model.put_back(ubend().model.tools[0])
    part.model.put_back(tools[2])
    again = solve(part.model, Move(part.stroke, 25.0, steps=1))
    assert again["punch_fz"][-1] == 0.0


def test_a_tool_is_put_back_where_the_sheet_is_clear_of_it():
    part = ubend()
    gauge = part.model.hold_rigid(name="gauge")
    punch = part.model.tools[2]
    result = solve(part.model, [Close(part.hold, force=-10.0), Move(part.stroke, -3.0), Free(punch, steps=4)])
    assert result["punch_left"][-1] == 0.0
    assert result["holder_fz"][-1] == pytest.approx(10.0, rel=1e-6)
    with pytest.raises(InvalidValue, match="clear of it"):
        part.model.put_back(punch)
    solve(part.model, Move(part.stroke, 2.0, steps=1))
    part.model.put_back(punch)
    result = solve(part.model, Move(part.stroke, -3.0))
    assert result["punch_fz"][-1] > 1.0
    assert gauge.removed


def test_a_tool_that_is_put_back_has_no_multipliers():
    """Points that multipliers have borne press on nothing before the tool touches again."""
    part = ubend(augmented=True)
    punch, pair = part.model.tools[2], part.model.contacts[2]
    solve(part.model, [Close(part.hold, force=-10.0), Move(part.stroke, -0.5), Free(punch, steps=2)], progress=False)
    assert pair.multipliers.any()
    solve(part.model, Move(part.stroke, 2.0, steps=1), progress=False)
    part.model.put_back(punch)
    assert not pair.multipliers.any()
    assert solve(part.model, Move(part.stroke, 1.5, steps=1), progress=False)["punch_fz"][-1] == 0.0


@pytest.mark.parametrize("stop", [6, 8])
def test_a_run_that_opens_tools_is_taken_up_to_the_last_bit(tmp_path, stop):
    def run(path, until=None, work=solve):
        part = ubend(0.1)
        gauge = part.model.hold_rigid(name="gauge")
        steps = [Close(part.hold, force=-10.0), Move(part.stroke, -0.5, steps=2), Free(part.model.tools, 4, on=gauge)]
        if work is resume:
            return resume(path, part.model, steps, every=0.0), part
        commits, commit = iter(range(1000)), part.model.system.commit

        def stopping(evaluation):
            commit(evaluation)
            if next(commits) == until:
                raise KeyboardInterrupt

        part.model.system.commit = stopping
        try:
            return solve(part.model, steps, checkpoint=path, every=0.0), part
        except KeyboardInterrupt:
            return None, part

    whole, first = run(tmp_path / "whole")
    assert len(whole) > stop + 2
    assert run(tmp_path / "part", until=stop)[0] is None
    taken_up, second = run(tmp_path / "part", work=resume)
    for column in whole.columns():
        np.testing.assert_array_equal(taken_up[column], whole[column], err_msg=column)
    np.testing.assert_array_equal(second.model.u, first.model.u)


def test_tools_act_again_if_the_first_increment_fails():
    part = ubend()
    gauge = part.model.hold_rigid(name="gauge")
    solve(part.model, [Close(part.hold, force=-10.0), Move(part.stroke, -8.0)])
    u, force = part.model.u.copy(), part.model.contacts[2].resultant()[0]
    with pytest.raises(NoConvergence) as caught:
        options = NewtonOptions(max_iterations=1)
        solve(part.model, Free(part.model.tools, steps=1, cuts=0, on=gauge), options=options)
    assert len(caught.value.result) == 1
    assert not any(tool.open for tool in part.model.tools)
    assert gauge.removed
    assert part.hold.value == -10.0
    assert [tool.load.value for tool in part.model.tools] == [0.0, 0.0, 0.0]
    np.testing.assert_array_equal(part.model.u, u)
    found = part.model.evaluate(part.model.system.x).found[part.model.contacts[2]]
    np.testing.assert_allclose(found.resultant()[0], force, rtol=1e-9)


def test_a_part_is_held_by_six_degrees_of_freedom_at_three_nodes():
    mesh = strip(10.0, 4.0, 0.5, (5, 2))
    model = Model(mesh, material=STEEL)
    corners = np.unique([mesh.nodes(lambda x, y, z, p=p: np.hypot(x - p[0], y - p[1]) + abs(z + 0.25) < 1e-6)
                         for p in ((0.0, 0.0), (10.0, 0.0), (0.0, 4.0))])  # fmt: skip
    gauge = model.hold_rigid(corners)
    assert len(gauge.held) == 6
    np.testing.assert_array_equal(np.unique(gauge.held // 3), corners)
    assert model.supports.unknown_count == 3 * len(mesh.points)  # it waits
    with pytest.raises(InvalidValue, match="cannot hold"):
        model.hold_rigid(corners[:2])
    model.fix("x0")
    with pytest.raises(InvalidValue, match="already"):
        model.hold_rigid()


@pytest.mark.parametrize("edge", ["fix", "hinge"])
def test_six_degrees_of_freedom_take_the_place_of_a_support_of_the_same_nodes(edge):
    """A sheet stretched against its clamp and freed on nodes of that clamp: no force is left, and no stress."""
    model = Model(strip(10.0, 4.0, 0.5, (5, 2)), material=mt.SVK(E=1e5, nu=0.3))
    clamp = model.fix("x0") if edge == "fix" else model.hinge("x0")
    guide, foot = model.fix("x1", "y"), model.hold_director("x0", "x")
    lift = model.fix("x1_lower", "z")
    pull = model.force("x1", (5.0, 0.0, 0.0), "pull")
    solve(model, Move(pull, 1.0, steps=1))
    supports = [clamp, guide, foot, lift]
    with pytest.raises(InvalidValue, match="hold the sheet already"):
        model.hold_rigid("x0")
    gauge = model.hold_rigid("x0", "gauge", instead_of=supports)
    assert len(gauge.held) == 6
    assert set(gauge.held // 3) <= set(model.mesh.nodes("x0"))
    assert all(support in model.supports for support in supports)
    assert np.abs(model.u).max() > 1e-4
    result = solve(model, [Free(supports, steps=2, on=gauge), Move(pull, 0.0, steps=1)])
    reactions = result.frames[-1].points["reaction"]
    assert np.abs(reactions).max() < 1e-9
    assert result["elastic_energy"][-1] < 1e-16
    assert result["elastic_energy"][0] > 1e-6
    for wrong in (clamp, None, pull):
        with pytest.raises(InvalidValue, match="supports that act"):
            model.hold_rigid("x0", instead_of=wrong)


def test_what_cannot_be_opened_is_refused():
    part, other = ubend(), ubend()
    gauge = part.model.hold_rigid(name="gauge")
    die = part.model.tools[0]
    with pytest.raises(InvalidValue, match="takes a support, a tool"):
        Free([die, part.stroke])
    with pytest.raises(InvalidValue, match="that waits"):
        Free(die, on=part.model.supports[0])
    assert Free([die, *die.pairs]).things == [die]  # each once
    for steps in (Free(other.model.tools), [Free(die), Free(die)],
                  [Free(die, on=gauge), Free(part.model.tools[1], on=gauge)]):  # fmt: skip
        with pytest.raises(InvalidValue, match=r"does not have then|does not wait then"):
            solve(part.model, steps)
