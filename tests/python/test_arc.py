"""Paths through limit points: rates, order of the iterations, limit and bifurcation loads, ends and failures."""

from __future__ import annotations

import math
import re
from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import umform
from umform import materials as mt
from umform.arc import Arc
from umform.critical import CriticalPoints, PathState, extremum
from umform.errors import InvalidValue, NoConvergence
from umform.mesh import Mesh, strip
from umform.model import Model
from umform.newton import Newton, NewtonOptions
from umform.results import Result
from umform.steps import Move, Release, solve
from umform.surfaces import Cylinder, Plane

TIGHT = NewtonOptions(residual=1e-12)


def arch(cells=8, element="ANS3DEAS"):
    """Half of a shallow arch of two straight bars, L = 10 each, hinged on its mid-line at the support and at the top.

    The top may rotate by symmetry only; a bar is a plate in plane strain, which makes it a von Mises arch of shells.
    """
    cell = "hex18" if "9K" in element else "hex8"
    mesh = strip(10.0, 1.0, 0.8, (cells, 1), cell=cell)  # so thick that no bar buckles
    x = mesh.points[:, :1] - mesh.points[:, 0].min()
    mesh = mesh.transformed(lambda points: points + np.array([0.0, 0.0, 0.6]) * (1 - x / 10.0))
    model = Model(mesh, element, material=mt.SVK(E=1000.0, nu=0.0))
    model.hinge("x1", "xz")
    model.hinge("x0", "x")  # the symmetry plane, without a moment
    for side in ("y0", "y1"):
        model.symmetry(side, "y")
    return model


def loaded_arch(**options):
    """The arch under forces that add up to 1 at the top."""
    model = arch(**options)
    nodes = model.mesh.nodes("x0")
    return model, model.force(nodes, (0.0, 0.0, -1.0 / len(nodes)), "load")


def roof(thickness, cells=4):
    """A quarter of the hinged cylindrical roof of [SzeLiuLo2004] under a central force; mm, N."""
    made = strip(0.1, 254.0, thickness, (cells, cells), cell="hex18")
    angle, y, z = (made.points - made.points.min(axis=0)).T
    radius = 2540.0 + z - 0.5 * thickness
    points = np.stack([radius * np.sin(angle), y, radius * np.cos(angle) - 2540.0], axis=1)
    mesh = Mesh(points, made.cells, made.sets, made.faces)
    model = Model(mesh, "MI9K3DEAS", material=mt.SVK(E=3102.75, nu=0.3))
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    model.hinge("x1", "xz")
    model.hinge(np.setdiff1d(mesh.nodes("x1"), mesh.nodes("y0")), "y")
    centre = np.intersect1d(mesh.nodes("x0"), mesh.nodes("y0"))
    return model, model.force(centre, (0.0, 0.0, -0.125), "force"), centre


def limit_loads(result):
    """Loads of the limit points that the events tell."""
    found = [re.search(r"limit point.* = (\S+?)(;|$)", event) for event in result.events]
    return [float(match[1]) for match in found if match]


# Rates ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["load", "pressure", "displacement", "midline", "tool"])
def test_the_rate_of_the_residual_is_its_derivative_with_the_load_parameter(kind, build, rng):
    model = Model(strip(2.0, 1.0, 0.4, (2, 1)), "DISP3D", material=mt.NeoHooke(E=100.0, nu=0.3))
    model.fix("x0")
    if kind == "load":
        control = model.force("x1", (1.0, 2.0, 3.0))
    elif kind == "pressure":
        control = model.pressure("upper")
    elif kind == "displacement":
        control = model.prescribe("x1", "z")
    elif kind == "midline":
        control = model.prescribe_midline("x1", "z")
    else:
        contact = model.contact("upper", Plane((0.0, 0.0, 0.15), "-z"), penalty=50.0)
        control = model.drive(contact, (0.3, 0.0, -1.0))
    u = 0.02 * rng.normal(size=model.u.size)
    along = model.displacement_of_supports({control: 0.7})

    def residual(step):
        control.value = 0.01 + 0.7 * step
        return model.restrict(model.evaluate(u + step * along).residual)

    expected = build.central_difference(residual, 0.0, 1.0, 1e-5)
    control.value = 0.01
    found = model.restrict(model.evaluate(u, rates={control: 0.7}).predictor)
    assert build.relative_error(found, expected) < 1e-6
    np.testing.assert_array_equal(model.evaluate(u, rates={control: 0.7}).residual, model.evaluate(u).residual)


