"""Steps: moving, cutting, growing, releasing, failing; and what is left behind."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import Result, solve
from umform.analysis.steps import Move, Release
from umform.errors import InvalidValue, NoConvergence
from umform.history_variables import history_of
from umform.materials.user_law import UserLaw
from umform.mesh import strip
from umform.model import Model, System
from umform.model.terms.control import Prescribed
from umform.results.records import Cause, Failed
from umform.solvers import pardiso
from umform.surfaces import Plane, UserSurface

J2 = mt.J2(kappa=175000.0, mu=80770.0, hardening=mt.Linear(160.0, 500.0))
TIGHT = NewtonOptions(residual=1e-12)
#: The consistent tangent alone: an increment that fails with it is not tried with another one.
ONE_TRY = NewtonOptions(mixed=False)


@pytest.fixture
def failing(monkeypatch):
    """Let chosen calls of Newton's method run out of iterations, in the middle of their work."""
    original = Newton.solve

    def install(*numbers, max_iterations=2):
        calls = []

        def solve_or_fail(self, goal, extrapolation=None, mode=None, beyond=None, keep=False):
            calls.append(goal.time)
            options = self.options
            if len(calls) in numbers:
                self.options = replace(options, max_iterations=max_iterations, residual=1e-300, increment=1e-300)
            try:
                return original(self, goal, extrapolation, mode, beyond, keep)
            finally:
                self.options = options

        monkeypatch.setattr(Newton, "solve", solve_or_fail)
        return calls

    return install


def test_a_move_makes_its_increments_and_keeps_its_books(build):
    model, pull = build.bar()
    result = solve(model, [Move(pull, 0.1, steps=4), Move(pull, 0.05, steps=2)], frames=0)
    assert isinstance(result, Result)
    np.testing.assert_allclose(result["pull"], [0, 0.025, 0.05, 0.075, 0.1, 0.075, 0.05], atol=1e-15)
    np.testing.assert_allclose(result["time"], [0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0], atol=1e-15)
    np.testing.assert_array_equal(result["step"], [0, 1, 1, 1, 1, 2, 2])
    np.testing.assert_array_equal(result["iterations"], [len(records) for records in result.iterations])
    assert result["pull_force"][4] > result["pull_force"][6] > 0
    assert model.system.time == 2.0
    assert pull.value == 0.05
    np.testing.assert_allclose(model.u[pull.dofs], 0.05)


def test_a_move_follows_functions_and_several_controls(build):
    model, pull = build.bar()
    push = model.prescribe("y1", "y", "push")
    step = Move([pull, push], [lambda f: 0.1 * math.sin(math.pi * f), -0.02], steps=4)
    result = solve(model, step, frames=0)
    np.testing.assert_allclose(result["pull"], 0.1 * np.sin(np.pi * np.arange(5) / 4), atol=1e-15)
    np.testing.assert_allclose(result["push"], -0.005 * np.arange(5), atol=1e-15)


def test_a_load_driven_step_meets_the_closed_form(build):
    """Uniaxial neo-Hooke with nu = 0: the nominal stress of the stretch that a load of 50 makes."""
    free = Model(build.bar()[0].mesh, material=mt.NeoHooke(E=100.0, nu=0.0))
    for face, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        free.symmetry(face, normal=normal)
    load = free.traction("x1", (1.0, 0.0, 0.0), "load")
    result = solve(free, Move(load, 50.0, steps=5), frames=0)
    stretch = 1.0 + free.u.reshape(-1, 3)[free.mesh.nodes("x1"), 0].mean()
    assert 50.0 * (stretch - 1 / stretch) == pytest.approx(50.0, rel=1e-8)  # mu = 50, no lateral strain
    np.testing.assert_allclose(result["load"], [0, 10, 20, 30, 40, 50])
    np.testing.assert_array_equal(result["load_force"], result["load"])


def test_extrapolation_changes_the_iterations_and_not_the_answer(build):
    def run(extrapolate):
        case = build.free_bending((8, 1))
        options = NewtonOptions(residual=1e-12, extrapolate=extrapolate)
        result = solve(case.model, Move(case.punch, -2.0, steps=10), options=options, frames=0)
        return case.model.u, result["iterations"]

    (with_it, fewer), (without, more) = run(True), run(False)
    np.testing.assert_allclose(with_it, without, atol=1e-7)
    assert (fewer != more).any()


