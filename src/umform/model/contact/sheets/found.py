"""Results of the evaluation of a contact of sheets."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.model.contact.found import ContactPoints
from umform.model.terms.term import Found

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SideFound:
    """Results at the contact points of one side.

    Attributes
    ----------
    status : ndarray of uint8, shape (n,)
        0 for open points, 1 for held ones, 2 for those that also slip.
    facet : ndarray of int32, shape (n,)
        Facet of the other side below each point, -1 where none is near.
    gap : ndarray, shape (n,)
        Distance to the other side, negative in penetration; NaN where none is near.
    pressure : ndarray, shape (n,)
        Contact pressure on the reference area; what the other side finds there may differ from it.
    slip : ndarray, shape (n,)
        Distance slid along the other side so far.
    x, normal, traction : ndarray, shape (n, 3)
        Positions, unit normals out of the other side, tractions on this side.
    area : ndarray, shape (n,)
        Reference areas.
    contact_energy, stored, friction_work : float
        Energy of the penalty, energy of the elastic slip, work of friction so far, of the pass of this side.
    penetration : float
        The largest.
    round_off_squared : float
        See :class:`Found`.
    """

    status: NDArray[np.uint8]
    facet: NDArray[np.int32]
    gap: Floats
    pressure: Floats
    slip: Floats
    x: Floats
    normal: Floats
    traction: Floats
    area: Floats
    contact_energy: float
    stored: float
    friction_work: float
    penetration: float
    round_off_squared: float

    @property
    def active(self) -> NDArray[np.bool_]:
        """Mask of the points that the other side holds."""
        return self.status > 0

    @property
    def friction(self) -> Floats:
        """Tangential tractions on this side, shape (n, 3); zero at open points."""
        along = (self.traction * self.normal).sum(axis=1)
        return np.asarray(self.traction - along[:, None] * self.normal)


@dataclass(frozen=True)
class SheetsFound(Found):
    """Results of the evaluation of a contact of sheets; later evaluations do not change them.

    Attributes
    ----------
    sides : tuple of SideFound
        The two sides; one if a sheet touches itself.
    u : ndarray, shape (3 n,)
        Displacement of the evaluation.
    """

    sides: tuple[SideFound, ...] = ()
    u: Floats = field(default_factory=lambda: np.empty(0), repr=False)

    @cached_property
    def status(self) -> NDArray[np.uint8]:
        """0 for open points, 1 for held ones, 2 for those that also slip; one side after the other."""
        return np.concatenate([side.status for side in self.sides])

    @property
    def x(self) -> Floats:
        """Positions of all points."""
        return np.concatenate([side.x for side in self.sides])

    @property
    def penetration(self) -> float:
        """Largest penetration of both sides."""
        return max(side.penetration for side in self.sides)

    def points(self) -> ContactPoints:
        """Gap, pressure, friction, slip and status at all points, one side after the other."""
        names = [one.name for one in fields(ContactPoints)]
        return ContactPoints(*(np.concatenate([getattr(side, name) for side in self.sides]) for name in names))

    def sum(self, what: str) -> float:
        """Sum of a number of the sides."""
        return float(sum(getattr(side, what) for side in self.sides))

    @cached_property
    def force(self) -> Floats:
        """Force of the second side on the first one, shape (3,); zero if there is one side. eq. (4.307)"""
        total: Any = np.zeros(3)
        for sign, side in zip((0.5, -0.5), self.sides, strict=False):
            total = total + sign * (side.area @ side.traction)
        return np.asarray(total if len(self.sides) > 1 else np.zeros(3), dtype=float)
