"""A pressed tool that is flush with the sheet but for round-off touches it; one that stands off does not."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.errors import NoConvergence


def pressed(gap: float, **spring: float) -> tuple[uf.Model, uf.Move]:
    """A block under a plate that stands at a gap, pressed or on a spring."""
    model = uf.Model(uf.mesh.strip(2.0, 1.0, 1.0, (2, 1)), material=uf.SVK(E=1000.0, nu=0.0))
    for nodes, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(nodes, normal)
    plate = model.tool("plate", uf.Plane((0.0, 0.0, 0.5 + gap), (0.0, 0.0, -1.0)))
    model.contact("upper", plate, name="on_plate", penalty=1e5)
    if spring:
        return model, uf.Move(model.spring(plate, "z", name="hold", **spring), 0.0, steps=1)
    return model, uf.Move(model.press(plate, "z", name="hold"), -2.0, steps=1)


@pytest.mark.parametrize("gap", [0.0, 1e-13, 9e-7])
def test_a_flush_tool_presses(gap):
    result = uf.solve(*pressed(gap), progress=False)
    assert result["plate_fz"][-1] == pytest.approx(2.0, rel=1e-9)
    assert result["hold_way"][0] == pytest.approx(-gap - (1e-9 if gap else 0.0), rel=1e-6, abs=1e-15)
    assert result["hold_way"][-1] == pytest.approx(-gap - 1e-3 - 1e-5, rel=2e-3)


def test_a_flush_tool_on_a_spring_gives_the_answer_of_one_that_touches():
    stiff = {"stiffness": 10.0, "preload": -2.0}
    one, other = (uf.solve(*pressed(gap, **stiff), progress=False) for gap in (0.0, 1e-10))
    assert one["plate_fz"][-1] == pytest.approx(other["plate_fz"][-1], rel=1e-7)
    assert other["plate_fz"][-1] > 1.9


def test_a_tool_that_stands_off_stays_where_it_is():
    with pytest.raises(NoConvergence) as failed:
        uf.solve(*pressed(1e-5), progress=False)
    assert failed.value.result["hold_way"][0] == 0.0


def test_a_tool_on_the_wrong_side_or_across_does_not_move():
    model, step = pressed(1e-10)
    press = model.tools[0].presses[0]
    object.__setattr__(press.way, "direction", np.array([1.0, 0.0, 0.0]))
    with pytest.raises(NoConvergence):
        uf.solve(model, step, progress=False)
    assert press.unknown.value == 0.0
