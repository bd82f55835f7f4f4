"""A sheet that its tools hold only in another position starts with a rigid motion to it. eq. (4.260)"""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton.rigid_start import rigid_start


def between(below: float, above: float, *, fixed: str = "xy") -> uf.Model:
    """A sheet of thickness 1 that a plane below overlaps, and a plane above at a gap."""
    model = uf.Model(uf.mesh.strip(8.0, 1.0, 1.0, (4, 1)), material=uf.SVK(E=1000.0, nu=0.0))
    model.fix(np.arange(len(model.mesh.points)), fixed)
    model.contact("lower", uf.Plane((0.0, 0.0, -0.5 + below), (0.0, 0.0, 1.0)), name="under")
    model.contact("upper", uf.Plane((0.0, 0.0, 0.5 + above), (0.0, 0.0, -1.0)), name="over")
    return model


def test_the_sheet_goes_to_the_middle_of_two_tools_that_are_too_close():
    model = between(0.02, 0.01)
    start = rigid_start(model, model.state)
    np.testing.assert_allclose(start.reshape(-1, 3), np.tile([0.0, 0.0, 0.015], (20, 1)), atol=1e-12)


@pytest.mark.parametrize("given", [{"above": 0.03}, {"above": 0.01, "fixed": "xyz"}])
def test_there_is_no_such_motion_with_room_or_with_supports(given):
    model = between(0.02, **given)
    assert rigid_start(model, model.state) is None


def tipped() -> tuple[uf.Model, uf.Move]:
    """A flange beside a block: the pad above the block holds the sheet only after it has tipped by the gap."""
    mesh = uf.mesh.strip(40.0, 1.0, 1.0, (36, 1)).moved((-22.0, 0.0, 0.5))
    model = uf.Model(mesh, "BEND8", material=uf.J2(E=206e3, nu=0.3, hardening=uf.Linear(300.0, 900.0)))
    model.fix(np.arange(len(mesh.points)), "y")
    more = {"friction": 0.15, "points": 2}
    model.contact("lower", uf.WipingDie(4.9, origin=(0.0, 0.0, 0.0)), name="block", **more)
    model.contact("upper", uf.Box((-31.95, 0.0, 16.01), (56.1, 100.0, 29.98), 1.0), name="pad", **more)
    punch = model.tool("punch", uf.Box((21.0, 0.0, 21.0), (40.0, 100.0, 40.0), 2.2))
    model.contact("upper", punch, name="on_punch", **more)
    return model, uf.Move(model.drive(punch, "-z", name="stroke"), 0.4, steps=4)


def test_a_sheet_that_tips_within_the_gap_of_a_pad_finishes():
    result = uf.solve(*tipped(), frames=0, progress=False)
    assert result.timing.attempts.won["rigid motion"] == 1
    assert result["step"][-1] == 1 and result["stroke"][-1] == pytest.approx(0.4)
    assert result["pad_active"][1] > 0
    forces = [result[f"{tool}_fz"] for tool in ("block", "pad", "punch")]
    np.testing.assert_allclose(np.sum(forces, axis=0)[1:], 0.0, atol=1e-6 * np.abs(forces).max())