def test_a_cut_step_meets_the_run_with_the_same_increments_and_leaves_no_trace(build, failing):
    def run():
        case = build.free_bending((8, 1), "EAS3DEAS", membrane_modes=4)
        return case.model, case.punch

    model, punch = run()
    calls = failing(*range(2, 5))  # the second increment: extrapolation, tangent, softer penalties
    result = solve(model, Move(punch, -2.0, steps=4), options=TIGHT, frames=0)
    failing()
    assert calls[:6] == [0.25, *3 * [0.5], 0.375, 0.5]
    np.testing.assert_allclose(result["time"][:4], [0, 0.25, 0.375, 0.5])
    assert result["time"][-1] == 1.0
    other, control = run()
    same = [Move(control, value, steps=1) for value in result["punch"][1:]]
    expected = solve(other, same, options=TIGHT, frames=0)
    np.testing.assert_allclose(result["punch_force"], expected["punch_force"], rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(model.u, other.u, atol=1e-8)
    np.testing.assert_allclose(model.bodies.only.block.state, other.bodies.only.block.state, atol=1e-9)
    np.testing.assert_allclose(model.bodies.only.block.alpha, other.bodies.only.block.alpha, atol=1e-9)


def test_a_failed_attempt_leaves_the_converged_state_bit_by_bit(build, failing, same_state):
    case = build.free_bending((8, 1), "EAS3DEAS")
    solve(case.model, Move(case.punch, -1.0, steps=4), frames=0)
    before = case.model.system.snapshot()
    residual = case.model.evaluate(case.model.u).residual
    failing(*range(1, 20))
    with pytest.raises(NoConvergence):
        solve(case.model, Move(case.punch, -2.0, steps=2, cuts=3), frames=0)
    assert same_state(case.model.system.snapshot(), before)
    np.testing.assert_array_equal(case.model.evaluate(case.model.u).residual, residual)


def test_a_cut_is_counted_from_the_nominal_increment(build, failing):
    model, pull = build.bar()
    calls = failing(*range(1, 100))
    with pytest.raises(NoConvergence):
        solve(model, Move(pull, 0.1, steps=2, cuts=3), options=ONE_TRY, frames=0)
    assert calls == [0.5, 0.25, 0.125, 0.0625]


@pytest.mark.parametrize(
    ("fail", "grow", "expected"),
    [
        ((2, 3), 1.0, [0.25, 0.375, 0.5, 0.625, 0.75, 1.0]),
        ((2, 3, 4), 1.0, [0.25, 0.3125, 0.375, 0.4375, 0.5, 0.625, 0.75, 1.0]),
        ((2, 3), 2.0, [0.25, 0.375, 0.5, 0.625, 0.75, 1.0]),
    ],
)
def test_after_a_cut_the_nominal_marks_are_met_again_and_the_increments_grow_back(build, failing, fail, grow, expected):
    """The second increment fails with the extrapolation and then from the tangent; one more failure cuts it again."""
    model, pull = build.bar()
    calls = failing(*fail)
    result = solve(model, Move(pull, 0.1, steps=4, grow=grow), options=ONE_TRY, frames=0)
    assert len(calls) == len(expected) + len(fail)
    np.testing.assert_allclose(result["time"][1:], expected, atol=1e-14)
    np.testing.assert_allclose(result["pull"], 0.1 * result["time"], atol=1e-15)
    assert result["time"][-1] - result["time"][-2] == pytest.approx(0.25)  # the nominal size


def test_a_cut_on_the_way_to_a_mark_is_one_of_that_way(build, failing):
    """Back at its nominal size, an increment shortened to meet a mark fails: half of what was tried comes next.

    It had grown before: six easy increments, not three, are asked for before it grows again.
    """
    model, pull = build.bar()
    calls = failing(2, 3, 7, 8)
    result = solve(model, Move(pull, 0.1, steps=4), options=ONE_TRY, frames=0)
    assert calls[:10] == pytest.approx([0.25, 0.5, 0.5, 0.375, 0.5, 0.625, 0.75, 0.75, 0.6875, 0.75])
    np.testing.assert_allclose(result["time"][5:], [0.6875, 0.75, 0.8125, 0.875, 0.9375, 1.0], atol=1e-14)


def test_a_size_that_fails_in_the_second_increment_after_it_had_grown_is_not_tried_again_soon(build, failing):
    model, pull = build.bar()
    failing(2, 3, 9, 10)  # on the way from 0.1 to 0.2, and from 0.4 to 0.5
    result = solve(model, Move(pull, 0.1, steps=10), options=ONE_TRY, frames=0)
    expected = [0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.8, 0.9, 1.0]
    np.testing.assert_allclose(result["time"][1:], expected, atol=1e-14)


@pytest.mark.parametrize(("cuts", "tried"), [(0, 1), (1, 2), (2, 2), (3, 3)])
def test_softer_penalties_rest_after_a_miss_but_not_before_the_run_is_given_up(build, monkeypatch, cuts, tried):
    case = build.free_bending((8, 1))
    solve(case.model, Move(case.punch, -1.0, steps=4), frames=0)

    def fail(self, goal, extrapolation=None, mode=None, beyond=None, keep=False):
        raise Failed("no", [], Cause.STALL)

    monkeypatch.setattr(Newton, "solve", fail)
    with pytest.raises(NoConvergence) as ended:
        solve(case.model, Move(case.punch, -2.0, steps=1, cuts=cuts), frames=0)
    attempts = ended.value.result.timing.attempts
    assert attempts.tried["tangent"] == cuts + 1
    assert attempts.tried["softer penalties"] == tried


def test_increments_grow_up_to_their_limit_while_newton_is_at_ease(build):
    model, pull = build.bar()
    result = solve(model, Move(pull, 0.2, steps=40, grow=4.0), frames=0)
    sizes = np.diff(result["time"]) * 40
    assert sizes[0] == pytest.approx(1.0)
    assert sizes.max() == pytest.approx(4.0)
    assert len(result) < 25
    assert result["pull"][-1] == pytest.approx(0.2, rel=1e-15)
    steady, control = build.bar()
    expected = solve(steady, Move(control, 0.2, steps=40), frames=0)
    assert len(expected) == 41
    assert result["pull_force"][-1] == pytest.approx(expected["pull_force"][-1], rel=1e-8)


@pytest.mark.parametrize("frames", [0, 1, 4, 60])
def test_frames_are_kept_about_as_often_as_asked(build, frames):
    model, pull = build.bar()
    result = solve(model, Move(pull, 0.2, steps=20), frames=frames)
    numbers = [frame.number for frame in result.frames]
    expected = {0: [], 1: [0, 20], 4: [0, 5, 10, 15, 20], 60: list(range(21))}[frames]
    assert numbers == expected
    assert len(result) == 21


@pytest.mark.parametrize(
    "arguments",
    [
        {"to": 1.0, "steps": 0},
        {"to": math.nan},
        {"to": math.inf},
        {"to": 1.0, "grow": 0.5},
        {"to": 1.0, "grow": math.nan},
        {"to": [1.0, 2.0]},
    ],
)
def test_moves_that_make_no_sense_are_refused(build, arguments):
    _, pull = build.bar()
    with pytest.raises(InvalidValue):
        Move(pull, **arguments)


# Release ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("increment", [None, 1e-4])
def test_release_finds_the_permanent_set_of_a_bar(build, increment):
    """Stretched to 1.2, the bar keeps exp(eqps): elastic and plastic logarithmic strains add."""
    model, pull = build.bar(material=J2)
    result = solve(model, [Move(pull, 0.2, steps=10), Release(pull, increment=increment)], frames=0)
    peak = np.abs(result["pull_force"]).max()
    assert abs(result["pull_force"][-1]) <= 1e-6 * peak
    assert pull.value == pytest.approx(math.exp(0.1811284) - 1, abs=2e-7)
    np.testing.assert_allclose(history_of(model.bodies.only.block)["eqps"], 0.1811284, atol=5e-8)
    assert (np.diff(result["pull"][10:]) < 0).all()
    assert (np.diff(result["time"]) > 0).all()


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9])
@pytest.mark.parametrize("increment", [1e-4, 1e-3, 5e-3, 1e-2])
def test_release_that_crosses_zero_closes_in_on_it(build, monkeypatch, increment, tolerance):
    """Without contact there is no lift-off: only the zero of the force ends the step, however large the increment."""
    model, pull = build.bar(material=J2)
    crossings, restore = [], System.restore

    def counted(self, snapshot):
        crossings.append(snapshot.time)
        restore(self, snapshot)

    monkeypatch.setattr(System, "restore", counted)
    step = Release(pull, increment=increment, tolerance=tolerance)
    result = solve(model, [Move(pull, 0.2, steps=10), step], frames=0)
    assert crossings
    assert abs(result["pull_force"][-1]) <= tolerance * result["pull_force"].max()
    assert (result["pull_force"][10:-1] > 0).all()
    assert pull.value == pytest.approx(math.exp(0.1811284) - 1, abs=2e-7)
    assert (np.diff(result["time"]) > 0).all()


