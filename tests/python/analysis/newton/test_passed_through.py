"""A sheet that has gone through a tool between two states is refused; one that slides over an edge is not."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from umform.analysis.newton.passed_through import _through

UP, DOWN = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)


def points(x, gap, normal):
    return SimpleNamespace(x=np.array([x, (5.0, 0.0, 9.0)]), gap=np.array([gap, 9.0]), normal=np.array([normal, UP]))


@pytest.mark.parametrize(
    ("now", "through"),
    [
        (((0, 0, -1.5), 0.5, DOWN), True),  # a tool of thickness 0.5 between the two places
        (((0, 0, -1.5), 0.5, UP), False),  # the tool went along
        (((0, 0, -0.1), 0.1, DOWN), False),  # over a sharp edge: not farther than half the thickness
        (((0, 0, -0.9), -0.01, DOWN), True),  # held from the wrong side
        (((0, 0, -1.5), 4.0, DOWN), False),  # too far away from what it would have passed
    ],
)
def test_through(now, through):
    before = points((0, 0, 0.2), 0.2, UP)
    assert _through(before, points(*now), least=0.5) == through


def test_nothing_that_keeps_its_side_is_measured():
    before = points((0, 0, 0.2), 0.2, UP)
    now = SimpleNamespace(normal=before.normal)
    assert not _through(before, now, least=0.5)
