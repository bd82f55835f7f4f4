"""Results of the evaluation of a contact at its points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.model.terms.term import Found

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ContactPoints:
    """Results at the contact points of a pair.

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
        Reference area of the point.
    friction : ndarray, shape (n, 3), optional
        Tangential traction of the tool on the sheet, on the reference area; None without friction.
    slip : ndarray, shape (n,), optional
        Distance slid so far by held points.
    status : ndarray of uint8, shape (n,), optional
        0 for open points, 1 for sticking ones, 2 for slipping ones.
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
        """The available arrays by name."""
        return {name: values for name, values in vars(self).items() if values is not None}


@dataclass(frozen=True)
class ContactFound(Found):
    """Results of the evaluation of a contact; later evaluations of the model do not change them.

    The results at held points are copied. Positions, gaps and normals of all points follow from the displacement and
    the pose of the tool and are computed on demand, because most facets of a large sheet are far from the tool.

    Attributes
    ----------
    held : umform._core.ContactFound
        Results at the held points.
    measure : callable
        Returns positions (n, 3), gaps (n,) and normals (n, 3) of all points at the same displacement and pose.
    place : callable
        Returns the positions (k, 3) of some points, by their numbers (k,), in the frame of the tool.
    rotation : ndarray, shape (3, 3)
        Rotation of the tool.
    area : ndarray, shape (n,)
        Reference areas of all points.
    multiplier : ndarray, shape (n,)
        Pressures at zero penetration.
    penalty : float
        Pressure per penetration.
    has_friction : bool
        Whether there is friction.
    has_potential : bool
        Whether the energy follows from the pressures; that of cells is integrated along the path.
    own : callable, optional
        Energies per area (k,) of a contact law of the user at gaps (k,); None with a penalty.
    """

    held: Any = None
    measure: Callable[[], tuple[Floats, Floats, Floats]] = field(default=lambda: (np.empty(0),) * 3, repr=False)
    place: Callable[[NDArray[np.int64]], Floats] = field(default=lambda points: np.empty((0, 3)), repr=False)
    rotation: Floats = field(default_factory=lambda: np.eye(3), repr=False)
    area: Floats = field(default_factory=lambda: np.empty(0), repr=False)
    multiplier: Floats = field(default_factory=lambda: np.empty(0), repr=False)
    penalty: float = 0.0
    has_friction: bool = False
    has_potential: bool = True
    own: Callable[[Floats], Floats] | None = field(default=None, repr=False)

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
        """Mask of the points held by the tool."""
        return self.status > 0

    @cached_property
    def status(self) -> NDArray[np.uint8]:
        """0 for open points, 1 for points that the tool holds, 2 for those that also slip along it."""
        return np.asarray(self.held.active)

    @cached_property
    def slipping(self) -> NDArray[np.bool_]:
        """Mask of the points that slip, at the friction limit."""
        slipping: NDArray[np.bool_] = self.status == 2
        return slipping

    @property
    def friction_work(self) -> float:
        """Work of friction so far."""
        return float(self.held.friction_work)

    def _spread(self, values: Floats) -> Floats:
        """Expand values at the held points to all points, zero elsewhere."""
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
        """Part of the area of each point in contact: 0 or 1, for cells also between."""
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
        """Positions, gap, pressure, normal and area of all points; with friction also traction, slip and status."""
        plain = ContactPoints(self.x, self.gap, self.pressure, self.normal, self.area)
        if not self.has_friction:
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
        """Traction per elastic slip of the held points, zero elsewhere, shape (n,). eq. (4.174)"""
        return self._spread(self.held.tangential_stiffness)

    @cached_property
    def slip(self) -> Floats:
        """Distances slid so far by the held points, zero elsewhere, shape (n,)."""
        return self._spread(self.held.slip)

    def resultant(self, about: Floats | None = None) -> tuple[Floats, Floats]:
        """Resultant of the contact tractions. eq. (4.17)

        Parameters
        ----------
        about : array_like, shape (3,), optional
            Reference point of the moment; default the origin.

        Returns
        -------
        force, moment : ndarray, shape (3,)
            Acting from the sheet on the tool.
        """
        arm = self.held.x if about is None else self.held.x - np.asarray(about, dtype=float)
        return self.held.force.sum(axis=0), moment(arm, self.held.force)

    @property
    def held_force(self) -> float:
        """Sum of the magnitudes of the normal forces at all points."""
        return float(self.held.pressure @ self.held.area)

    def energy(self) -> float:
        """Potential of penalty and multipliers, (p^2 - lambda^2) / (2 penalty) over the reference area. eq. (4.32)

        For cells the work of the pressure so far, eq. (4.89). With friction also the energy of the elastic slip.
        """
        if not self.has_potential:
            return float(self.held.contact_work + self.held.stored)
        return self.energy_of_penetration() + float(self.held.stored)

    def energy_of_penetration(self) -> float:
        """(p^2 - lambda^2) / (2 penalty) over the reference area; for cells of their mean pressures. eq. (4.32)"""
        if self.own is not None:
            return float((self.held.share * self.held.area) @ self.own(self.held.gap))
        # (p - lambda)(p + lambda): exactly zero for a point that is held by its multiplier alone.
        difference, total = self.pressure - self.multiplier, self.pressure + self.multiplier
        return 0.5 / self.penalty * float((difference * self.area) @ total)

    def work_of_touch(self, before: ContactFound) -> float:
        """Work of points that touch or leave within an increment, less that of the mean of both ends. eq. (5.104)

        Parameters
        ----------
        before : ContactFound
            The converged state at the beginning.
        """
        points = np.flatnonzero(self.active != before.active) if self.has_potential else np.zeros(0, dtype=int)
        if points.size == 0:
            return 0.0
        way = self.place(points) - before.place(points)
        mean = 0.5 * (self._pressed(points) + before._pressed(points))
        gained = self._potential(points) - before._potential(points)
        return float(self.area[points] @ (gained + (mean * way).sum(axis=1)))

    def _pressed(self, points: NDArray[np.int64]) -> Floats:
        """Normal tractions of the tool on the sheet at some points in the frame of the tool, shape (k, 3)."""
        return (self.pressure[:, None] * self.held_normal)[points] @ self.rotation

    def _potential(self, points: NDArray[np.int64]) -> Floats:
        """Energy of penalty and multipliers per area at some points. eq. (4.32)"""
        if self.own is not None:
            return np.where(self.active[points], self.own(self.held_gap[points]), 0.0)
        p, multiplier = self.pressure[points], self.multiplier[points]
        return 0.5 / self.penalty * (p - multiplier) * (p + multiplier)

    def work_of_stiffening(self, before: ContactFound) -> float:
        """Work of a penalty or of multipliers that have changed since the last converged state. eqs. (4.201), (4.240)

        Cells count it themselves.
        """
        if not self.has_potential:
            return 0.0
        p, p_before = self.pressure, before.pressure
        both = np.where(self.active & before.active, self.area, 0.0)

        def at(multiplier: Floats, penalty: float) -> float:
            return 0.5 / penalty * float(both @ ((multiplier - p_before) * (multiplier - p)))

        return at(self.multiplier, self.penalty) - at(before.multiplier, before.penalty)


def moment(arms: Floats, forces: Floats) -> Floats:
    """Sum of the cross products of arms and forces, both of shape (n, 3)."""
    products = arms.T @ forces
    return np.array([products[1, 2] - products[2, 1], products[2, 0] - products[0, 2], products[0, 1] - products[1, 0]])