@pytest.mark.timeout(60)
def test_release_of_a_force_that_jumps_over_zero_is_given_up(build, monkeypatch):
    model, pull = build.bar()
    force = Prescribed.force
    monkeypatch.setattr(
        Prescribed, "force", lambda self, *at: force(self, *at) + (1.0 if pull.value > 0.0123 else -1e4)
    )
    with pytest.raises(NoConvergence) as caught:
        solve(model, [Move(pull, 0.05, steps=2), Release(pull)], frames=0)
    assert "cannot be closed in" in caught.value.cause
    assert pull.value == pytest.approx(0.0123, abs=1e-6)
    np.testing.assert_array_equal(model.u[pull.dofs], pull.value)


def test_release_of_an_elastic_bar_goes_back_to_where_it_came_from(build):
    model, pull = build.bar()
    solve(model, [Move(pull, 0.2, steps=4), Release(pull)], frames=0)
    assert pull.value == pytest.approx(0.0, abs=1e-6)
    assert np.abs(model.u).max() < 1e-6


def test_release_of_a_compressed_bar(build):
    model, pull = build.bar(material=J2)
    result = solve(model, [Move(pull, -0.1, steps=10), Release(pull)], frames=0)
    assert result["pull_force"].min() < -1.0
    assert abs(result["pull_force"][-1]) <= 1e-6 * np.abs(result["pull_force"]).max()
    assert -0.1 < pull.value < -0.09