# The same path as by other means ----------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["cylindrical", "spherical"])
@pytest.mark.parametrize("problem", ["load", "pressure", "displacement", "tool", "plastic"])
def test_an_arc_follows_the_path_of_a_move(problem, kind, build):
    """A move through the same loads comes to the same states, those of plasticity too."""

    def made():
        if problem == "load":
            model, control = build.cantilever(cells=(4, 1))
            return model, control, 1.0
        if problem == "pressure":
            model, _ = build.cantilever(cells=(4, 1))
            return model, model.pressure("lower", "push"), 0.5
        if problem == "displacement":
            model, control = build.bar("MI9K3DEAS")
            return model, control, 0.3
        if problem == "plastic":
            law = mt.J2(kappa=175e3, mu=80.77e3, hardening=mt.Linear(160.0, 500.0))
            model = Model(strip(20.0, 2.0, 1.0, (6, 1)), material=law)
            model.fix("x0")
            return model, model.line_load("x1", "lower", (0.0, 0.0, 1.0), "load"), 2.6
        model = Model(strip(4.0, 1.0, 0.2, (4, 1)), material=mt.NeoHooke(E=1000.0, nu=0.3))
        model.fix("x0")
        contact = model.contact("upper", Plane((0.0, 0.0, 0.0999), "-z"), penalty=100.0)
        return model, model.drive(contact, "-z", "down"), 0.4

    model, control, end = made()
    result = solve(model, Arc(control, end, increment=0.1, kind=kind), options=TIGHT, frames=0)
    assert control.value == end
    assert len(result) > 3
    assert (np.diff(result["time"]) > 0).all()
    other, moved, _ = made()
    expected = solve(other, [Move(moved, v, steps=1) for v in result[control.name][1:]], options=TIGHT, frames=0)
    np.testing.assert_allclose(model.u, other.u, atol=1e-7 * np.abs(other.u).max())
    np.testing.assert_allclose(model.block.state, other.block.state, atol=1e-7)
    np.testing.assert_allclose(result[f"{control.name}_force"], expected[f"{control.name}_force"], rtol=1e-6, atol=1e-9)
    assert problem != "plastic" or model.block.state[..., 6].max() > 1e-3


def test_load_and_displacement_control_meet_the_same_path_through_snap_through():
    """The reaction of a top that is moved is the load that an arc finds, its maximum and minimum the limit loads."""
    model, load = loaded_arch()
    result = solve(model, Arc(load, 0.1, increment=0.1, grow=1.0), options=TIGHT, frames=200)
    top = model.mesh.nodes("x0")
    w = np.array([-frame.points["displacement"][top, 2].mean() for frame in result.frames])
    assert (np.diff(w) > 0).all()
    driven = arch()
    push = driven.prescribe_midline("x0", "z", "push")  # its forces on the two nodes are equal, as those of the load
    moved = solve(driven, Move(push, -1.4, steps=140), options=TIGHT, frames=0)
    reaction = CubicSpline(-moved["push"], -moved["push_force"])
    np.testing.assert_allclose(result["load"], reaction(w), atol=3e-6)
    turning = [float(reaction(x)) for x in reaction.derivative().roots(extrapolate=False)]
    assert len(turning) == 2
    np.testing.assert_allclose(limit_loads(result), turning, rtol=5e-3)
    assert turning[1] < 0.0 < turning[0]
    assert all("negative pivots" in event for event in result.events)
    # An arc with the displacement as its parameter comes along the same path too.
    other = arch()
    push = other.prescribe_midline("x0", "z", "push")
    along = solve(other, Arc(push, -1.4, increment=0.2), options=TIGHT, frames=0)
    np.testing.assert_allclose(-along["push_force"], reaction(-along["push"]), atol=3e-6)
    assert along.events == []  # under a prescribed displacement the path has no limit point


