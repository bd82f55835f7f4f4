"""Tractions under a tool that is pushed along a body, increment by increment."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.model import Model
from umform.model.contact import Contact
from umform.model.terms.control import Control

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Tractions:
    """Pressure and traction along x at the contact points that are held.

    Attributes
    ----------
    x : ndarray, shape (points, 1 or 2)
        Places along x from the centre of the pressure, and along y from a plane of symmetry.
    p, q : ndarray, shape (points,)
        Pressure, and traction along x.
    area : ndarray, shape (points,)
        Area of each point.
    """

    x: Floats
    p: Floats
    q: Floats
    area: Floats

    @property
    def normal_force(self) -> float:
        """Sum of the pressure."""
        return float(self.p @ self.area)

    def part(self, mu: float) -> float:
        """Q / (mu P)."""
        return abs(float(self.q @ self.area)) / (mu * self.normal_force)

    def spread(self, values: Floats) -> float:
        """Second moment of pressure or traction about the centre, over its sum."""
        weight = values * self.area
        return float(weight @ (self.x**2).sum(axis=1) / weight.sum())


def pushed(
    model: Model, contact: Contact, along: Control, ways: Floats, directions: int, options: NewtonOptions
) -> Iterator[Tractions]:
    """Push a tool along x; the tractions after each displacement, over one or two directions of the plane."""
    for moved in ways:
        solve(model, Move(along, float(moved), steps=1), progress=False, frames=0, options=options)
        held = contact.found.held
        p, area, n = np.asarray(held.pressure), np.asarray(held.area), np.asarray(held.normal)
        x = np.array(held.x)[:, :directions]
        x[:, 0] -= (p * area) @ x[:, 0] / float(p @ area)
        yield Tractions(x, p, -(np.asarray(held.traction) - p[:, None] * n)[:, 0], area)
