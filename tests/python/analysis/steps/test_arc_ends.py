"""How arcs end and fail: told to, at their last increment, halved, interrupted, refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

import umform
from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Arc, Move, Release
from umform.errors import InvalidValue, NoConvergence
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import Cylinder, Plane

TIGHT = NewtonOptions(residual=1e-12)


def test_an_arc_ends_when_it_is_told_to(build):
    model, load = build.loaded_arch()
    top = 3 * model.mesh.nodes("x0") + 2
    result = solve(model, Arc(load, 0.1, until=lambda m: m.u[top].mean() < -0.5), frames=0)
    assert -0.7 < model.u[top].mean() < -0.5
    assert load.value == result["load"][-1] < 0.1
    assert "as asked" in result.events[-1]
    model, load = build.loaded_arch()
    result = solve(model, Arc(load, 0.1, most=3), frames=0)
    assert len(result) == 4
    assert "after 3 increments" in result.warnings[-1]


@pytest.fixture
def failing(monkeypatch):
    """Let the corrections from a number on run out of iterations or into an interrupt."""
    original = Newton.correct

    def install(numbers, error=None):
        calls = []

        def correct(self, *arguments):
            calls.append(arguments[0].time)
            if len(calls) not in numbers:
                return original(self, *arguments)
            options, self.options = self.options, NewtonOptions(residual=1e-300, increment=1e-300, max_iterations=2)
            try:
                original(self, *arguments)
                raise error
            finally:
                self.options = options
                if error is not None:
                    raise error

        monkeypatch.setattr(Newton, "correct", correct)
        return calls

    return install


def test_a_failed_increment_is_halved_and_leaves_no_trace(failing, build):
    model, load = build.loaded_arch(element="EAS3DEAS")
    failing([3])
    step = Arc(load, 0.1, increment=0.05, grow=1.0, iterations=25, most=4)
    result = solve(model, step, options=TIGHT, frames=0)
    np.testing.assert_allclose(np.diff(result["time"]), [0.05, 0.05, 0.025, 0.05], rtol=1e-9)
    other, moved = build.loaded_arch(element="EAS3DEAS")
    solve(other, [Move(moved, v, steps=1) for v in result["load"][1:]], options=TIGHT, frames=0)
    np.testing.assert_allclose(model.u, other.u, atol=1e-8)
    np.testing.assert_allclose(model.bodies.only.block.alpha, other.bodies.only.block.alpha, atol=1e-8)


@pytest.mark.parametrize("error", [None, KeyboardInterrupt("stop")])
def test_a_path_that_fails_or_is_interrupted_leaves_its_last_converged_state(failing, error, build, same_state):
    model, load = build.loaded_arch(element="EAS3DEAS")
    solve(model, Arc(load, 0.1, increment=0.2, most=4), frames=0)
    before, time = model.system.snapshot(), model.system.time
    residual = model.evaluate(model.u).residual
    failing(range(1, 100), error)
    with pytest.raises(NoConvergence if error is None else KeyboardInterrupt) as caught:
        solve(model, Arc(load, 0.1, increment=0.2, cuts=3), frames=0)
    assert same_state(model.system.snapshot(), before)
    assert model.system.time == time
    np.testing.assert_array_equal(model.evaluate(model.u).residual, residual)
    assert len(caught.value.result) == 1
    if error is None:
        assert "smallest arc length" in str(caught.value)
        assert "load = " in caught.value.where


def test_what_a_users_function_breaks_off_is_kept(build):
    model, load = build.loaded_arch()

    def broken(model):
        if load.value > 0.015:
            raise RuntimeError("broken")
        return False

    with pytest.raises(RuntimeError, match="broken") as caught:
        solve(model, Arc(load, 0.1, until=broken), frames=0)
    assert caught.value.result["load"][-1] == load.value > 0.015


def test_a_path_that_cannot_be_started_says_so(build):
    model, pull = build.bar(material=mt.NeoHooke(E=100.0, nu=0.3))
    model.u[3 * model.mesh.nodes("x1")] = -1.0  # pressed to nothing
    with pytest.raises(NoConvergence, match="at its beginning"):
        solve(model, Arc(pull, 0.1), frames=0)


def test_a_tool_that_does_not_touch_cannot_be_followed(build):
    model, _ = build.cantilever()
    contact = model.contact("upper", Plane((0.0, 0.0, 0.2), "-z"), penalty=100.0)
    with pytest.raises(InvalidValue, match="do not move the sheet"):
        solve(model, Arc(model.drive(contact, "-z"), 0.4), frames=0)


def test_a_path_ends_where_a_tool_lifts_off(build):
    """A tool can push the arch down to where it is flat; from there it would have to pull."""
    model = build.arch()
    contact = model.contact("upper", Cylinder((0.0, 0.0, 2.94), "y", 2.0), penalty=50.0, name="punch")
    down = model.drive(contact, "-z", "down")
    with pytest.raises(NoConvergence) as caught:
        solve(model, Arc(down, 1.5), frames=0)
    result = caught.value.result
    assert -0.6 < model.u[3 * model.mesh.nodes("x0") + 2].mean() < -0.5
    assert 0.0 < result["punch_fz"][-1] < 0.1 * result["punch_fz"].max()


def test_an_arc_that_moves_nothing_is_refused(build):
    model, load = build.loaded_arch()
    with pytest.raises(InvalidValue, match="a control that moves"):
        solve(model, Arc(load, 0.0))


@pytest.mark.parametrize(
    "arguments",
    [
        {"to": math.nan},
        {"to": [1.0, 2.0]},
        {"to": 1.0, "increment": 0.0},
        {"to": 1.0, "increment": 2.0},
        {"to": 1.0, "kind": "elliptic"},
        {"to": 1.0, "grow": 0.5},
        {"to": 1.0, "most": 0},
        {"to": 1.0, "iterations": 1.5},
    ],
)
def test_arcs_that_make_no_sense_are_refused(build, arguments):
    _, pull = build.bar()
    with pytest.raises(InvalidValue):
        Arc(pull, **arguments)


def test_an_arc_is_a_step_among_others(build):
    assert umform.Arc is Arc
    model = build.arch()
    push = model.prescribe("x0", "z", "push")
    result = solve(model, [Arc(push, -0.2), Move(push, -0.3, steps=2), Release(push)], frames=0)
    np.testing.assert_array_equal(np.unique(result["step"]), [0, 1, 2, 3])
    assert abs(push.value) < 1e-3


def _pulled():
    bar = strip(10.0, 2.0, 1.0, (2, 1))
    metal = mt.Metal(206e3, 0.3, hardening=mt.Linear(200.0, 1000.0), rate=mt.CowperSymonds(40.0, 5.0))
    model = Model(bar, "ANS3DEAS", material=metal, thickness_order=1, thickness_points=2)
    model.fix("x0")
    return model, model.prescribe("x1", "x", "pull")


def test_the_time_of_an_arc_is_felt_by_a_metal_with_a_rate():
    forces = {}
    for time in (1e3, 1.0, 1e-3):
        model, pull = _pulled()
        result = solve(model, Arc(pull, 0.2, increment=0.2, grow=1.0, time=time), options=TIGHT, frames=0)
        np.testing.assert_allclose(np.diff(result["time"])[:2], 0.2 * time, rtol=1e-10)
        other, moved = _pulled()
        steps = [
            Move(moved, value, steps=1, time=took)
            for value, took in zip(result["pull"][1:], np.diff(result["time"]), strict=True)
        ]
        again = solve(other, steps, options=TIGHT, frames=0)
        np.testing.assert_allclose(result["pull_force"], again["pull_force"], rtol=1e-9)
        forces[time] = result["pull_force"][-1]
    assert forces[1e-3] > 1.05 * forces[1.0] > 1.05**2 * forces[1e3]


@pytest.mark.parametrize("time", [0.0, -1.0, np.inf])
def test_an_arc_that_takes_no_time_is_refused(time):
    _, pull = _pulled()
    with pytest.raises(InvalidValue, match="must be positive"):
        Arc(pull, 0.2, time=time)