def test_limit_loads_of_an_arch_converge_with_mesh_and_arc_length():
    def limits(cells, **options):
        model, load = loaded_arch(cells=cells, element="MI9K3DEAS")
        return np.array(limit_loads(solve(model, Arc(load, 0.1, **options), frames=0)))

    fine = limits(12, increment=0.02, grow=1.0)
    assert len(fine) == 2
    coarse, middle = abs(limits(2, increment=0.02, grow=1.0) - fine), abs(limits(4, increment=0.02, grow=1.0) - fine)
    assert (middle < 0.5 * coarse + 1e-5 * fine.max()).all()
    np.testing.assert_allclose(limits(12, increment=0.1, grow=1.0), fine, rtol=1e-2)


def test_cylindrical_and_spherical_arcs_follow_one_path():
    curves = []
    for kind in ("cylindrical", "spherical"):
        model, load = loaded_arch()
        result = solve(model, Arc(load, 0.1, increment=0.1, kind=kind, grow=1.0), options=TIGHT, frames=200)
        top = model.mesh.nodes("x0")
        w = np.array([-frame.points["displacement"][top, 2].mean() for frame in result.frames])
        curves.append((w, result["load"], limit_loads(result)))
    (w, load, limits), (other_w, other_load, other_limits) = curves
    assert len(w) != len(other_w) or np.abs(w[1:-1] - other_w[1:-1]).min() > 1e-9  # other states of the path
    np.testing.assert_allclose(CubicSpline(w, load)(other_w), other_load, atol=1e-3)
    np.testing.assert_allclose(limits, other_limits, rtol=5e-3)


def test_an_arc_may_start_from_a_loaded_state_and_go_back():
    model, load = loaded_arch()
    result = solve(model, [Move(load, 0.02, steps=2), Arc(load, 0.0, increment=0.2)], options=TIGHT, frames=0)
    assert load.value == 0.0
    assert np.abs(model.u).max() < 1e-10
    assert (np.diff(result["load"][2:]) < 0).all()


def test_controls_go_along_their_line_together():
    model, load = loaded_arch()
    side = model.force("x0", (0.0, 1.0, 0.0), "side")
    result = solve(model, Arc([load, side], [0.04, -0.12], increment=0.2), frames=0)
    np.testing.assert_allclose(result["side"], -3.0 * result["load"], atol=1e-15)


# Order ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["cylindrical", "spherical"])
def test_bordered_iterations_converge_quadratically(kind, build):
    model, tip = build.cantilever(cells=(4, 1), element="EAS3DEAS")
    step = Arc(tip, 2.0, increment=0.2, kind=kind, grow=1.0, most=3)
    result = solve(model, step, options=NewtonOptions(residual=1e-13), frames=0)
    for records in result.iterations[1:]:
        steps = [it.increment for it in records[1:] if it.increment > 1e-11]
        assert len(steps) >= 3
        orders = [math.log(c / b) / math.log(b / a) for a, b, c in zip(steps, steps[1:], steps[2:], strict=False)]
        assert max(orders) > 1.7


@pytest.mark.parametrize("kind", ["cylindrical", "spherical"])
def test_each_increment_has_its_arc_length(kind):
    """Displacements of the nodes, and the load parameter with the weight of the first increment."""
    model, load = loaded_arch()
    states = [model.u.copy()]

    def keep(model):
        states.append(model.u.copy())
        return False

    step = Arc(load, 0.1, increment=0.2, kind=kind, grow=1.0, iterations=25, most=12, until=keep)
    result = solve(model, step, options=TIGHT, frames=0)
    moves = np.array([np.linalg.norm(b - a) for a, b in pairwise(states)])
    if kind == "cylindrical":
        np.testing.assert_allclose(moves, moves[0], rtol=1e-9)
    else:
        loads = np.diff(result["load"]) / 0.1
        weight = (moves[0] ** 2 - moves[5] ** 2) / (loads[5] ** 2 - loads[0] ** 2)
        assert weight > 0.0
        np.testing.assert_allclose(moves**2 + weight * loads**2, moves[0] ** 2 + weight * loads[0] ** 2, rtol=1e-6)
    np.testing.assert_allclose(np.diff(result["time"]), 0.2, rtol=1e-10)


# Critical points --------------------------------------------------------------------------------------------


