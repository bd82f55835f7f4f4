"""The work of points that touch or leave within an increment, and of multipliers. eqs. (5.104), (4.240)"""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf


def pressed(*, gap=0.3, touched=0.01, back=False, steps=1, **rule):
    """A soft block under a flat tool that is above it by a gap, in one increment."""
    model = uf.Model(uf.mesh.strip(4.0, 4.0, 2.0, (2, 2)), material=uf.SVK(E=100.0, nu=0.0))
    model.fix("lower", "z")
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    tool = model.tool("plate", uf.Plane((0.0, 0.0, 1.0 + gap), (0.0, 0.0, -1.0)))
    model.contact("upper", tool, name="on_plate", **{"penalty": 1e3, "points": 2, **rule})
    stroke, way = model.drive(tool, "-z", "stroke"), gap + touched
    moves = [uf.Move(stroke, way, steps=steps), *([uf.Move(stroke, 0.0, steps=1)] if back else [])]
    return uf.solve(model, moves, frames=0, progress=False)


def test_a_block_that_is_touched_within_an_increment_gets_the_work_of_the_way_in_touch():
    """Trapezoids of the force over the whole way have 31 times as much: (gap + way in touch) / way in touch."""
    result = pressed()
    balance = result.balance()
    force = abs(result["stroke_force"][-1])
    assert balance.works["plate"][-1] == pytest.approx(0.5 * force * 0.31)
    assert balance.external_work[-1] == pytest.approx(0.5 * force * 0.01, rel=0.004)
    assert np.abs(balance.drift).max() < 0.004  # of the strains of Green


def test_a_tool_that_leaves_within_an_increment_gives_all_work_back():
    balance = pressed(back=True).balance()
    assert abs(balance.external_work[-1]) < 0.004 * balance.external_work[1]
    assert np.abs(balance.drift).max() < 0.004


@pytest.mark.parametrize("rule", [{"points": 2}, {"points": "nodes"}, {"points": 3, "friction": 0.2}])
def test_the_drift_does_not_depend_on_the_gap(rule):
    drifts = [np.abs(pressed(gap=gap, **rule).balance().drift).max() for gap in (0.0, 0.1, 0.5)]
    np.testing.assert_allclose(drifts, drifts[0], atol=1e-6)


def test_cells_measure_the_work_of_their_pressure_themselves():
    (pair,) = pressed(points=None, cells=2).model.contacts
    assert pair.work_of_touch == 0.0


def test_multipliers_put_no_energy_in_that_is_not_counted():
    """The allowed penetration is a twentieth of the compression; without (4.240) the drift is that."""
    result = pressed(gap=0.0, touched=0.1, steps=4, penalty=200.0, penetration=0.005, augmented=True)
    assert result["on_plate_penetration"].max() > 0.001
    assert np.abs(result.balance().drift).max() < 0.004
