"""The law of a sheet for one proportional path: a norm of logarithmic strains, and the stress over it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from umform.materials import Hill48, Metal, Plastic
from umform.sheet_metals import uniaxial

Floats = NDArray[np.float64]

#: Points of the table of the curve, and the plastic strain at its end.
_POINTS, _LARGEST = 4000, 4.0
#: A usual strain, and the penalty of ironing over the stress there.
_MIDDLE, _IRONED = 0.2, 40.0
#: Least exponent of the power law, and its first point.
_LEAST_EXPONENT, _FIRST = 0.5, 1e-3


@dataclass(frozen=True, eq=False)
class PathLaw:
    """Energy of a sheet over its logarithmic strain, in plane stress, Hill (1948). eqs. (6.3), (6.4)

    Parameters
    ----------
    hill : Hill48
        Yield function; the rolling direction is axis 1.
    strain, stress : ndarray, shape (n,)
        Equivalent strain and stress from the origin, straight between these points and beyond the last one.
    thickest : float
        Largest logarithmic strain through the thickness: tools iron what is thicker. eq. (6.6)
    """

    hill: Hill48
    strain: Floats
    stress: Floats
    thickest: float = math.inf

    @classmethod
    def of(cls, material: Plastic) -> Self:
        """The law of a metal: its hardening curve, and Hill's function of its r-values.

        Yield functions other than that of Hill give their r-values only. A back stress is not included.
        """
        curve = material.hardening.curve()
        plastic = _LARGEST * np.linspace(0.0, 1.0, _POINTS) ** 3
        stress = np.array([curve(float(p))[0] for p in plastic])
        return cls(
            hill_of(material),
            np.concatenate([[0.0], plastic + stress / material.E]),
            np.concatenate([[0.0], stress]),
        )

    @property
    def isotropic(self) -> Self:
        """The same without directions in the plane: its mean r-value in all directions."""
        r0, r45, r90 = self.hill.r_values
        mean = 0.25 * (r0 + 2.0 * r45 + r90)
        return replace(self, hill=Hill48(mean, mean, mean))

    def smooth(self, strain: float) -> Self:
        """A power law through the stress at a strain, whose exponent is the own one there but at least 1/2. eq. (6.5)

        With less hardening the compressed edge of a drawn part localises, and the mesh would decide.
        """
        _, stress, slope = (float(x[0]) for x in self.energy(np.array([strain])))
        exponent = max(_LEAST_EXPONENT, min(slope * strain / stress, 1.0))
        points = np.concatenate([[0.0], np.geomspace(_FIRST, _LARGEST, _POINTS // 4)])
        return replace(self, strain=points, stress=stress * (points / strain) ** exponent)

    @property
    def linear(self) -> Self:
        """A stress in proportion to the strain, of the size of the real one, and no ironing."""
        strain = np.array([0.0, 1.0])
        middle = self.energy(np.array([_MIDDLE]))[1] / _MIDDLE
        return replace(self, strain=strain, stress=strain * middle, thickest=math.inf)

    def ironed(self, trace: Floats) -> tuple[Floats, Floats, Floats]:
        """Energy of a penalty on what is too thick, over the trace of the strain, with two derivatives."""
        if math.isinf(self.thickest):
            return np.zeros_like(trace), np.zeros_like(trace), np.zeros_like(trace)
        over = np.maximum(-trace - self.thickest, 0.0)
        k = _IRONED * float(self.energy(np.array([_MIDDLE]))[1][0])
        return 0.5 * k * over**2, -k * over, np.where(over > 0.0, k, 0.0)

    @cached_property
    def metric(self) -> Floats:
        """Square of the equivalent strain as a form in u, shape (3, 3), with the strain (e11, e22, 2 e12) = T u."""
        h = self.hill
        P = np.array([[h.G + h.H, -h.H, 0.0], [-h.H, h.F + h.H, 0.0], [0.0, 0.0, 2.0 * h.N]])
        T = np.array([[1.0, -0.5, 0.0], [1.0, 0.5, 0.0], [0.0, 0.0, -1.0]])
        return np.asarray(T.T @ np.linalg.inv(P) @ T)

    @cached_property
    def _work(self) -> Floats:
        mean = 0.5 * (self.stress[1:] + self.stress[:-1])
        return np.concatenate([[0.0], np.cumsum(mean * np.diff(self.strain))])

    @cached_property
    def _slopes(self) -> Floats:
        return np.diff(self.stress) / np.diff(self.strain)

    def equivalent(self, strain: Floats) -> Floats:
        """Equivalent strains of logarithmic strains (e11, e22, e12), shape (m, 3)."""
        u = np.stack([0.5 * (strain[:, 0] + strain[:, 1]), strain[:, 1] - strain[:, 0], -2.0 * strain[:, 2]], axis=1)
        return np.asarray(np.sqrt(np.einsum("mi,ij,mj->m", u, self.metric, u)))

    def energy(self, strain: Floats) -> tuple[Floats, Floats, Floats]:
        """Work per volume, stress and slope of the stress at equivalent strains."""
        at = np.clip(np.searchsorted(self.strain, strain, side="right") - 1, 0, len(self._slopes) - 1)
        over, slope = strain - self.strain[at], self._slopes[at]
        stress = self.stress[at] + slope * over
        return self._work[at] + 0.5 * (self.stress[at] + stress) * over, stress, slope


def hill_of(material: Plastic) -> Hill48:
    """Hill's function of a metal, from the r-values of its own yield function if that is another one."""
    if not isinstance(material, Metal):
        return Hill48(1.0, 1.0, 1.0)
    function = material.yield_function
    if isinstance(function, Hill48):
        return function
    return Hill48(*(uniaxial(function, angle)[1] for angle in (0.0, 45.0, 90.0)))
