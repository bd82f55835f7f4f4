"""Contact with tools of lines and arcs: the same as with a cylinder, and quadratic on shoulder, flank and tip."""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import Cylinder, Extruded, Profile, Punch, VDie

STEEL = mt.J2(kappa=175e3, mu=80.77e3, hardening=mt.Linear(160.0, 500.0))


def half_strip(length, cells, thickness=0.8, material=STEEL):
    """Half of a strip whose lower face is z = 0, free to slide along x, held at x = 0 by symmetry."""
    made = strip(length, 2.0, thickness, cells).moved((0.0, 0.0, thickness / 2))
    model = Model(made, "ANS3DEAS", material=material, thickness_points=5)
    model.symmetry("x0", normal="x")
    model.fix([0], "y")
    return model


def bend(model, die, stroke, steps, points=4):
    """Press the strip into a die by a punch."""
    model.contact("lower", die, penalty=200.0, points=points, name="die")
    tip = Punch(2.0, 60.0).moved((0.0, 0.0, 0.8))
    punch = model.drive(model.contact("upper", tip, penalty=200.0, points=4, name="punch"), "z", name="punch")
    return punch, solve(model, Move(punch, -stroke, steps=steps), frames=0)


def test_a_circle_is_a_cylinder_in_a_run():
    """To round-off of the sum; the law is elastic, so that nothing adds up from one increment to the next."""
    histories = []
    for tool in (Cylinder((8.0, 0, -5.0), "y", 5.0), Extruded(Profile.circle((8.0, -5.0), 5.0))):
        model = half_strip(12.0, (12, 1), material=mt.NeoHooke(E=5e3, nu=0.3))
        model.contact("lower", tool, penalty=100.0, points=3, name="tool")
        push = model.prescribe("x0_lower", "z", "push")
        result = solve(model, Move(push, -2.0, steps=10), frames=0)
        histories.append((result["push_force"], model.u))
    (force, u), (other_force, other_u) = histories
    assert abs(force[-1]) > 5.0
    np.testing.assert_allclose(other_force, force, rtol=1e-12, atol=1e-12 * np.abs(force).max())
    np.testing.assert_allclose(other_u, u, atol=1e-12 * np.abs(u).max())


@pytest.mark.parametrize("where", ["shoulder", "flank"])
def test_bending_in_a_v_die_converges_quadratically(where):
    if where == "shoulder":  # the strip rests on the shoulders and is drawn over them
        model = half_strip(16.0, (20, 1))
        punch, _ = bend(model, VDie(20.0, 90.0, 2.0, bottom_radius=1.0), 6.0, 40)
        x_range, n = (8.0, 11.0), None
    else:  # the end of a short strip slides down the flank
        model = half_strip(9.0, (12, 1))
        punch, _ = bend(
            model, VDie(20.0, 90.0, 1.0, bottom_radius=1.0, origin=(0.0, 0.0, 1.0 + 1e-4)), 2.5, 25, "nodes"
        )
        x_range, n = (5.0, 9.0), np.array([-1.0, 0.0, 1.0]) / np.sqrt(2)
    die = model.contacts[0]
    at = die.at_points()
    touching = die.active()
    assert touching.any()
    assert ((x_range[0] < at.x[touching, 0]) & (at.x[touching, 0] < x_range[1])).all()
    if n is not None:
        np.testing.assert_allclose(at.normal[touching], np.tile(n, (touching.sum(), 1)), atol=1e-12)
    force, on_punch = die.resultant()[0], model.contacts[1].resultant()[0]
    assert force[2] == pytest.approx(-on_punch[2], rel=1e-6)
    assert force[2] < -1.0
    punch.value -= 0.01
    records = Newton(model.system, NewtonOptions(residual=1e-12)).solve().iterations
    assert sum(record.entered + record.left for record in records[1:]) == 0
    norms = [record.residual for record in records if record.residual > 1e-11]
    assert len(norms) >= 3
    assert norms[-1] < 100.0 * norms[-2] ** 1.9
    assert len(records) <= 6
