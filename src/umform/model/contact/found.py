"""What the evaluation of a contact has found at its points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.model.term import Found

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ContactPoints:
    """What is known at the contact points of a pair.

    Attributes
    ----------
    x : ndarray, shape (n, 3)
        Current positions.
    gap : ndarray, shape (n,)
        Signed distance, negative in penetration.
    pressure : ndarray, shape (n,)
        Contact pressure on the reference area, zero without contact.
    normal : ndarray, shape (n, 3)
        Unit normal out of the tool.
    area : ndarray, shape (n,)
        Reference area that belongs to the point.
    """

    x: Floats
    gap: Floats
    pressure: Floats
    normal: Floats
    area: Floats


@dataclass(frozen=True)
class ContactFound(Found):
    """What the evaluation of a contact has found; it stays what it is when the model is evaluated again.

    Attributes
    ----------
    x, gap, normal, area : ndarray
        At the contact points, see :class:`ContactPoints`.
    multiplier : ndarray, shape (n,)
        Pressures that are there without a penetration.
    penalty : float
        Pressure per penetration.
    """

    x: Floats = None  # type: ignore[assignment]
    gap: Floats = None  # type: ignore[assignment]
    normal: Floats = None  # type: ignore[assignment]
    area: Floats = None  # type: ignore[assignment]
    multiplier: Floats = None  # type: ignore[assignment]
    penalty: float = 0.0

    @cached_property
    def shifted_gap(self) -> Floats:
        """Gap less multiplier over penalty: where it is not positive a point is held. eq. (4.33)"""
        return self.gap - self.multiplier / self.penalty

    @property
    def active(self) -> NDArray[np.bool_]:
        """Which points are held by the tool."""
        return self.shifted_gap <= 0.0

    @cached_property
    def pressure(self) -> Floats:
        """Contact pressure on the reference area, shape (n,). eqs. (4.6), (4.33)"""
        return self.penalty * np.maximum(-self.shifted_gap, 0.0)

    @cached_property
    def traction(self) -> Floats:
        """Traction of the sheet on the tool on the reference area, shape (n, 3)."""
        return -self.pressure[:, None] * self.normal

    @cached_property
    def forces(self) -> Floats:
        """Forces of the sheet on the tool at the points, shape (n, 3)."""
        return -(self.pressure * self.area)[:, None] * self.normal

    @property
    def penetration(self) -> float:
        """Largest penetration."""
        return float(max(0.0, -self.gap.min(initial=np.inf)))

    def points(self) -> ContactPoints:
        """Positions, gap, pressure, normal and area."""
        return ContactPoints(self.x, self.gap, self.pressure, self.normal, self.area)

    def resultant(self, about: Floats | None = None) -> tuple[Floats, Floats]:
        """Resultant of the contact pressure. eq. (4.17)

        Parameters
        ----------
        about : array_like, shape (3,), optional
            Point that the moment is about; default the origin.

        Returns
        -------
        force, moment : ndarray, shape (3,)
            Of the sheet on the tool.
        """
        arm = self.x - (np.zeros(3) if about is None else np.asarray(about, dtype=float))
        return self.forces.sum(axis=0), np.cross(arm, self.forces).sum(axis=0)

    def energy(self) -> float:
        """Potential of penalty and multipliers, (p^2 - lambda^2) / (2 penalty) over the reference area. eq. (4.32)"""
        # (p - lambda)(p + lambda): a point that its multiplier alone holds has no energy, to the last digit.
        difference, total = self.pressure - self.multiplier, self.pressure + self.multiplier
        return 0.5 / self.penalty * float((difference * self.area) @ total)
