"""Rigid motion of a part with its state: into other tools, or turned over."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Self

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class RigidMotion:
    """Positions x become Q x + c.

    History and enhanced parameters refer to the undeformed body and do not change, the stress rotates with the part,
    and the internal forces are multiplied by Q. eq. (5.91)

    Attributes
    ----------
    rotation : ndarray, shape (3, 3)
        Q, orthogonal.
    shift : ndarray, shape (3,)
        c.
    """

    rotation: Floats = field(default_factory=lambda: np.eye(3))
    shift: Floats = field(default_factory=lambda: np.zeros(3))

    @classmethod
    def in_section(cls, angle: float, start: Floats, end: Floats) -> Self:
        """Rotation in the xz-plane by an angle in radians, from x to z, that moves a point (x, z) to another one."""
        c, s = math.cos(angle), math.sin(angle)
        rotation = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])
        x, z = np.asarray(end) - rotation[::2, ::2] @ np.asarray(start)
        return cls(rotation, np.array([x, 0.0, z]))

    @property
    def back(self) -> RigidMotion:
        """The motion that undoes it."""
        return RigidMotion(self.rotation.T, -self.shift @ self.rotation)

    def after(self, first: RigidMotion) -> RigidMotion:
        """Another motion, then this one."""
        return RigidMotion(self.rotation @ first.rotation, self.rotation @ first.shift + self.shift)

    def of(self, x: Floats) -> Floats:
        """Positions (n, 3) after the motion."""
        moved: Floats = x @ self.rotation.T + self.shift
        return moved

    def displacement(self, points: Floats, u: Floats) -> Floats:
        """Displacement (3 n,) after the motion of a part with nodes (n, 3) and a displacement (3 n,)."""
        return (self.of(points + u.reshape(-1, 3)) - points).ravel()
