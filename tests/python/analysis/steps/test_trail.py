"""What the start of an increment follows from: the last increments, and whether a step goes on where they led."""

from __future__ import annotations

import numpy as np
import pytest

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.analysis.steps.trail import Trail, changes
from umform.errors import InvalidValue
from umform.model.terms.control import Control

WAY = np.array([1.0, 0.0])


def test_the_guess_is_exact_on_a_parabola_whatever_the_increments():
    rates, curvatures = np.random.default_rng(0).normal(size=(2, 7))
    times = np.array([0.0, 0.3, 0.5, 1.2])
    states = rates * times[:, None] + curvatures * times[:, None] ** 2
    increments, sizes = np.diff(states, axis=0), np.diff(times)
    trail = Trail.of(increments[0], WAY, None, None)
    np.testing.assert_allclose(trail.guess(2.0), 2.0 * increments[0])  # a line, as long as nothing else is known
    trail = Trail.of(increments[1], WAY, trail, sizes[1] / sizes[0])
    np.testing.assert_allclose(trail.guess(sizes[2] / sizes[1]), increments[2], rtol=1e-12)


def test_a_start_from_the_tangent_forgets_the_curvature():
    trail = Trail.of(np.ones(3), WAY, Trail.of(np.zeros(3), WAY, None, None), None)
    np.testing.assert_array_equal(trail.guess(1.0), np.ones(3))


def test_the_size_of_an_increment_is_the_change_of_the_controls():
    trail = Trail.of(np.zeros(3), np.array([-0.2, 0.4]), None, None)
    assert trail.size(np.array([-0.1, 0.2])) == pytest.approx(2.0)
    assert trail.size(np.array([0.1, -0.2])) is None  # back
    assert trail.size(np.array([-0.1, 0.1])) is None  # elsewhere
    assert trail.size(np.zeros(2)) is None
    still = Trail.of(np.zeros(3), np.zeros(2), None, None)
    assert still.size(np.array([0.1, 0.0])) is None


def test_changes_are_in_the_order_of_the_model():
    a, b, c = (Control(name) for name in "abc")
    np.testing.assert_array_equal(changes([a, b, c], [c, a], np.array([3.0, 1.0])), [1.0, 0.0, 3.0])


@pytest.fixture
def starts(monkeypatch):
    """Whether each attempt of Newton's method began with an extrapolation."""
    from umform.analysis.newton.newton import Newton

    original, seen = Newton.solve, []

    def watched(self, goal, extrapolation=None, mode=None, beyond=None, keep=False):
        seen.append(extrapolation)
        return original(self, goal, extrapolation, mode, beyond, keep)

    monkeypatch.setattr(Newton, "solve", watched)
    return seen


def bent(build, order, *steps):
    case = build.free_bending((8, 1), thickness_order=1, thickness_points=5)
    options = NewtonOptions(residual=1e-12, extrapolate=order)
    moves = [Move(case.punch, to, steps=count) for to, count in steps]
    return solve(case.model, moves, options=options, frames=0)


def test_a_parabola_takes_fewer_iterations_to_the_same_answer(build):
    line, parabola = (bent(build, order, (-3.0, 30)) for order in (1, 2))
    np.testing.assert_allclose(parabola.model.u, line.model.u, atol=1e-8)
    assert parabola["iterations"].sum() < 0.95 * line["iterations"].sum()


def test_a_move_that_goes_on_the_same_way_begins_with_the_increments_of_the_one_before(build, starts):
    whole = bent(build, 2, (-1.6, 8))
    first, first_starts = whole.model.u, list(starts)
    starts.clear()
    parts = bent(build, 2, (-0.8, 4), (-1.6, 4))
    assert parts["iterations"].sum() == whole["iterations"].sum()
    np.testing.assert_allclose(parts.model.u, first, rtol=1e-9, atol=1e-12)
    for one, other in zip(starts, first_starts, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize(("order", "to", "more"), [(2, -2.2, 0), (2, -1.9, 1), (1, -2.2, 1)])
def test_other_moves_begin_from_the_tangent(build, order, to, more):
    before, both = (bent(build, order, *steps) for steps in ([(-2.0, 10)], [(-2.0, 10), (to, 1)]))
    assert both.timing.attempts.tried["tangent"] - before.timing.attempts.tried["tangent"] == more
    assert both.timing.attempts.tried["extrapolation"] - before.timing.attempts.tried["extrapolation"] == 1 - more


@pytest.mark.parametrize("order", [-1, 3, 1.5])
def test_there_are_lines_and_parabolas_only(order):
    with pytest.raises(InvalidValue, match="parabola"):
        NewtonOptions(extrapolate=order)
