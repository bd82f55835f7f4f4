"""Bending from flat in increments of curvature, and the moment for comparison."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform.errors import SolveError
from umform_book.sharp_bends.candidates import YIELD_STRESS

Floats = NDArray[np.float64]

_HALVINGS = 7


def hill_moment(thickness: float) -> float:
    """Moment per width of a rigid, perfectly plastic plate bent in plane strain [Hill1950]."""
    return float(2.0 / np.sqrt(3.0) * YIELD_STRESS * thickness**2 / 4.0)


class Bending(ABC):
    """Pure bending without axial force.

    Attributes
    ----------
    thickness : float
        Of the sheet; the width is 1.
    curvature, moment : float
        Reached so far; the moment is that per width.
    """

    def __init__(self, thickness: float) -> None:
        self.thickness = thickness
        self.curvature = self.moment = 0.0

    def moments(self, surface_strains: Sequence[float], increments: int = 100) -> Floats:
        """Moments over that of Hill at ascending surface strains k h / 2, bent in about so many increments."""
        found = []
        for strain in surface_strains:
            target = 2.0 * strain / self.thickness
            count = max(1, round(increments * (target - self.curvature) * self.thickness / (2.0 * surface_strains[-1])))
            for curvature in np.linspace(self.curvature, target, count + 1)[1:]:
                self.bend_to(float(curvature))
            found.append(self.moment / hill_moment(self.thickness))
        return np.array(found)

    def bend_to(self, curvature: float, halvings: int = _HALVINGS) -> None:
        """Bend further, in one increment or, where that fails, in halves.

        Raises
        ------
        SolveError
            If the smallest increment fails too.
        """
        try:
            self._increment(curvature)
        except SolveError:
            if halvings == 0:
                raise
            self.bend_to(0.5 * (self.curvature + curvature), halvings - 1)
            self.bend_to(curvature, halvings - 1)

    @abstractmethod
    def _increment(self, curvature: float) -> None:
        """Bend further in one increment, or raise SolveError and change nothing."""
