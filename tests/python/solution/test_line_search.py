"""Which increments are shortened. eq. (5.12)"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from umform.ranks import ONE
from umform.solution.line_search import shortened


class Kinked:
    """One unknown whose force changes from -1 to a stiff one at half of the increment."""

    ranks = ONE

    def __init__(self, stiffness):
        self.stiffness, self.lengths = stiffness, []

    def restrict(self, r):
        return r

    coefficients = restrict

    def shorten(self, part):
        self.lengths.append(part)

    def state_at(self, x, goal):
        return x

    def evaluate(self, u):
        return SimpleNamespace(
            x=u, residual=self.stiffness * np.maximum(u - 0.5, 0.0) - 1.0, failed=-1, force_scale=100.0
        )


@pytest.mark.parametrize(("near", "length"), [(0.0, 0.5), (0.02, 0.5), (0.2, 1.0)])
def test_near_equilibrium_an_increment_stays_whole_however_far_it_goes(near, length):
    system, u, du = Kinked(20.0), np.zeros(1), np.ones(1)
    _, accepted = shortened(system, None, u, du, np.array([-1.0]), system.evaluate(u + du), 1.0, near=near)
    assert accepted <= length
    assert (accepted == 1.0) == (length == 1.0)
    assert bool(system.lengths) == (length < 1.0)


def test_a_cell_that_failed_is_not_near():
    system = Kinked(1.0)
    failed = SimpleNamespace(residual=np.zeros(1), failed=3, force_scale=1.0)
    _, accepted = shortened(system, None, np.zeros(1), np.ones(1), np.array([-1.0]), failed, 1.0, near=1.0)
    assert accepted == 0.25
