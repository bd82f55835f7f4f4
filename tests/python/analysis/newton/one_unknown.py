"""Systems of one unknown for tests of Newton's method."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from umform.ranks import ONE
from umform.solvers import Pattern


class Evaluated(SimpleNamespace):
    """An evaluation that gives its tangent away."""

    def without_tangent(self):
        return Evaluated(**vars(self) | {"values": np.empty(0)})


class OneUnknown:
    """What Newton's method asks a system of one unknown besides its evaluation."""

    extent = 1.0
    elastic = smooth = False
    ranks = ONE

    def __init__(self, start):
        self.x = np.array([start])
        self.pattern = Pattern(1, np.array([0, 1], dtype=np.int32), np.array([0], dtype=np.int32), True)

    def restrict(self, r):
        return r

    coefficients = extend = restrict

    def resultants(self, evaluation):
        return 0.0, 0.0

    def largest_entry(self, values):
        return float(np.abs(values).max())

    @property
    def state(self):
        return SimpleNamespace(x=self.x)

    def state_at(self, x, goal):
        return x

    def prescribed_displacement(self, goal):
        return np.zeros(1)

    def displacement_of_supports(self, values):
        return np.zeros(1)
