"""Where the tangent loses its stability, iterations go downhill to the next stable state. eq. (5.54)"""

from __future__ import annotations

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton.bordered import Bordered
from umform.analysis.newton.divergence_guard import DivergenceGuard
from umform.analysis.newton.line_search import lengthened
from umform.analysis.newton.options import IndefiniteTangent
from umform.analysis.newton.shift import Shift
from umform.analysis.newton.timed_solver import TimedSolver
from umform.results.records import Failed
from umform.solvers import Pattern, make_solver
from umform.timing import Timing

STROKE = 24.5


def bent(elements=60, friction=0.0):
    """A strip pushed into a round die by a cylinder: its legs slide over the shoulders, on a few points each."""
    mesh = uf.mesh.strip(60.0, 1.0, 1.0, (elements, 1)).moved((0.0, 0.0, 0.5))
    metal = uf.J2(E=70500.0, nu=0.342, hardening=uf.Swift(550.4, 0.0093, 0.223))
    model = uf.Model(mesh, "BEND8", material=metal)
    model.symmetry("x0", "x")
    model.fix(np.arange(len(mesh.points)), "y")
    die = model.tool("die", uf.UDie(50.0, 29.0, 4.0, 25.0))
    punch = model.tool("punch", uf.Cylinder((0.0, 0.0, 24.5), "y", 23.5))
    model.contact("lower", die, penalty=3000.0, points=3, friction=friction)
    model.contact("upper", punch, penalty=3000.0, points=3, friction=friction)
    return model, uf.Move(model.drive(punch, "-z", "stroke"), STROKE)


def test_a_strip_that_loses_its_hold_on_a_shoulder_jumps_to_the_next_stable_state():
    model, stroke = bent()
    result = uf.solve(model, stroke, progress=False, frames=0)
    assert result["stroke"][-1] == STROKE
    assert result.timing.attempts.share < 0.3
    assert np.abs(result.balance().drift).max() < 0.02


def test_so_does_one_with_an_unsymmetric_tangent():
    model, stroke = bent(24, friction=0.001)
    result = uf.solve(model, stroke, progress=False, frames=0)
    assert not model.system.pattern.symmetric
    assert result["stroke"][-1] == STROKE
    assert np.abs(result.balance().drift).max() < 0.02


def test_the_shift_leaves_no_negative_pivots_and_goes_downhill():
    n = 5
    rows = [np.arange(i, min(i + 2, n)) for i in range(n)]
    starts = np.cumsum([0] + [len(row) for row in rows])
    pattern = Pattern(n, starts.astype(np.int32), np.concatenate(rows).astype(np.int32), symmetric=True)
    K = np.diag([100.0, 90.0, -3e-3, 80.0, 70.0]) + np.diag(np.full(n - 1, 0.5), 1)
    values = np.concatenate([K[i, row] for i, row in enumerate(rows)])
    system = SimpleNamespace(pattern=pattern, largest_entry=lambda v: float(np.abs(v).max()))
    evaluation = SimpleNamespace(values=values, border=SimpleNamespace(unknowns=()))
    solver = Bordered(system, TimedSolver(make_solver(pattern, "multifrontal"), Timing()))
    assert solver.factor(evaluation).negative_pivots == 1
    kept, shift = values.copy(), Shift(system)
    assert shift.factor(solver, evaluation).negative_pivots == 0
    assert np.array_equal(values, kept)
    r = np.array([0.0, 0.0, 1e-3, 0.0, 0.0])
    du = solver.solve(-r)
    assert r @ du < 0.0
    assert 1e-3 / abs(du[2]) < 10 * 3e-3 + 1e-2  # the least of the shifts that will do, not any
    full = K + np.triu(K, 1).T
    shifted = -r - full @ du
    np.testing.assert_allclose(shifted / du, np.full(n, (shifted / du)[2]), rtol=1e-6)


def test_increments_near_a_saddle_are_doubled_until_the_slope_has_fallen():
    shortened = []
    system = SimpleNamespace(
        coefficients=lambda du: du,
        restrict=lambda r: r,
        ranks=SimpleNamespace(dot=lambda a, b: float(a @ b)),
        shorten=shortened.append,
        state_at=lambda u, goal: u,
        evaluate=lambda u, keep=False: SimpleNamespace(residual=u**3 - u, failed=-1, x=u, force_scale=1.0),
    )
    u, du = np.array([0.01]), np.array([0.02])
    evaluation, length = lengthened(system, None, u, du, u**3 - u, system.evaluate(u + du), 1.0)
    assert shortened[:6] == [2.0] * 6
    assert length == np.prod(shortened)
    assert 0.3 < evaluation.x[0] < 1.5


@pytest.mark.parametrize("shifted", [False, True])
def test_a_residual_that_grows_on_the_way_down_does_not_end_the_attempt(shifted):
    none = SimpleNamespace(status=np.zeros(0, dtype=np.uint8))
    system = SimpleNamespace(smooth=False, ranks=SimpleNamespace(any=bool))
    assert not DivergenceGuard(system).shifts(1)  # nothing has gone in a cycle, and the last state was not stable
    guard = DivergenceGuard(system, IndefiniteTangent.STOPS)
    assert not guard.shifts(0)  # the tangent is positive
    assert not shifted or guard.shifts(1)
    with nullcontext() if shifted else pytest.raises(Failed, match="has not fallen"):
        for k in range(20):
            guard.longest_step(none, 1.0 + k, [])
