"""What the evaluation of a contact has found at its points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

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
    friction : ndarray, shape (n, 3), optional
        Tangential traction of the tool on the sheet, on the reference area; None without friction.
    slip : ndarray, shape (n,), optional
        Distance slid so far by points that are held.
    status : ndarray of uint8, shape (n,), optional
        0 for points that are open, 1 for those that stick, 2 for those that slip.
    """

    x: Floats
    gap: Floats
    pressure: Floats
    normal: Floats
    area: Floats
    friction: Floats | None = None
    slip: Floats | None = None
    status: NDArray[np.uint8] | None = None

    def known(self) -> dict[str, Any]:
        """The arrays that there are, by their names."""
        return {name: values for name, values in vars(self).items() if values is not None}


@dataclass(frozen=True)
class ContactFound(Found):
    """What the evaluation of a contact has found; it stays what it is when the model is evaluated again.

    What belongs to the points that the tool holds is copied. Positions, gaps and normals of all points follow from the
    displacement and the pose of the tool, and are measured on demand: most facets of a large sheet are far
    from the tool.

    Attributes
    ----------
    held : umform._core.ContactFound
        What was found at the points that are held.
    measure : callable
        Returns positions (n, 3), gaps (n,) and normals (n, 3) of all points at the same displacement and pose.
    area : ndarray, shape (n,)
        Reference areas of all points.
    multiplier : ndarray, shape (n,)
        Pressures that are there without a penetration.
    penalty : float
        Pressure per penetration.
    rubs : bool
        Whether there is friction.
    has_potential : bool
        Whether the energy follows from the pressures; that of cells is measured along the way.
    """

    held: Any = None
    measure: Callable[[], tuple[Floats, Floats, Floats]] = field(default=lambda: (np.empty(0),) * 3, repr=False)
    area: Floats = field(default_factory=lambda: np.empty(0), repr=False)
    multiplier: Floats = field(default_factory=lambda: np.empty(0), repr=False)
    penalty: float = 0.0
    rubs: bool = False
    has_potential: bool = True

    @cached_property
    def _measured(self) -> tuple[Floats, Floats, Floats]:
        return self.measure()

    @property
    def x(self) -> Floats:
        """Positions of all points, shape (n, 3)."""
        return self._measured[0]

    @property
    def gap(self) -> Floats:
        """Signed distances of all points, negative in penetration, shape (n,)."""
        return self._measured[1]

    @property
    def normal(self) -> Floats:
        """Unit normals out of the tool at all points, shape (n, 3)."""
        return self._measured[2]

    @cached_property
    def active(self) -> NDArray[np.bool_]:
        """Which points are held by the tool."""
        return self.status > 0

    @cached_property
    def status(self) -> NDArray[np.uint8]:
        """0 for points that are open, 1 for those that the tool holds, 2 for those that slip along it as well."""
        return np.asarray(self.held.active)

    @cached_property
    def slipping(self) -> NDArray[np.bool_]:
        """Which points slip along the tool, at the bound of friction."""
        slipping: NDArray[np.bool_] = self.status == 2
        return slipping

    @property
    def friction_work(self) -> float:
        """Work of friction so far."""
        return float(self.held.friction_work)

    def _spread(self, values: Floats) -> Floats:
        """Values at all points from those at the points that are held, zero elsewhere."""
        full = np.zeros((self.area.size, *values.shape[1:]))
        full[self.held.points] = values
        return full

    @cached_property
    def pressure(self) -> Floats:
        """Contact pressure on the reference area at all points, shape (n,). eqs. (4.6), (4.33)"""
        return self._spread(self.held.pressure)

    @cached_property
    def traction(self) -> Floats:
        """Traction of the tool on the sheet on the reference area at all points, shape (n, 3)."""
        return self._spread(self.held.traction)

    @cached_property
    def forces(self) -> Floats:
        """Forces of the sheet on the tool at all points, shape (n, 3)."""
        return self._spread(self.held.force)

    @cached_property
    def held_gap(self) -> Floats:
        """Gaps of the points that are held, zero elsewhere, shape (n,)."""
        return self._spread(self.held.gap)

    @cached_property
    def share(self) -> Floats:
        """Part of the area of each point that is held: 0 or 1, and of a cell in between, shape (n,)."""
        return self._spread(self.held.share)

    @cached_property
    def held_normal(self) -> Floats:
        """Normals at the points that are held, zero elsewhere, shape (n, 3)."""
        return self._spread(self.held.normal)

    @property
    def penetration(self) -> float:
        """Largest penetration."""
        return float(self.held.penetration)

    def points(self) -> ContactPoints:
        """Positions, gap, pressure, normal and area of all points; with friction what it does there."""
        plain = ContactPoints(self.x, self.gap, self.pressure, self.normal, self.area)
        if not self.rubs:
            return plain
        return replace(plain, friction=self.friction, slip=self.slip, status=self.status.copy())

    @cached_property
    def friction(self) -> Floats:
        """Tangential traction of the tool on the sheet on the reference area at all points, shape (n, 3)."""
        return self._spread(self.held.traction - self.held.pressure[:, None] * self.held.normal)

    @cached_property
    def elastic_slip(self) -> Floats:
        """Elastic slip along the tool of the points that are held, zero elsewhere, shape (n, 3)."""
        return self._spread(self.held.elastic_slip)

    @cached_property
    def tangential_stiffness(self) -> Floats:
        """Traction per elastic slip of the points that are held, zero elsewhere, shape (n,). eq. (4.174)"""
        return self._spread(self.held.tangential_stiffness)

    @cached_property
    def slip(self) -> Floats:
        """Distances slid so far by the points that are held, zero elsewhere, shape (n,)."""
        return self._spread(self.held.slip)

    def resultant(self, about: Floats | None = None) -> tuple[Floats, Floats]:
        """Resultant of the contact tractions. eq. (4.17)

        Parameters
        ----------
        about : array_like, shape (3,), optional
            Point that the moment is about; default the origin.

        Returns
        -------
        force, moment : ndarray, shape (3,)
            Of the sheet on the tool.
        """
        arm = self.held.x if about is None else self.held.x - np.asarray(about, dtype=float)
        return self.held.force.sum(axis=0), moment(arm, self.held.force)

    @property
    def held_force(self) -> float:
        """Sum of the magnitudes of the normal forces at all points."""
        return float(self.held.pressure @ self.held.area)

    def energy(self) -> float:
        """Potential of penalty and multipliers, (p^2 - lambda^2) / (2 penalty) over the reference area. eq. (4.32)

        Of cells the work of the pressure so far, eq. (4.89). With friction that of the elastic slip as well.
        """
        if not self.has_potential:
            return float(self.held.contact_work + self.held.stored)
        # (p - lambda)(p + lambda): a point that its multiplier alone holds has no energy, to the last digit.
        difference, total = self.pressure - self.multiplier, self.pressure + self.multiplier
        return 0.5 / self.penalty * float((difference * self.area) @ total) + float(self.held.stored)


def moment(arms: Floats, forces: Floats) -> Floats:
    """Sum of the cross products of arms and forces, both of shape (n, 3)."""
    products = arms.T @ forces
    return np.array([products[1, 2] - products[2, 1], products[2, 0] - products[0, 2], products[0, 1] - products[1, 0]])
