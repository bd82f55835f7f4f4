"""Stiff penalties: what round-off leaves of the residual, the first touch, the release, tools that move in time."""

from __future__ import annotations

import math

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.newton.criteria import Criteria
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.newton.softening import softened
from umform.analysis.run import solve
from umform.analysis.steps import Move, Release
from umform.mesh import strip
from umform.model import Model
from umform.model.terms.term import At
from umform.results.records import Cause, Failed
from umform.surfaces import Cylinder, Plane
from umform_book.contact.strip_on_cylinder import flat_strip
from umform_book.variants import Variant, with_tying

ELASTIC = mt.SVK(E=1e5, nu=0.0)


def three_points(penalty, points, *, radius=20.0, length=40.0, thickness=0.5, cells=24, far=(0.0, 0.0, 0.0)):
    """Half of a strip on a support, under a cylinder that just touches its middle; all of it ``far`` away."""
    sheet = strip(length, 2.0, thickness, (cells, 1), grading=(10.0, 1.0)).moved(far)
    model = Model(sheet, material=ELASTIC)
    model.symmetry("x0", "x")
    model.fix(np.arange(len(sheet.points)), "y")
    model.fix("x1_lower", "z")
    centre = (far[0], far[1], far[2] + radius + 0.5 * thickness)
    contact = model.contact("upper", Cylinder(centre, "y", radius), penalty=penalty, points=points)
    return model, model.drive(contact, "-z", "ram")


# The floor --------------------------------------------------------------------------------------------------


def attained(model, iterations=6):
    """Residuals of more iterations at a converged state, which nothing but round-off is left of."""
    newton, u, norms = Newton(model.system), model.u.copy(), []
    solver = newton.ready_solver()
    for _ in range(iterations):
        evaluation = model.evaluate(u)
        r = model.system.restrict(evaluation.residual)
        norms.append(float(np.linalg.norm(r)))
        solver.factor(evaluation)
        du = model.system.extend(solver.solve(-r))
        model.system.recover(du)
        u += du
    model.system.revert()
    evaluation = model.evaluate(model.u)
    floor = Criteria(model.system, residual=1e-9, increment=1e-6).floor(np.abs(model.u).max(), evaluation)
    return max(norms[1:]), floor


STIFF = [
    (1e5, 2, {}), (1e8, 2, {}), (1e8, "nodes", {}), (1e9, 2, {}), (1e7, 10, {}),
    (1e8, 2, {"radius": 200.0}), (1e8, "nodes", {"radius": 3.0}), (1e8, 2, {"far": (500.0, 0.0, -300.0)}),
]  # fmt: skip


@pytest.mark.parametrize(("penalty", "points", "options"), STIFF)
def test_the_floor_is_above_what_is_attained_and_not_far_above(penalty, points, options):
    model, ram = three_points(penalty, points, **options)
    solve(model, Move(ram, 0.5, steps=2), options=NewtonOptions(residual=1e-5), frames=0)
    residual, floor = attained(model)
    assert residual < floor < 100.0 * residual


@pytest.mark.parametrize(("penalty", "points"), [(1e8, 2), (1e8, "nodes"), (1e9, "nodes")])
def test_stiff_runs_converge_at_the_tolerance_of_the_house_and_to_the_force_of_softer_ones(penalty, points):
    """Their tolerance is below the floor; the force is that of a penalty whose floor is far below the tolerance."""
    stiff, soft = three_points(penalty, points), three_points(1e6, points)
    result = solve(stiff[0], Move(stiff[1], 2.0, steps=5, cuts=0), frames=0)
    expected = solve(soft[0], Move(soft[1], 2.0, steps=5), frames=0)
    assert len(result) == 6
    assert result["ram_force"][-1] == pytest.approx(expected["ram_force"][-1], rel=1e-5)
    assert result["iterations"][2:].max() <= 8


def test_the_scale_of_round_off_by_hand():
    """One facet of area 1 that lies flat: |x| at its point, no curvature; each node has a quarter of it."""
    sheet = strip(1.0, 1.0, 0.5, (1, 1)).moved((3.0, 0.0, 4.25))
    model = Model(sheet, material=ELASTIC)
    contact = model.contact("lower", Plane((0.0, 0.0, 4.0)), penalty=7.0, points=1)
    at = model.evaluate(model.u).found[contact]
    assert at.gap[0] == 0.0
    size = np.linalg.norm(at.x[0])
    assert at.round_off_squared == pytest.approx(4 * (7.0 * 0.25 * size) ** 2, rel=1e-14)
    away = model.evaluate(np.tile([0.0, 0.0, 1e-9], len(sheet.points)))
    assert away.found[contact].round_off_squared == 0.0


