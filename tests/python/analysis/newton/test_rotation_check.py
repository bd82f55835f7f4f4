"""A sheet that friction carries on a turning tool is found where it belongs, whatever the increments."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton.rotation_predictor import Screw
from umform.analysis.newton.rotation_predictor import carried as around

SLIP = 1e-3


def carried():
    """A plate that is pressed to a plane by a pressure and held by friction alone."""
    plate = uf.mesh.strip(4.0, 2.0, 0.5, (4, 2)).transformed(lambda x: np.add(x, (-2.0, -1.0, 0.25)))
    model = uf.Model(plate, material=uf.SVK(E=1e5, nu=0.3))
    tool = model.tool("table", uf.Plane((0, 0, 0), (0, 0, 1)))
    model.contact("lower", tool, penalty=1e3, friction=0.2, slip=SLIP, name="foot")
    press, spin = model.pressure("upper", "press"), model.turn(tool, "z", name="spin")
    uf.solve(model, uf.Move(press, 1.0, steps=1), progress=False)
    return model, spin


@pytest.mark.parametrize("steps", [12, 4, 2])
def test_a_free_plate_turns_with_its_tool(steps):
    """At 7.5 degrees an increment the sheet was found half a turn away, with all points slipping towards its middle."""
    model, spin = carried()
    start = model.positions
    result = uf.solve(model, uf.Move(spin, 0.5 * np.pi, steps=steps), progress=False)
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(model.positions, start @ quarter.T, atol=1e-6 * SLIP)
    assert result["foot_slipping"].max() == 0
    assert abs(result["friction_work"][-1]) < 1e-12


def test_an_increment_that_turns_the_sheet_too_far_on_its_tool_is_cut_and_counted():
    model, spin = carried()
    model.fix(lambda x, y, z: z > -1.0, "xy", here=True)
    with pytest.raises(uf.errors.NoConvergence, match=r"turns on foot by \d+ degrees"):
        uf.solve(model, uf.Move(spin, 1.0, steps=1, cuts=0), progress=False)
    result = uf.solve(model, uf.Move(spin, 1.0, steps=1), progress=False)
    assert len(result) == 3  # two halves of 29 degrees
    assert result["foot_slipping"][-1] == result["foot_active"][-1]
    assert result.timing.attempts.causes["sheet turns on a tool"] > 0


def wrapped(radius=10.0):
    """The plate around a cylinder of this radius, pressed to it and held by friction alone."""

    def wrap(x):
        angle, r = x[:, 0] / radius, radius + x[:, 2]
        return np.column_stack([r * np.sin(angle), x[:, 1], r * np.cos(angle)])

    plate = uf.mesh.strip(4.0, 2.0, 0.5, (4, 2)).transformed(lambda x: np.add(x, (-2.0, -1.0, 0.25)))
    return uf.Model(plate.transformed(wrap), material=uf.SVK(E=1e5, nu=0.3))


@pytest.mark.parametrize("steps", [18, 4, 2])
def test_a_curved_plate_goes_round_with_a_cylinder_without_an_attempt_that_fails(steps):
    """A straight guess ends 0.04 beside the arc at 5 degrees, forty times the slip: all points slipped, none held."""
    model = wrapped()
    tool = model.tool("drum", uf.Cylinder((0, 0, 0), "y", 10.0))
    model.contact("lower", tool, penalty=1e3, points=2, friction=0.2, slip=SLIP, name="foot")
    press, spin = model.pressure("upper", "press"), model.turn(tool, "y", name="spin")
    uf.solve(model, uf.Move(press, 1.0, steps=2), progress=False)
    start = model.positions
    result = uf.solve(model, uf.Move(spin, 0.5 * np.pi, steps=steps), progress=False)
    quarter = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    np.testing.assert_allclose(model.positions, start @ quarter.T, atol=1e-9 * SLIP + 1e-11)
    assert len(result) == steps + 1
    assert result.timing.attempts.discarded == 0
    assert result["iterations"][1:].max() <= 6


def test_the_straight_way_of_a_screw_is_its_logarithm():
    """The motion over a part of the time, again and again, ends where the whole of it does."""
    turn = uf.surfaces.directions.rotation_matrix(np.array([0.3, -0.9, 0.4]))
    screw, x = Screw.of(turn, np.array([1.0, 2.0, -0.5])), np.array([[0.3, 0.1, -2.0], [4.0, 0.0, 1.0]])
    place, parts = x.copy(), 4096
    for _ in range(parts):  # the midpoint rule
        middle = place + 0.5 / parts * screw.straight(place)
        place = place + screw.straight(middle) / parts
    np.testing.assert_allclose(place, x @ turn.T + screw.s, atol=1e-6)
    np.testing.assert_allclose(screw.straight(x) + screw.beyond(x, screw.straight(x)), x @ turn.T + screw.s - x)
    np.testing.assert_allclose(screw.arrival(x @ turn.T + screw.s), x @ turn.T + screw.s - x)
    still = Screw.of(np.eye(3), np.array([1.0, 0.0, 0.0]))
    np.testing.assert_array_equal(still.straight(x), [[1.0, 0.0, 0.0]] * 2)


def test_a_guess_goes_round_only_where_the_sheet_does_and_supports_let_it():
    model, spin = carried()
    last, x = model.evaluate(model.system.x), model.positions
    goal = model.state.toward({spin.name: 0.2})
    way = np.cross([0.0, 0.0, 0.2], x)
    c, s = np.cos(0.2), np.sin(0.2)
    end = x @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T
    np.testing.assert_allclose(way.ravel() + around(model, goal, last, way.ravel()), (end - x).ravel(), atol=1e-14)
    assert around(model, goal, last, 0.3 * way.ravel()) is None  # it slips
    assert around(model, goal, last, np.zeros_like(model.system.x)) is None
    corner = model.mesh.points[:, :2].sum(axis=1).argmin()
    model.fix(np.array([corner]), "x")
    assert around(model, goal, last, way.ravel()) is None