def test_euler_load_of_a_straight_strip_is_bracketed():
    """Compressed on its hinges the strip stays straight; at pi^2 E I / L^2 a pivot turns and the load does not."""
    model = Model(strip(10.0, 1.0, 0.2, (8, 1), cell="hex18"), "MI9K3DEAS", material=mt.SVK(E=1e4, nu=0.0))
    model.hinge("x0", "xz")
    model.hinge("x1", "z")
    for side in ("y0", "y1"):
        model.symmetry(side, "y")
    area = 0.2
    load = model.traction("x1", (-1.0 / area, 0.0, 0.0), "load")
    euler = math.pi**2 * 1e4 * 0.2**3 / 12 / 100
    result = solve(model, Arc(load, 1.5 * euler, increment=0.05, grow=1.0), frames=0)
    bifurcation = [re.search(r"bifurcation point between load = (\S+) and load = (\S+);", e) for e in result.events]
    assert len(bifurcation) == 1
    low, high = float(bifurcation[0][1]), float(bifurcation[0][2])
    assert low < euler < high
    assert high - low < 0.1 * euler
    assert "0 -> 1" in result.events[0]
    assert any("unstable primary" in warning for warning in result.warnings)
    assert np.abs(model.u.reshape(-1, 3)[:, 2]).max() < 1e-6


def test_the_roof_snaps_through_and_back():
    """Limit loads of the literature: 0.742 of 3000 N at 12.7 mm (table of [SzeLiuLo2004], read to its digits)."""
    model, force, centre = roof(12.7)
    result = solve(model, Arc(force, 3000.0), frames=200)
    thick = limit_loads(result)
    assert len(thick) == 2
    assert thick[0] == pytest.approx(0.7421 * 3000, rel=0.01)
    assert thick[1] == pytest.approx(0.1729 * 3000, rel=0.03)
    w = np.array([-frame.points["displacement"][centre, 2].mean() for frame in result.frames])
    assert (np.diff(w) > 0).all()
    assert np.interp(4.477, w, result["force"]) == pytest.approx(0.4686 * 3000, rel=0.01)

    model, force, centre = roof(6.35)
    result = solve(model, Arc(force, 3000.0), frames=200)
    assert len(limit_loads(result)) == 2
    assert limit_loads(result)[1] < 0.0  # the load changes its sign on the way
    w = np.array([-frame.points["displacement"][centre, 2].mean() for frame in result.frames])
    assert np.diff(w).min() < -0.1  # snap-back
    assert np.sum(np.diff(np.sign(np.diff(w))) != 0) == 2


def state(fraction, arc, slope, pivots):
    return PathState(fraction, arc, np.zeros(1), slope, pivots)


def test_the_load_of_a_limit_point_is_exact_on_a_cubic():
    def at(s):
        return state(s**3 - 3 * s, s, 3 * s**2 - 3, 0)

    assert extremum(at(0.5), at(1.7)) == pytest.approx(-2.0, abs=1e-12)
    assert extremum(at(-1.3), at(0.0)) == pytest.approx(2.0, abs=1e-12)


@pytest.mark.parametrize(
    ("slopes", "pivots", "limits", "bifurcations"),
    [
        ((1, 1), (0, 0), 0, 0),
        ((1, -1), (0, 1), 1, 0),
        ((1, -1, 1), (0, 1, 0), 2, 0),
        ((1, 1), (0, 1), 0, 1),
        ((1, 1, -1), (0, 1, 2), 1, 1),
        ((1, -1), (0, 2), 1, 1),
        ((1, -1), (0, 0), 1, 1),
        ((1, -1, 1), (0, None, 0), 2, 0),
        ((1, -1, -1), (0, None, 1), 1, 0),
        ((1, 1, 1), (0, None, 1), 0, 1),
        ((1, -1), (None, None), 1, 0),
    ],
)
def test_what_a_change_of_pivots_means(slopes, pivots, limits, bifurcations, build):
    result = Result(build.bar()[0])
    points = CriticalPoints(result, lambda fraction: f"load = {fraction:g}", "step 1")
    for k, (slope, count) in enumerate(zip(slopes, pivots, strict=True)):
        points.advance(state(0.1 * k, 0.1 * k, float(slope), count))
    assert sum("limit point" in event for event in result.events) == limits
    assert sum("bifurcation point between" in event for event in result.events) == bifurcations
    assert sum("does not tell" in event for event in result.events) == (None in pivots)