def test_a_round_tool_adds_its_radius_of_curvature_to_the_scale():
    sheet = strip(1.0, 1.0, 0.5, (1, 1))
    model = Model(sheet, material=ELASTIC)
    contact = model.contact("lower", Cylinder((0.0, 0.0, -50.0), "y", 50.0), penalty=1.0, points=1)
    at = model.evaluate(model.u).found[contact]
    size = np.linalg.norm(at.x[0]) + 50.0 + at.gap[0]
    assert at.round_off_squared == pytest.approx(4 * (0.25 * size) ** 2, rel=1e-12)


# First touch and release ------------------------------------------------------------------------------------


@pytest.mark.parametrize("points", [2, "auto"])
def test_a_stiff_tool_touches_a_very_soft_strip_in_one_increment(points):
    """The strip yields to 1e-5 N/mm, the penalty holds 3e5 N/mm; the first increment is 1000 times the thickness."""

    def run(steps):
        sheet = strip(100.0, 10.0, 0.1, (24, 1))
        model = Model(sheet, material=mt.SVK(E=2.1e5, nu=0.3))
        model.symmetry("x0", "x")
        model.fix("x1_lower", "z")
        model.fix(lambda x, y, z: (x < 1e-6) & (y < 1e-6), "y")
        contact = model.contact("upper", Cylinder((0.0, 0.0, 10.05), "y", 10.0), points=points)
        return solve(model, Move(model.drive(contact, "-z", "ram"), 10.0, steps=steps, cuts=0), frames=0)

    one, many = run(10), run(40)
    assert one["ram_force"][-1] == pytest.approx(many["ram_force"][-1], rel=1e-6)
    assert one["ram_force"][-1] > 0.0


@pytest.mark.parametrize("by", ["punch", "ram"])
@pytest.mark.parametrize(("element", "points"), [("ANS3DEAS", 2), ("ANS3DEAS", "nodes"), ("MI9K3DEAS", 3)])
def test_a_release_with_a_penalty_of_100_E_over_h_ends_where_that_of_a_soft_one_does(build, element, points, by):
    def springback(penalty):
        cells = (8, 1) if "9K" in element else (16, 1)
        case = build.free_bending(cells, element, points)
        case.contact.penalty = penalty
        control = case.punch if by == "punch" else case.model.drive(case.contact, "z", "ram")
        end = -3.0 if by == "punch" else 3.0
        result = solve(case.model, [Move(control, end, steps=12, cuts=3), Release(control)], frames=0)
        assert abs(result[f"{by}_force"][-1]) <= 1e-6 * np.abs(result[f"{by}_force"]).max()
        return abs(control.value)

    assert springback(100 * 2.1e5) == pytest.approx(springback(2.1e5), rel=1e-4)


def test_softer_penalties_lead_to_the_equilibrium_of_the_penalty_itself():
    model, ram = three_points(1e5, 10)
    goal = model.state.toward({ram.name: 1.0})
    model.system.stand(model.evaluate(goal))
    newton = Newton(model.system)
    converged = softened(model, newton, goal, lambda: newton.solve(goal), lambda found: found)
    assert model.contacts[0].penalty == 1e5
    model.system.commit(converged.evaluation)
    again, other = three_points(1e5, 10)
    solve(again, Move(other, 1.0, steps=20), frames=0)
    np.testing.assert_allclose(model.u, again.u, atol=1e-7)


def test_penalties_are_those_of_before_when_softer_ones_lead_nowhere():
    model, ram = three_points(1e5, 10)
    goal = model.state.toward({ram.name: 1.0})
    model.system.stand(model.evaluate(goal))
    newton = Newton(model.system, NewtonOptions(max_iterations=1))
    with pytest.raises(Failed):
        softened(model, newton, goal, lambda: newton.solve(goal), lambda found: found)
    assert model.contacts[0].penalty == 1e5


@pytest.mark.parametrize(
    ("touched", "cause", "tries"),
    [(False, Cause.STALL, 2), (True, Cause.STALL, 1), (True, Cause.INDEFINITE, 1), (True, Cause.SINGULAR, 2)],
)
def test_a_millionth_of_the_penalty_serves_first_touch_and_contact_that_is_lost(monkeypatch, touched, cause, tries):
    model, ram = three_points(1e5, 10)
    goal = model.state.toward({ram.name: 1.0})
    penalties = []

    def fail(self, goal, extrapolation=None, mode=None, beyond=None):
        penalties.append(model.contacts[0].penalty)
        raise Failed("no", [], cause)

    monkeypatch.setattr(Newton, "solve", fail)
    newton = Newton(model.system)
    with pytest.raises(Failed, match="no"):
        softened(model, newton, goal, lambda: newton.solve(goal), lambda found: found, touched=touched)
    assert penalties == pytest.approx([1e2, 1e-1][:tries])


