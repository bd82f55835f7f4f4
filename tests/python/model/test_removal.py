"""Supports and tools that are taken away and put back between two runs, and within one."""

from __future__ import annotations

import numpy as np
import pytest

from umform import Free, Move, cylindrical, resume, solve
from umform import materials as mt
from umform.analysis.newton.options import NewtonOptions
from umform.errors import InvalidValue, NoConvergence, RigidBodyMotion
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import Cylinder, Plane

ELASTIC = mt.SVK(E=1e4, nu=0.3)
METAL = mt.J2(kappa=175e3, mu=80770.0, hardening=mt.Linear(160.0, 500.0))
TIGHT = NewtonOptions(residual=1e-12)


def bent(material=ELASTIC, **options):
    """A strip that is clamped at x0 and whose end is pushed down, with a prop under its middle."""
    model = Model(strip(10.0, 1.0, 0.3, (8, 1)), material=material)
    model.fix("x0")
    prop = model.fix(model.mesh.nodes(lambda x, y, z: np.abs(x - x.mean()) < 1e-6), "z", name="prop", **options)
    push = model.prescribe("x1_lower", "z", "push")
    return model, prop, push


@pytest.mark.parametrize("material", [ELASTIC, METAL], ids=["elastic", "plastic"])
def test_a_removed_support_leaves_its_reactions_and_the_state_in_equilibrium(material):
    model, prop, push = bent(material)
    result = solve(model, Move(push, -0.8, steps=4), options=TIGHT)
    before, reaction = model.u.copy(), result.frames[-1].points["reaction"][prop.nodes, 2]
    load = model.remove(prop)
    assert load.value == 1.0
    assert prop not in model.supports
    np.testing.assert_allclose(load.vector.reshape(-1, 3)[prop.nodes, 2], reaction, rtol=1e-9)
    held = solve(model, Move(load, 1.0, steps=1), options=TIGHT)
    np.testing.assert_allclose(model.u, before, atol=1e-12)
    assert held["iterations"][-1] <= 2
    solve(model, Move(load, 0.0, steps=6), options=TIGHT)
    free, _, push_free = bent(material)
    assert np.abs(model.u - before).max() > 0.01
    if material is ELASTIC:  # the way does not count: the same as if the prop had never been
        free.remove(free.supports[-1])
        solve(free, Move(push_free, -0.8, steps=4), options=TIGHT)
        np.testing.assert_allclose(model.u, free.u, atol=1e-8)


def test_supports_in_local_axes_and_hinges_are_removed_too():
    around = cylindrical((0.0, 0.0, -20.0), "y")
    model = Model(strip(10.0, 2.0, 0.3, (6, 2)), material=ELASTIC)
    model.fix("x0")
    roller, hinge = model.fix("x1", "r", axes=around), model.hinge("y0", "y")
    director = model.hold_director("x1", "t", axes=around)
    load = model.force("y1", (0.0, 0.1, -0.2))
    solve(model, Move(load, 1.0, steps=2), options=TIGHT)
    count = model.supports.unknown_count
    loads = [model.remove(support) for support in (hinge, roller, director)]
    assert model.supports.unknown_count > count
    assert not model.supports.rows
    residual = model.system.restrict(model.evaluate(model.u).residual)
    assert np.abs(residual).max() < 1e-9
    solve(model, Move(loads, [0.0] * 3, steps=4), options=TIGHT)
    other = Model(strip(10.0, 2.0, 0.3, (6, 2)), material=ELASTIC)
    other.fix("x0")
    solve(other, Move(other.force("y1", (0.0, 0.1, -0.2)), 1.0, steps=2), options=TIGHT)
    np.testing.assert_allclose(model.u, other.u, atol=1e-8)


@pytest.mark.parametrize("here", [True, False])
def test_a_support_is_put_back_where_the_nodes_are_or_were(here):
    model, prop, push = bent()
    model.remove(prop)
    solve(model, Move(push, -0.8, steps=4), options=TIGHT)
    before = model.u.reshape(-1, 3)[prop.nodes, 2].copy()
    model.put_back(prop, here=here)
    result = solve(model, Move(push, -1.0, steps=4), options=TIGHT)
    after = model.u.reshape(-1, 3)[prop.nodes, 2]
    np.testing.assert_allclose(after, before if here else 0.0, atol=1e-14)
    assert np.abs(before).min() > 0.01
    assert np.abs(result.frames[-1].points["reaction"][prop.nodes, 2]).max() > 1e-3


