"""Where equilibrium jumps: springs hold the sheet back, follow it, and are gone at the next equilibrium."""

from __future__ import annotations

import numpy as np

import umform as uf
from umform.solution.habits import Habits
from umform.solution.held_back import HeldBack
from umform.solution.records import Cause


def ubend(points, friction=None):
    """Half of a small U-bend in plane strain, on 2 mm elements."""
    mesh = uf.mesh.strip(60.0, 1.0, 1.0, (30, 1)).transformed(lambda x: np.add(x, (0.0, 0.0, 0.5)))
    steel = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(565.32, 0.007117, 0.2589))
    model = uf.Model(mesh, "BEND8", material=steel)
    model.symmetry("x0", "x")
    model.fix(lambda x, y, z: x > -1.0, "y")
    rule = {"points": points, "friction": friction, "penetration": 0.02}
    model.contact("lower", uf.UDie(34.0, 100.0, 4.0, 4.0), name="die", **rule)
    holder = model.contact("upper", uf.Plane((0, 0, 2.0), (0, 0, -1)), name="holder", **rule)
    punch = model.contact("upper", uf.Box((0, 0, 51.0), (31.0, 100.0, 100.0), 4.0), name="punch", **rule)
    hold, stroke = model.press(holder, "z", "hold"), model.drive(punch, "z", "stroke")
    return model, [uf.Close(hold, force=-10.0), uf.Move(stroke, to=-8.0)]


def test_a_draw_goes_on_behind_a_jump():
    """With 3 x 3 points the radius lets go of its last row of points at 7.34 mm, and the force falls by a tenth."""
    model, steps = ubend(3)
    result = uf.solve(model, steps, progress=False)
    attempts = result.timing.attempts
    assert result["stroke"][-1] == -8.0
    assert attempts.won["held back"] == attempts.tried["held back"] == 1
    jump = int(result["iterations"].argmax())
    force, way = result["punch_fz"], result["hold_way"]
    assert 7.3 < -result["stroke"][jump] < 7.4
    assert abs(np.diff(result["stroke"])[jump - 1]) < 0.02
    assert force[jump] < 0.92 * force[jump - 1]
    assert abs(way[jump] - way[jump - 1]) > 0.03
    np.testing.assert_allclose(result["holder_fz"][1:][result["step"][1:] == 2], 10.0, rtol=1e-6)
    assert result.balance().force_imbalance[-1] < 1e-9  # no spring is left


def test_springs_are_a_consistent_term():
    """Residual and tangent against differences; at their origin they have no force."""
    model, _ = ubend(2)
    springs = HeldBack(model)
    springs.stiffness = 1e3
    x = 1e-4 * np.random.default_rng(3).normal(size=model.x.size)
    springs.origin = x[: model.u.size] + 1e-3
    plain, held = model.evaluate(x), springs.evaluate(x)
    change = (held.residual - plain.residual)[: model.u.size]
    scale = np.abs(plain.residual).max()
    np.testing.assert_allclose(change, -1.0, atol=1e-12 * scale)
    np.testing.assert_allclose(springs.forces(x[: model.u.size] + 1e-3), 0.0, atol=1e-12)
    added = held.values - plain.values
    assert np.count_nonzero(added) == len(model.own_diagonal) == model.pattern.n
    np.testing.assert_allclose(added[model.own_diagonal], 1e3, rtol=1e-6)


def test_an_increment_is_stuck_after_two_cycles_at_short_intervals():
    habits = Habits()
    cycle, stall = {"extrapolation": Cause.CYCLE, "tangent": Cause.STALL}, {"tangent": Cause.STALL}
    for cut, increments, stuck in ((cycle, 3, False), (stall, 0, False), (cycle, 1, False), (cycle, 0, True)):
        habits.learn_of_cut(cut)
        assert habits.stuck is stuck
        for _ in range(increments):
            habits.learn({}, "tangent", 0)
    habits.learn_of_cut({**cycle, "held back": Cause.STALL})  # it did not help: not at once again
    assert not habits.stuck
    habits.learn_of_cut(cycle)
    habits.learn_of_cut(cycle)
    assert habits.stuck
    habits.learn({}, "held back", 0)
    assert not habits.stuck