# Tools that move by a function of time ----------------------------------------------------------------------


def rolling(time):
    """A turn about y and a translation at the same time."""
    return np.array([0.3 * time, 0.0, 0.2 * time**2]), np.array([0.0, 0.4 * time, 0.0])


def test_the_rate_of_the_residual_with_a_tool_that_moves_in_time(build):
    """Against the difference of the residual over a short time, in contact with a tool that turns off its axis."""
    case = build.free_bending((8, 1))
    solve(case.model, Move(case.punch, -1.0, steps=2), frames=0)
    model, dt = case.model, 1e-7
    model.set_motion(case.contact, rolling, about=(20.0, 0.0, -15.0))
    model.system.time = 0.0
    rate = model.evaluate(model.u, rates={}, until=dt).predictor / dt
    assert case.contact.active().any()
    before = model.evaluate(model.u).residual
    model.system.time = dt
    slope = (model.evaluate(model.u).residual - before) / dt
    assert np.abs(rate).max() > 1.0
    np.testing.assert_allclose(rate, slope, atol=1e-5 * np.abs(rate).max())


def test_the_way_of_a_tool_is_that_of_its_points(build):
    case = build.free_bending((8, 1))
    case.model.set_motion(case.contact, rolling, about=(20.0, 0.0, -15.0))
    ram = case.model.drive(case.contact, "z", "ram")
    ram.value, case.model.system.time = 0.7, 0.5
    rotation, shift = pose = case.contact.pose
    mark = np.array([[3.0, 4.0, 5.0], [-1.0, 0.0, 2.0]])  # in the tool's own frame
    x = mark @ rotation.T + shift
    way = case.contact._carried(x, At(case.model.u, 0.5, {ram: 0.7}, until=0.9), pose)
    case.model.system.time = 0.9
    rotation, shift = case.contact.pose
    np.testing.assert_allclose(x + way, mark @ rotation.T + shift, atol=1e-13)


def test_a_tool_that_moves_in_time_goes_back_without_losing_the_sheet(build):
    """Each increment goes back by a hundred penetrations; without its rate the tangent has lost the tool."""

    def iterations(by_time):
        case = build.free_bending((12, 1))
        case.contact.penalty = 1e5
        control = case.model.drive(case.contact, "z", "ram")
        solve(case.model, Move(control, 3.0, steps=12), frames=0)
        options = NewtonOptions(extrapolate=False)
        if not by_time:
            return solve(case.model, Move(control, 2.8, steps=10, cuts=0), options=options, frames=0)
        case.model.set_motion(case.contact, lambda time: np.array([0.0, 0.0, 0.2 * min(1.0 - time, 0.0)]))
        return solve(case.model, Move(case.punch, 0.0, steps=10, cuts=0), options=options, frames=0)

    by_time, driven = iterations(True), iterations(False)
    np.testing.assert_allclose(by_time["tool_fz"], driven["tool_fz"], rtol=1e-5, atol=1e-6)
    assert abs(int(by_time["iterations"].sum()) - int(driven["iterations"].sum())) <= 2
    assert math.isclose(by_time["time"][-1], 2.0)


def test_a_sheet_does_not_go_through_a_tool_while_the_penalty_is_soft():
    """A weight over a sharp edge: with a thousandth of the penalty a coarse strip finds the far side of the edge."""
    model, _, load = flat_strip(Variant("ANS3DEAS"), 30, (-15.0, 45.0), 500.0, 2, radius=4.0)
    model.fix("x0", "z")
    model.prescribe("x0", "x", "pull")
    result = solve(model, Move(load, lambda fraction: 6.0 * fraction**2, steps=40), progress=False)
    assert (result["tool_fz"][1:] < 0.0).all()
    assert result["tool_fz"][-1] < -1.0


@pytest.mark.parametrize("intervals", [24, 60])
def test_a_sheet_does_not_go_through_a_tool_at_its_nodes(intervals):
    """The same edge, held at nodes: without a look at the sides of the tool the strip falls through at once."""
    model, _, load = flat_strip(with_tying("ANS3DEAS"), intervals, (-15.0, 45.0), 500.0, "nodes", radius=4.0)
    model.fix("x0", "z")
    model.prescribe("x0", "x", "pull")
    step = Move(load, lambda fraction: 6.0 * fraction**2, steps=40)
    result = solve(model, step, options=NewtonOptions(extrapolate=0), frames=0, progress=False)
    assert (result["tool_fz"][1:] < 0.0).all()
    assert result["tool_fz"][-1] == pytest.approx(-6.0, rel=0.03)
    assert result.timing.attempts.causes["sheet through a tool or a sheet"] >= 1
