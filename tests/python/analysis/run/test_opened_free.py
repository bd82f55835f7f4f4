"""A part that no tool touches any more, as a cup that is drawn through its die, is opened on its gauge."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.errors import RigidBodyMotion


def untouched() -> tuple[uf.Model, uf.Free]:
    """A sheet beside an open tool, with a gauge that waits."""
    model = uf.Model(uf.mesh.strip(2.0, 1.0, 0.5, (2, 1)), material=uf.SVK(E=1000.0, nu=0.3))
    plate = model.tool("plate", uf.Plane((0.0, 0.0, 1.0), (0.0, 0.0, -1.0)))
    model.contact("upper", plate, name="on_plate", penalty=1e5)
    gauge = model.hold_rigid(name="gauge")
    return model, uf.Free(plate, steps=2, on=gauge)


def test_the_gauge_of_the_first_step_holds_the_part():
    model, opening = untouched()
    result = uf.solve(model, opening, progress=False)
    assert len(result) == 3
    assert np.abs(model.u).max() == 0.0


def test_a_gauge_of_a_later_step_does_not():
    model, opening = untouched()
    model.carries_loose_sheet = False
    lift = uf.Move(model.force("upper", (0.0, 0.0, 1.0), "lift"), 1.0, steps=1)
    with pytest.raises(RigidBodyMotion):
        uf.solve(model, [lift, opening], progress=False)