@pytest.mark.parametrize(("element", "points"), [("ANS3DEAS", 2), ("ANS3DEAS", "nodes"), ("MI9K3DEAS", 3)])
def test_release_of_a_bent_strip_ends_at_lift_off(build, element, points):
    case = build.free_bending((12, 1), element, points)
    result = solve(case.model, [Move(case.punch, -6.0, steps=24), Release(case.punch)], frames=0)
    peak = np.abs(result["punch_force"]).max()
    assert abs(result["punch_force"][-1]) <= 1e-6 * peak
    assert -6.0 < case.punch.value < -0.5  # springback, but not all the way
    # The last state but one still pushed, and the last way was a bracket around lift-off.
    assert result["tool_active"][-2] > 0
    if result["tool_active"][-1] == 0:
        assert abs(result["punch"][-1] - result["punch"][-2]) <= 3e-6 * 6.0


def test_lift_off_of_a_pressed_block_is_where_it_touched(build):
    model = Model(strip(1.0, 1.0, 0.5, (1, 1)), material=mt.NeoHooke(E=1000.0, nu=0.3))
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    press = model.prescribe("upper", "z", "press")
    model.contact("lower", Plane((0, 0, -0.25)), penalty=1e4, name="die")
    result = solve(model, [Move(press, -0.05, steps=4), Release(press)], frames=0)
    assert result["die_fz"][4] < -10
    assert press.value == pytest.approx(0.0, abs=3e-7)
    assert abs(result["press_force"][-1]) < 1e-5 * abs(result["press_force"][4])


def test_a_tool_is_released_too(build):
    case = build.free_bending((8, 1))
    ram = case.model.drive(case.contact, "z", "ram")
    result = solve(case.model, [Move(ram, 3.0, steps=12), Release(ram)], frames=0)
    assert result["ram_force"][12] > 5
    assert abs(result["ram_force"][-1]) <= 1e-6 * abs(result["ram_force"][12])
    assert 0.0 < ram.value < 3.0


def test_there_must_be_something_to_release(build):
    model, pull = build.bar()
    result = solve(model, Release(pull), frames=0)
    assert len(result) == 1
    assert "nothing to release" in result.events[0]


