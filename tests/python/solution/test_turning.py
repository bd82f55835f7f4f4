"""A sheet that friction carries on a turning tool is found where it belongs, whatever the increments."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf

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
    start = model.mesh.points + model.u.reshape(-1, 3)
    result = uf.solve(model, uf.Move(spin, 0.5 * np.pi, steps=steps), progress=False)
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(model.mesh.points + model.u.reshape(-1, 3), start @ quarter.T, atol=1e-6 * SLIP)
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