def test_a_support_in_local_axes_holds_where_the_nodes_are():
    around = cylindrical((0.0, 0.0, -20.0), "y")
    model = Model(strip(10.0, 2.0, 0.3, (6, 2)), material=ELASTIC)
    model.fix("x0")
    load = model.force("x1", (0.0, 0.0, -0.2))
    solve(model, Move(load, 1.0, steps=2), options=TIGHT)
    nodes = model.mesh.nodes("x1")
    radial = around.at(model.positions[nodes])[:, 0]
    way = np.einsum("nk,nk->n", model.u.reshape(-1, 3)[nodes], radial)
    model.fix("x1", "r", axes=around, here=True)
    model.hinge("y0", "y", here=True)
    solve(model, Move(load, 0.0, steps=2), options=TIGHT)
    np.testing.assert_allclose(np.einsum("nk,nk->n", model.u.reshape(-1, 3)[nodes], radial), way, atol=1e-12)
    assert np.abs(way).max() > 0.1


def test_a_step_frees_a_support_within_a_run():
    model, prop, push = bent()
    result = solve(model, [Move(push, -0.8, steps=4), Free(prop, steps=6)], options=TIGHT)
    np.testing.assert_allclose(result["prop"], [0, 0, 0, 0, 0, *np.linspace(1, 0, 7)[1:]], atol=1e-12)
    assert result.balance().force_imbalance.max() < 1e-9
    assert np.abs(result.balance().drift).max() < 5e-3
    other, another, push_other = bent()
    solve(other, Move(push_other, -0.8, steps=4), options=TIGHT)
    solve(other, Move(other.remove(another), 0.0, steps=6), options=TIGHT)
    np.testing.assert_allclose(model.u, other.u, atol=1e-11)
    solve(model, Move(push, 0.0, steps=4), options=TIGHT)  # and the run goes on without it
    np.testing.assert_allclose(model.u, 0.0, atol=1e-7)


@pytest.mark.parametrize("stop", [3, 6, 9])
def test_a_run_that_frees_a_support_is_taken_up_to_the_last_bit(tmp_path, stop):
    def run(path, until=None):
        model, prop, push = bent(METAL)
        steps = [Move(push, -0.8, steps=4), Free(prop, steps=4), Move(push, -1.0, steps=2)]
        if until is None:
            return model, solve(model, steps, frames=2)
        count = [0]

        def interrupt(_):
            count[0] += 1
            if count[0] == until:
                raise KeyboardInterrupt

        original = model.system.commit
        model.system.commit = lambda u: (original(u), interrupt(u))
        with pytest.raises(KeyboardInterrupt):
            solve(model, steps, frames=2, checkpoint=path, every=0.0)
        model, prop, push = bent(METAL)
        steps = [Move(push, -0.8, steps=4), Free(prop, steps=4), Move(push, -1.0, steps=2)]
        return model, resume(path, model, steps, frames=2)

    model, whole = run(None)
    again, taken_up = run(tmp_path / "run.checkpoint", stop)
    np.testing.assert_array_equal(model.u, again.u)
    for column in whole.columns():
        np.testing.assert_array_equal(whole[column], taken_up[column])
    for one, other in zip(whole.frames, taken_up.frames, strict=True):
        for name, values in one.points.items():
            np.testing.assert_array_equal(values, other.points[name])


def test_a_snapshot_knows_which_supports_act():
    model, prop, push = bent()
    solve(model, [Move(push, -0.4, steps=2), Free(prop, steps=2)], options=TIGHT)
    freed = model.system.snapshot()
    u, count = model.u.copy(), model.supports.unknown_count
    model.put_back(prop)
    solve(model, Move(push, -0.6, steps=2), options=TIGHT)
    model.system.restore(freed)
    assert prop.removed
    assert model.supports.unknown_count == count
    np.testing.assert_array_equal(model.u, u)
    solve(model, Move(push, 0.0, steps=2), options=TIGHT)
    np.testing.assert_allclose(model.u, 0.0, atol=1e-7)