def test_lift_off_and_zero_force_are_told_apart(build):
    """Also when a tool stands by that the bar never touches."""
    model, pull = build.bar()
    model.contact("lower", Plane((0, 0, -100.0)), penalty=100.0)
    result = solve(model, [Move(pull, 0.2, steps=10), Release(pull)], frames=0)
    assert abs(result[f"{pull.name}_force"][-1]) <= 1e-6 * abs(result[f"{pull.name}_force"]).max()
    assert "the force is zero" in result.events[-2] and "never touched" in result.events[-1]

    case = build.free_bending((8, 1))
    result = solve(case.model, [Move(case.punch, -5.0, steps=10), Release(case.punch, tolerance=1e-9)], frames=0)
    assert "contact has lifted off" in result.events[-1]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda pull: Move([pull, pull], [0.1, 0.2], 2), "a step moves a control once"),
        (lambda pull: Move(pull, lambda fraction: "a", 2), "the function that moves pull is not finite"),
        (lambda pull: Move("pull", 0.1, 2), r"prescribe\(\), force\(\)"),
        (lambda pull: Move(pull, [0.1, 0.2], 2), r"Move, to[\s\S]*1 controls, 2 targets[\s\S]*a step for each value"),
        (lambda pull: Move(pull, [math.nan], 2), r"Move, to[\s\S]*nan[\s\S]*lambda"),
        (lambda pull: Move(pull, 1e300, 2), r"beyond 1e\+50"),
        (lambda pull: Move(pull, 0.1, 2, follow={pull: [(0.0, 1e300)]}), r"beyond 1e\+50"),
        (lambda pull: Move([], [], 2, follow={pull: [(0.0, 1.0)]}), "a step moves a control once"),
        (lambda pull: Move(pull, 0.1, 2, follow={"pull": [(0.0, 1.0)]}), "followers are controls"),
        (lambda pull: Move(pull, 0.1, 2, follow={pull: "text"}), "a table of pairs"),
        (lambda pull: None, "a run has a step"),
        (lambda pull: Move, "a run has a step"),
    ],
)
def test_steps_that_make_no_sense_are_refused(build, wrong, message):
    model, pull = build.bar()
    with pytest.raises(InvalidValue, match=message):
        solve(model, wrong(pull), frames=0)


def test_a_function_that_fails_names_its_control(build):
    model, pull = build.bar()
    with pytest.raises(TypeError) as caught:
        solve(model, Move(pull, lambda: 1.0, 2), frames=0)
    assert "in the function that moves pull, called as function(0.5)" in caught.value.__notes__


def test_a_control_of_another_model_is_refused(build):
    model, _ = build.bar()
    _, other = build.bar()
    with pytest.raises(InvalidValue, match="does not have"):
        solve(model, Move(other, 0.1), frames=0)


# The solver -------------------------------------------------------------------------------------------------

needs_mkl = pytest.mark.skipif(not pardiso.available(), reason="MKL is not installed")


@pytest.mark.parametrize("name", ["multifrontal", "superlu", "banded", pytest.param("pardiso", marks=needs_mkl)])
def test_the_result_names_the_solver(build, name):
    model, pull = build.bar()
    result = solve(model, Move(pull, 0.1, steps=2), solver=name, frames=0)
    assert result.solver == result.summary()["solver"] == name


def test_the_result_names_the_solver_that_was_taken_by_default(build):
    model, pull = build.bar()
    assert solve(model, Move(pull, 0.1, steps=1), frames=0).solver == "multifrontal"
    model = Model(strip(1.0, 1.0, 0.1, (2, 2)), material=J2)
    model.fix("x0")
    pressure = model.pressure("lower")
    assert solve(model, Move(pressure, 1e-3, steps=1), frames=0).solver == "multifrontal"  # an unsymmetric tangent


# Failure ----------------------------------------------------------------------------------------------------


def test_no_convergence_carries_the_result_and_leaves_the_last_converged_state(build):
    """A bar cannot be pressed through itself; before that it is as good as ever."""
    model, pull = build.bar()
    with pytest.raises(NoConvergence) as caught:
        solve(model, Move(pull, -1.5, steps=6, cuts=3), frames=2)
    error = caught.value
    result = error.result
    assert len(result) >= 3
    reached = result["pull"][-1]
    assert -1.0 < reached < -0.2
    assert pull.value == reached
    np.testing.assert_array_equal(model.u[pull.dofs], reached)
    assert model.system.time == result["time"][-1]
    assert "step 1" in error.where
    assert "pull = " in error.where
    assert error.cause
    assert error.remedy
    assert len(result.frames) >= 1
    again = solve(model, Move(pull, 0.5 * reached, steps=4), frames=0)
    fresh, control = build.bar()
    expected = solve(fresh, Move(control, 0.5 * reached, steps=4), frames=0)
    assert again["pull_force"][-1] == pytest.approx(expected["pull_force"][-1], rel=1e-7)


