"""Iterations that are hopeless because of the negative pivots of the tangent."""

from __future__ import annotations

from types import SimpleNamespace

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