def test_an_unsymmetric_tangent_says_that_bifurcations_may_pass_unseen(build):
    model, _ = build.cantilever(cells=(4, 1))
    result = solve(model, Arc(model.pressure("lower"), 0.2, increment=0.2), frames=0)
    assert sum("does not tell the number of negative pivots" in event for event in result.events) == 1


# Ends and failures ------------------------------------------------------------------------------------------


def test_an_arc_ends_when_it_is_told_to():
    model, load = loaded_arch()
    top = 3 * model.mesh.nodes("x0") + 2
    result = solve(model, Arc(load, 0.1, until=lambda m: m.u[top].mean() < -0.5), frames=0)
    assert -0.7 < model.u[top].mean() < -0.5
    assert load.value == result["load"][-1] < 0.1
    assert "as asked" in result.events[-1]
    model, load = loaded_arch()
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
            calls.append(self.system.time)
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


def test_a_failed_increment_is_halved_and_leaves_no_trace(failing):
    model, load = loaded_arch(element="EAS3DEAS")
    failing([3])
    step = Arc(load, 0.1, increment=0.05, grow=1.0, iterations=25, most=4)
    result = solve(model, step, options=TIGHT, frames=0)
    np.testing.assert_allclose(np.diff(result["time"]), [0.05, 0.05, 0.025, 0.05], rtol=1e-9)
    other, moved = loaded_arch(element="EAS3DEAS")
    solve(other, [Move(moved, v, steps=1) for v in result["load"][1:]], options=TIGHT, frames=0)
    np.testing.assert_allclose(model.u, other.u, atol=1e-8)
    np.testing.assert_allclose(model.block.alpha, other.block.alpha, atol=1e-8)


@pytest.mark.parametrize("error", [None, KeyboardInterrupt("stop")])
def test_a_path_that_fails_or_is_interrupted_leaves_its_last_converged_state(failing, error):
    model, load = loaded_arch(element="EAS3DEAS")
    solve(model, Arc(load, 0.1, increment=0.2, most=4), frames=0)
    before, time = model.snapshot(), model.time
    residual = model.evaluate(model.u).residual
    failing(range(1, 100), error)
    with pytest.raises(NoConvergence if error is None else KeyboardInterrupt) as caught:
        solve(model, Arc(load, 0.1, increment=0.2, cuts=3), frames=0)
    for a, b in zip(vars(before).values(), vars(model.snapshot()).values(), strict=True):
        np.testing.assert_array_equal(a, b)
    assert model.time == time
    np.testing.assert_array_equal(model.evaluate(model.u).residual, residual)
    assert len(caught.value.result) == 1
    if error is None:
        assert "smallest arc length" in str(caught.value)
        assert "load = " in caught.value.where


def test_what_a_users_function_breaks_off_is_kept():
    model, load = loaded_arch()

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


def test_a_path_ends_where_a_tool_lifts_off():
    """A tool can push the arch down to where it is flat; from there it would have to pull."""
    model = arch()
    contact = model.contact("upper", Cylinder((0.0, 0.0, 2.94), "y", 2.0), penalty=50.0, name="punch")
    down = model.drive(contact, "-z", "down")
    with pytest.raises(NoConvergence) as caught:
        solve(model, Arc(down, 1.5), frames=0)
    result = caught.value.result
    assert -0.6 < model.u[3 * model.mesh.nodes("x0") + 2].mean() < -0.5
    assert 0.0 < result["punch_fz"][-1] < 0.1 * result["punch_fz"].max()


def test_an_arc_that_moves_nothing_is_refused():
    model, load = loaded_arch()
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


def test_an_arc_is_a_step_among_others():
    assert umform.Arc is Arc
    model = arch()
    push = model.prescribe("x0", "z", "push")
    result = solve(model, [Arc(push, -0.2), Move(push, -0.3, steps=2), Release(push)], frames=0)
    np.testing.assert_array_equal(np.unique(result["step"]), [0, 1, 2, 3])
    assert abs(push.value) < 1e-3