def test_a_tool_is_taken_away_and_its_force_fades():
    """A strip held down by a stamp springs back to what it is without one."""
    model = Model(strip(10.0, 1.0, 0.3, (8, 1)), material=ELASTIC)
    model.fix("x0")
    stamp = model.contact("upper", Cylinder((9.0, 0.0, 1.15), "y", 1.0), name="stamp", penalty=1e4)
    down = model.drive(stamp, "-z", "down")
    solve(model, Move(down, 0.5, steps=5), options=TIGHT)
    before = model.u.copy()
    load = model.remove(stamp)
    assert not model.contacts
    assert down not in model.controls
    force = load.vector.reshape(-1, 3).sum(axis=0)
    assert force[2] < -1e-3
    solve(model, Move(load, 1.0, steps=1), options=TIGHT)
    np.testing.assert_allclose(model.u, before, atol=1e-10)
    result = solve(model, Move(load, 0.0, steps=4), options=TIGHT)
    np.testing.assert_allclose(model.u, 0.0, atol=1e-8)
    assert "stamp_fz" not in result.columns()


def test_to_remove_what_is_not_there_is_refused():
    model, prop, push = bent()
    other, its_prop, _ = bent()
    with pytest.raises(InvalidValue, match="no such support"):
        model.remove(its_prop)
    model.remove(prop)
    with pytest.raises(InvalidValue, match="no such support"):
        model.remove(prop)
    model.put_back(prop)
    with pytest.raises(InvalidValue, match="has not been removed"):
        model.put_back(prop)
    with pytest.raises(InvalidValue, match="does not have then"):
        solve(other, Free(prop))
    with pytest.raises(InvalidValue, match="does not have then"):
        solve(model, [Free(prop), Free(prop)])
    with pytest.raises(InvalidValue, match="takes a support"):
        Free(push)
    with pytest.raises(InvalidValue, match="whole number"):
        Free(prop, steps=0)
    plate = model.contact("upper", Plane((0, 0, 0.15), "-z"), name="plate")
    model.remove(plate)
    with pytest.raises(InvalidValue, match="no such contact"):
        model.remove(plate)


def test_put_back_is_refused_where_something_else_moves_the_nodes():
    model, prop, _ = bent()
    model.remove(prop)
    drive = model.prescribe(prop.nodes, "z", "drive")
    with pytest.raises(InvalidValue, match="prescribed twice"):
        model.put_back(prop)
    assert prop.removed
    solve(model, Move(drive, -0.1, steps=1))


# A motion that nothing holds ---------------------------------------------------------------------------------


def test_a_part_without_supports_is_named_before_the_run():
    model, _, push = bent()
    model.remove(model.supports[0])
    with pytest.raises(RigidBodyMotion, match="translation x"):
        solve(model, Move(push, -0.1))


def test_a_sheet_that_leaves_its_tools_is_told_what_is_free():
    model = Model(strip(20.0, 2.0, 1.0, (10, 1)), material=ELASTIC)
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    above = model.contact("upper", Plane((0.0, 0.0, 0.5), "-z"), penalty=1e3, name="above")
    model.contact("lower", Plane((0.0, 0.0, -0.5), "z"), penalty=1e3, name="below")
    down = model.drive(above, "-z", "down")
    solve(model, Move(down, 0.02, steps=2))
    with pytest.raises(NoConvergence) as caught:
        solve(model, Move(down, -0.5, steps=5))
    text = str(caught.value)
    assert "tools alone hold the sheet" in text
    assert "translation z" in text
    assert "three points" in text
    assert "buckling" not in text


def test_where_supports_hold_the_sheet_the_error_is_about_the_increment():
    model, _, push = bent()
    with pytest.raises(NoConvergence) as caught:
        solve(model, Move(push, -8.0, steps=1, cuts=0), options=NewtonOptions(max_iterations=1))
    assert "tools alone" not in str(caught.value)
    assert "buckling" in str(caught.value)
