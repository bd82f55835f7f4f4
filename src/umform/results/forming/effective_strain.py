"""Effective plastic strain of a sheet by the principal rates of strain in its plane. eq. (5.181)"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np
from numpy.typing import NDArray

from umform.materials import Mises, Plastic
from umform.materials.yield_functions import YieldFunction

Floats = NDArray[np.float64]

#: Directions of the plane stress over half of the yield locus.
_DIRECTIONS = 2048


@dataclass(frozen=True)
class EffectiveStrain:
    """Effective plastic strain of an increment in plane stress, as the law of the sheet takes it. eq. (5.181)

    The principal axes of the increment are taken as along and across the rolling direction.

    Parameters
    ----------
    function : YieldFunction
        The yield function of the metal.

    Examples
    --------
    >>> import umform as uf
    >>> from umform.results.forming import EffectiveStrain
    >>> strain = EffectiveStrain(uf.Mises())
    >>> round(float(strain(0.2, -0.1)), 4)  # tension
    0.2
    """

    function: YieldFunction

    @classmethod
    def of(cls, material: Plastic) -> EffectiveStrain:
        """That of a metal; von Mises for a law without a yield function."""
        return cls(cast(YieldFunction, getattr(material, "yield_function", Mises())))

    def __call__(self, major: Floats | float, minor: Floats | float) -> Floats:
        """Effective strain of increments.

        Parameters
        ----------
        major, minor : float or ndarray
            Principal increments of logarithmic strain in the plane.
        """
        major, minor = np.broadcast_arrays(np.asarray(major, dtype=float), np.asarray(minor, dtype=float))
        angles, per_length = self._locus
        found: Floats = np.hypot(major, minor) * np.interp(np.arctan2(minor, major), angles, per_length)
        return found

    @cached_property
    def _locus(self) -> tuple[Floats, Floats]:
        """Angles of the normals of the yield locus, ascending, and the effective strain per length of a rate.

        By the normality of the flow, a rate along the gradient n of the equivalent stress has the effective strain
        |rate| / |n|.
        """
        kernel = self.function.function()
        stress = np.zeros((2 * _DIRECTIONS, 6))
        turn = np.linspace(-np.pi, np.pi, 2 * _DIRECTIONS, endpoint=False)
        stress[:, 0], stress[:, 1] = np.cos(turn), np.sin(turn)
        normals = np.array([kernel(one)[1][:2] for one in stress])
        angles = np.unwrap(np.arctan2(normals[:, 1], normals[:, 0]))
        per_length = 1.0 / np.linalg.norm(normals, axis=1)
        around = np.concatenate([angles - 2.0 * np.pi, angles, angles + 2.0 * np.pi])
        order = np.argsort(around, kind="stable")
        return around[order], np.tile(per_length, 3)[order]
