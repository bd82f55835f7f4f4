"""Paths through limit points: rates, the same path as by other means, order of the iterations."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from umform import materials as mt
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Arc, Move
from umform.history_variables import history_of
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import Plane

TIGHT = NewtonOptions(residual=1e-12)


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
    along = model.supports.displacement({control: 0.7})

    def residual(step):
        control.value = 0.01 + 0.7 * step
        return model.system.restrict(model.evaluate(u + step * along).residual)

    expected = build.central_difference(residual, 0.0, 1.0, 1e-5)
    control.value = 0.01
    found = model.system.restrict(model.evaluate(u, rates={control: 0.7}).predictor)
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
    np.testing.assert_allclose(model.bodies.only.block.state, other.bodies.only.block.state, atol=1e-7)
    np.testing.assert_allclose(result[f"{control.name}_force"], expected[f"{control.name}_force"], rtol=1e-6, atol=1e-9)
    assert problem != "plastic" or history_of(model.bodies.only.block)["eqps"].max() > 1e-3


def test_load_and_displacement_control_meet_the_same_path_through_snap_through(build):
    """The reaction of a top that is moved is the load that an arc finds, its maximum and minimum the limit loads."""
    model, load = build.loaded_arch()
    result = solve(model, Arc(load, 0.1, increment=0.1, grow=1.0), options=TIGHT, frames=200)
    top = model.mesh.nodes("x0")
    w = np.array([-frame.points["displacement"][top, 2].mean() for frame in result.frames])
    assert (np.diff(w) > 0).all()
    driven = build.arch()
    push = driven.prescribe_midline("x0", "z", "push")  # its forces on the two nodes are equal, as those of the load
    moved = solve(driven, Move(push, -1.4, steps=140), options=TIGHT, frames=0)
    reaction = CubicSpline(-moved["push"], -moved["push_force"])
    np.testing.assert_allclose(result["load"], reaction(w), atol=3e-6)
    turning = [float(reaction(x)) for x in reaction.derivative().roots(extrapolate=False)]
    assert len(turning) == 2
    np.testing.assert_allclose(build.limit_loads(result), turning, rtol=5e-3)
    assert turning[1] < 0.0 < turning[0]
    assert all("negative pivots" in event for event in result.events)
    # An arc with the displacement as its parameter comes along the same path too.
    other = build.arch()
    push = other.prescribe_midline("x0", "z", "push")
    along = solve(other, Arc(push, -1.4, increment=0.2), options=TIGHT, frames=0)
    np.testing.assert_allclose(-along["push_force"], reaction(-along["push"]), atol=3e-6)
    assert along.events == []  # under a prescribed displacement the path has no limit point


def test_limit_loads_of_an_arch_converge_with_mesh_and_arc_length(build):
    def limits(cells, **options):
        model, load = build.loaded_arch(cells=cells, element="MI9K3DEAS")
        return np.array(build.limit_loads(solve(model, Arc(load, 0.1, **options), frames=0)))

    fine = limits(12, increment=0.02, grow=1.0)
    assert len(fine) == 2
    coarse, middle = abs(limits(2, increment=0.02, grow=1.0) - fine), abs(limits(4, increment=0.02, grow=1.0) - fine)
    assert (middle < 0.5 * coarse + 1e-5 * fine.max()).all()
    np.testing.assert_allclose(limits(12, increment=0.1, grow=1.0), fine, rtol=1e-2)


def test_cylindrical_and_spherical_arcs_follow_one_path(build):
    curves = []
    for kind in ("cylindrical", "spherical"):
        model, load = build.loaded_arch()
        result = solve(model, Arc(load, 0.1, increment=0.1, kind=kind, grow=1.0), options=TIGHT, frames=200)
        top = model.mesh.nodes("x0")
        w = np.array([-frame.points["displacement"][top, 2].mean() for frame in result.frames])
        curves.append((w, result["load"], build.limit_loads(result)))
    (w, load, limits), (other_w, other_load, other_limits) = curves
    assert len(w) != len(other_w) or np.abs(w[1:-1] - other_w[1:-1]).min() > 1e-9  # other states of the path
    np.testing.assert_allclose(CubicSpline(w, load)(other_w), other_load, atol=1e-3)
    np.testing.assert_allclose(limits, other_limits, rtol=5e-3)


def test_an_arc_may_start_from_a_loaded_state_and_go_back(build):
    model, load = build.loaded_arch()
    result = solve(model, [Move(load, 0.02, steps=2), Arc(load, 0.0, increment=0.2)], options=TIGHT, frames=0)
    assert load.value == 0.0
    assert np.abs(model.u).max() < 1e-10
    assert (np.diff(result["load"][2:]) < 0).all()


def test_controls_go_along_their_line_together(build):
    model, load = build.loaded_arch()
    side = model.force("x0", (0.0, 1.0, 0.0), "side")
    result = solve(model, Arc([load, side], [0.04, -0.12], increment=0.2), frames=0)
    np.testing.assert_allclose(result["side"], -3.0 * result["load"], atol=1e-15)


# Order ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("mixed", "least"), [(False, 1e-11), (True, 1e-13)], ids=["consistent", "mixed"])
@pytest.mark.parametrize("kind", ["cylindrical", "spherical"])
def test_bordered_iterations_converge_quadratically(kind, mixed, least, build):
    """The mixed tangent takes so few iterations that those down to round-off are needed to tell its order."""
    model, tip = build.cantilever(cells=(4, 1), element="EAS3DEAS")
    step = Arc(tip, 2.0, increment=0.2, kind=kind, grow=1.0, most=3)
    result = solve(model, step, options=NewtonOptions(residual=1e-13, mixed=mixed), frames=0)
    for records in result.iterations[1:]:
        steps = [it.increment for it in records[1:] if it.increment > least]
        assert len(steps) >= 3
        orders = [math.log(c / b) / math.log(b / a) for a, b, c in zip(steps, steps[1:], steps[2:], strict=False)]
        assert max(orders) > 1.7


@pytest.mark.parametrize("kind", ["cylindrical", "spherical"])
def test_each_increment_has_its_arc_length(kind, build):
    """Displacements of the nodes, and the load parameter with the weight of the first increment."""
    model, load = build.loaded_arch()
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
