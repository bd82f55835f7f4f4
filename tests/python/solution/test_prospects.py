"""Iterations that are hopeless because of the negative pivots of the tangent."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from umform.solution.options import Wary
from umform.solution.prospects import Prospects
from umform.solution.records import Cause, Failed


def borne(wary, pivots, residuals):
    """How many tangents with so many negative pivots are borne."""
    prospects = Prospects(SimpleNamespace(smooth=True))
    for number, (count, residual) in enumerate(zip(pivots, residuals, strict=True)):
        try:
            prospects.bear(count, residual, wary, [])
        except Failed as failure:
            assert failure.cause is Cause.INDEFINITE
            assert str(count) in failure.reason
            return number
    return len(pivots)


@pytest.mark.parametrize(
    ("wary", "pivots", "far"),
    [
        (Wary.NOT, [0, 1, 5, 80], 4),
        (Wary.OF_ANY, [0, 0, 1, 0], 2),
        (Wary.OF_MORE, [0, 1, 5, 80], 2),
        (Wary.OF_MORE, [80, 9, 9, 3], 4),  # fewer, or as many
        (Wary.OF_MORE, [0, 3, 0, 7], 4),
        (Wary.OF_MORE, [None, None, 7, None], 4),  # a solver that does not tell
    ],
)
def test_how_many_negative_pivots_are_borne(wary, pivots, far):
    assert borne(wary, pivots, [1.0] * 4) == far
    assert borne(wary, pivots, [0.05] * 4) == 4  # near equilibrium all of them are


def prospects_of(smooth=False):
    return Prospects(SimpleNamespace(smooth=smooth, ranks=SimpleNamespace(any=bool, join=bytes)))


def test_iterations_on_the_way_down_from_the_end_of_a_stable_path_go_on_far_from_equilibrium():
    for wary in (Wary.OF_ANY, Wary.UNTIL_DOWNHILL):
        prospects = prospects_of()
        assert (prospects.jumps, prospects.most(25)) == (False, 25)
        prospects.bear(1, 0.05, wary, [])
        assert prospects.shifts(1, wary)
        if wary is Wary.UNTIL_DOWNHILL:
            prospects.bear(1, 0.8, wary, [])
            assert (prospects.jumps, prospects.most(25)) == (True, 100)
        else:
            with pytest.raises(Failed, match="far from equilibrium"):
                prospects.bear(1, 0.8, wary, [])


def test_a_start_far_from_equilibrium_is_no_way_down():
    with pytest.raises(Failed, match="far from equilibrium"):
        prospects_of().bear(1, 0.8, Wary.UNTIL_DOWNHILL, [])


@pytest.mark.parametrize(
    ("wary", "residual", "asked"),
    [
        (Wary.OF_ANY, 0.01, False),
        (Wary.NOT, 0.01, False),
        (Wary.UNTIL_DOWNHILL, 0.01, True),
        (Wary.UNTIL_DOWNHILL, 0.4, False),  # far from equilibrium
    ],
)
def test_the_symmetric_part_is_factorised_in_the_last_attempt_near_equilibrium(wary, residual, asked):
    assert prospects_of().asks(residual, wary) == asked


def test_the_symmetric_part_is_factorised_after_a_cycle_of_contact():
    prospects, residuals = prospects_of(), []
    for number in range(6):
        status = np.array([number % 2], dtype=np.uint8)
        evaluation = SimpleNamespace(status=status)
        assert not prospects.asks(1.0, Wary.OF_ANY)
        prospects.longest(evaluation, status, 1.0, residuals)
        residuals.append(SimpleNamespace(residual=1.0))
        if prospects.asks(1.0, Wary.OF_ANY):
            break
    assert number == 3  # two states, twice
    assert prospects.shifts(2, Wary.NOT)


def test_contact_of_an_undeformed_sheet_gets_more_iterations():
    system = SimpleNamespace(smooth=True)
    assert Prospects(system).most(25) == 25
    assert Prospects(system, patient=True).most(25) == 100
