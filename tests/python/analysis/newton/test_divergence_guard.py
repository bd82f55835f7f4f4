"""Iterations that are hopeless because of the negative pivots of the tangent."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from umform.analysis.newton.divergence_guard import DivergenceGuard
from umform.analysis.newton.options import IndefiniteTangent
from umform.results.records import Cause, Failed


def accepted(indefinite, pivots, residuals):
    """How many tangents with so many negative pivots are accepted."""
    guard = DivergenceGuard(SimpleNamespace(smooth=True), indefinite)
    for number, (count, residual) in enumerate(zip(pivots, residuals, strict=True)):
        try:
            guard.check_pivots(count, residual, [])
        except Failed as failure:
            assert failure.cause is Cause.INDEFINITE
            assert str(count) in failure.reason
            return number
    return len(pivots)


@pytest.mark.parametrize(
    ("indefinite", "pivots", "far"),
    [
        (IndefiniteTangent.IGNORED, [0, 1, 5, 80], 4),
        (IndefiniteTangent.STOPS, [0, 0, 1, 0], 2),
        (IndefiniteTangent.STOPS_IF_MORE, [0, 1, 5, 80], 2),
        (IndefiniteTangent.STOPS_IF_MORE, [80, 9, 9, 3], 4),  # fewer, or as many
        (IndefiniteTangent.STOPS_IF_MORE, [0, 3, 0, 7], 4),
        (IndefiniteTangent.STOPS_IF_MORE, [None, None, 7, None], 4),  # a solver that does not tell
    ],
)
def test_how_many_negative_pivots_are_accepted(indefinite, pivots, far):
    assert accepted(indefinite, pivots, [1.0] * 4) == far
    assert accepted(indefinite, pivots, [0.05] * 4) == 4  # near equilibrium all of them are


def guard_of(indefinite=IndefiniteTangent.IGNORED, smooth=False):
    return DivergenceGuard(SimpleNamespace(smooth=smooth, ranks=SimpleNamespace(any=bool, join=bytes)), indefinite)


def test_iterations_on_the_way_down_from_the_end_of_a_stable_path_go_on_far_from_equilibrium():
    for indefinite in (IndefiniteTangent.STOPS, IndefiniteTangent.STOPS_BEFORE_JUMP):
        guard = guard_of(indefinite)
        assert (guard.jumps, guard.iteration_limit(25, [], 1e-3)) == (False, 25)
        guard.check_pivots(1, 0.05, [])
        assert guard.shifts(1)
        if indefinite is IndefiniteTangent.STOPS_BEFORE_JUMP:
            guard.check_pivots(1, 0.8, [])
            assert (guard.jumps, guard.iteration_limit(25, [], 1e-3)) == (True, 100)
        else:
            with pytest.raises(Failed, match="far from equilibrium"):
                guard.check_pivots(1, 0.8, [])


def test_a_start_far_from_equilibrium_is_no_way_down():
    with pytest.raises(Failed, match="far from equilibrium"):
        guard_of(IndefiniteTangent.STOPS_BEFORE_JUMP).check_pivots(1, 0.8, [])


@pytest.mark.parametrize(
    ("indefinite", "residual", "asked"),
    [
        (IndefiniteTangent.STOPS, 0.01, False),
        (IndefiniteTangent.IGNORED, 0.01, False),
        (IndefiniteTangent.STOPS_BEFORE_JUMP, 0.01, True),
        (IndefiniteTangent.STOPS_BEFORE_JUMP, 0.4, False),  # far from equilibrium
    ],
)
def test_the_symmetric_part_is_factorised_in_the_last_attempt_near_equilibrium(indefinite, residual, asked):
    assert guard_of(indefinite).needs_symmetric_part(residual) == asked


def test_the_symmetric_part_is_factorised_after_a_cycle_of_contact():
    guard, residuals = guard_of(), []
    for number in range(6):
        status = np.array([number % 2], dtype=np.uint8)
        evaluation = SimpleNamespace(status=status)
        assert not guard.needs_symmetric_part(1.0)
        guard.longest_step(evaluation, 1.0, residuals)
        residuals.append(SimpleNamespace(residual=1.0))
        if guard.needs_symmetric_part(1.0):
            break
    assert number == 3  # two states, twice
    assert guard.shifts(2)


def test_contact_of_an_undeformed_sheet_gets_more_iterations():
    system = SimpleNamespace(smooth=True)
    assert DivergenceGuard(system).iteration_limit(25, [], 1e-3) == 25
    assert DivergenceGuard(system, extended=True).iteration_limit(25, [], 1e-3) == 100


def test_iterations_go_on_where_contact_settles_near_the_tolerance():
    guard = guard_of()
    for residual, left, limit in ((1e-1, 1, 25), (3.1e-3, 1, 25), (2.9e-3, 1, 50), (1e-4, 1, 50), (1e-4, 0, 25)):
        iterations = [SimpleNamespace(residual=residual, entered=0, left=left)]
        assert guard.iteration_limit(25, iterations, 1e-3) == limit
