"""A run that is taken step by step, and goes back: the same bits as a run of the steps that are left."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import umform as uf
from umform.analysis.run.open_run import OpenRun
from umform.errors import InvalidValue, NoConvergence
from umform.results.records import Cause


def strip():
    mesh = uf.mesh.strip(length=20.0, width=2.0, thickness=1.0, cells=(8, 1))
    steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=160.0, modulus=500.0))
    model = uf.Model(mesh, material=steel)
    model.symmetry("x0", normal="x")
    model.fix("y0", "y")
    punch = model.prescribe("x0_lower", "z", name="punch")
    model.contact("lower", uf.Cylinder(centre=(12.0, 0.0, -10.5), axis="y", radius=10.0), penalty=1e3, points=2)
    return model, punch


def same(one, other):
    assert one.columns() == other.columns()
    for name in one.columns():
        np.testing.assert_array_equal(one[name], other[name])
    assert one.events == other.events
    assert [frame.number for frame in one.frames] == [frame.number for frame in other.frames]
    np.testing.assert_array_equal(one.model.u, other.model.u)


def test_steps_one_by_one_are_a_run():
    model, punch = strip()
    steps = [uf.Move(punch, to=-0.4, steps=4), uf.Move(punch, to=-0.9, steps=3), uf.Release(punch)]
    straight = uf.solve(model, steps, progress=False)
    model, punch = strip()
    run = OpenRun(model)
    for step in (uf.Move(punch, to=-0.4, steps=4), uf.Move(punch, to=-0.9, steps=3), uf.Release(punch)):
        run.take(step)
    same(run.close(), straight)
    assert run.result.timing.run.calls == straight.timing.run.calls


@pytest.mark.parametrize("order", [1, 2])
def test_a_branch_that_is_left_leaves_no_trace(order):
    model, punch = strip()
    steps, options = (
        [uf.Move(punch, to=-0.4, steps=4), uf.Move(punch, to=-0.7, steps=3)],
        uf.NewtonOptions(extrapolate=order),
    )
    straight = uf.solve(model, steps, options=options, progress=False)
    model, punch = strip()
    run = OpenRun(model, options=options)
    run.take(uf.Move(punch, to=-0.4, steps=4))
    mark = run.mark()
    for _ in range(2):
        run.take(uf.Move(punch, to=-1.2, steps=6), uf.Release(punch))
        run.go_back(mark)
        assert len(run.steps) == 1
        assert len(run.result) == 5
    run.take(uf.Move(punch, to=-0.7, steps=3))
    later = run.mark()
    run.go_back(mark)
    run.take(uf.Release(punch))
    run.go_back(later)  # from another branch
    same(run.close(), straight)
    assert run.iterations > run.result["iterations"].sum()  # those of the branches count


@pytest.mark.parametrize("what", ["support", "tool"])
def test_back_before_a_step_that_frees(what):
    """The support acts again, the tool is closed again, and all rows have the columns of their forces."""

    def built():
        model, punch = strip()
        return model, punch, model.fix("x1_upper", "y") if what == "support" else model.tools[0]

    model, punch, thing = built()
    straight = uf.solve(model, [uf.Move(punch, to=-0.9, steps=4), uf.Free(thing, steps=2)], progress=False)
    model, punch, thing = built()
    run = OpenRun(model)
    run.take(uf.Move(punch, to=-0.9, steps=4))
    mark = run.mark()
    for steps in (3, 2):
        run.go_back(mark)
        run.take(uf.Free(thing, steps=steps))
    same(run.close(), straight)


def test_a_mark_of_another_run_is_refused():
    runs = [OpenRun(strip()[0]) for _ in range(2)]
    for mark in (runs[0].mark(), None):
        with pytest.raises(InvalidValue, match="a mark of its own"):
            runs[1].go_back(mark)


def test_what_ends_a_step_has_what_was_reached():
    model, punch = strip()
    run = OpenRun(model)
    run.take(uf.Move(punch, to=-0.2, steps=2))
    with pytest.raises(NoConvergence) as ended:
        run.take(uf.Move(punch, to=lambda fraction: -0.2 - 1e6 * fraction, steps=1, cuts=0))
    assert ended.value.result is run.result
    assert len(run.result) == 3


def test_what_was_learnt_on_a_branch_is_forgotten_on_the_way_back():
    model, punch = strip()
    run = OpenRun(model)
    run.take(uf.Move(punch, to=-0.4, steps=4))
    mark, statistics = run.mark(), replace(run._run.statistics)
    run._run.statistics.record(failed={"extrapolation": Cause.STALL}, won="tangent", negative_pivots=1)
    run._run.statistics.begin_last_attempt()
    run._run.statistics.count_penetration(kept=False)
    run._run.statistics.record_cut({"softer penalties": Cause.STALL})
    assert all(vars(run._run.statistics)[name] != value for name, value in vars(statistics).items())
    run.go_back(mark)
    assert run._run.statistics == statistics