@pytest.mark.parametrize("place", ["target", "motion", "tool", "law", "callback"])
def test_an_interrupt_carries_the_result_and_leaves_the_last_converged_state(monkeypatch, place):
    """Out of any function of the user, in the third increment; all but the target of the move are in its middle."""
    interrupt, armed, calls = KeyboardInterrupt("stop"), {place}, []

    def hook(here, time):
        if here in armed and time > 0.6:
            calls.append(here)
            if len(calls) == 2 or here == "target":
                raise interrupt

    def law(E, state):
        hook("law", model.system.time + 0.25)  # the end of the increment
        return mt.NeoHooke(E=210e3, nu=0.3).law().respond(E, state)

    def tool(x):
        hook("tool", model.system.time + 0.25)
        return x[:, 2] + 0.25, np.tile([0.0, 0.0, 1.0], (len(x), 1)), np.zeros((len(x), 3, 3))

    def motion(time):
        hook("motion", time)
        return np.zeros(3)

    def target(fraction):
        hook("target", fraction)
        return -0.04 * fraction

    model = Model(strip(1.0, 1.0, 0.5, (2, 2)), material=UserLaw(law))
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    press = model.prescribe("upper", "z", "press")
    model.set_motion(model.contact("lower", UserSurface(tool), penalty=1e6, name="die"), motion)
    start = Newton.__init__

    def with_callback(self, *arguments):
        start(self, *arguments)
        self.callbacks.append(lambda record: hook("callback", model.system.time + 0.25))

    monkeypatch.setattr(Newton, "__init__", with_callback)
    with pytest.raises(KeyboardInterrupt) as caught:
        solve(model, Move(press, target, steps=4), options=TIGHT, frames=0)
    assert caught.value is interrupt
    result = interrupt.result
    np.testing.assert_allclose(result["time"], [0.0, 0.25, 0.5])
    assert result.seconds > 0
    assert result.solver
    assert model.system.time == 0.5
    assert press.value == result["press"][-1] == -0.02
    np.testing.assert_array_equal(model.u[press.dofs], -0.02)
    armed.clear()
    evaluation = model.evaluate(model.u)
    residual = evaluation.residual
    assert press.force(evaluation, model.system.ranks) == result["press_force"][-1]
    assert np.abs(residual[model.system.free]).max() < 1e-9 * abs(result["press_force"][-1])
    rest = solve(model, Move(press, -0.04, steps=2), options=TIGHT, frames=0)
    assert rest["press"][-1] == -0.04
    assert rest["press_force"][-1] < result["press_force"][-1] < -100


def test_chattering_is_a_warning_of_the_result(build, monkeypatch):
    from umform.results.records import Cause, Failed

    original, calls = Newton.solve, []

    def chatter_once(self, goal, extrapolation=None, mode=None, beyond=None, keep=False):
        calls.append(1)
        if len(calls) <= 3:  # the tangent, two softer penalties
            raise Failed("contact comes and goes in a cycle", [], Cause.CYCLE)
        return original(self, goal, extrapolation, mode, beyond, keep)

    monkeypatch.setattr(Newton, "solve", chatter_once)
    case = build.free_bending((8, 1))
    result = solve(case.model, Move(case.punch, -0.5, steps=2), frames=0)
    assert len(result.warnings) == 1
    assert "in a cycle" in result.warnings[0]
    assert "step 1" in result.warnings[0]
    assert result["punch"][-1] == -0.5


@pytest.mark.parametrize("wrong", ["a", None, float("nan")])
def test_a_target_is_a_number_or_an_array_of_numbers(wrong):
    model = Model(strip(2.0, 1.0, 1.0, (2, 1)), material=mt.SVK(E=1.0, nu=0.3))
    tip = model.prescribe("x1", "z", name="tip")
    with pytest.raises(InvalidValue):
        Move(tip, to=wrong)
    assert Move([tip], to=np.array([0.5])).values(0.5, [0.0]) == [0.25]
    with pytest.raises(InvalidValue, match="options are those of Newton"):
        solve(model, Move(tip, to=1.0), options={"residual": 1e-6})
    for frames in ("a", -1, 0.5):
        with pytest.raises(InvalidValue, match="frames must be a whole number"):
            solve(model, Move(tip, to=1.0), frames=frames)
