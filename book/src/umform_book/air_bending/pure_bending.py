"""A sheet in pure bending at finite curvature: closed forms, and an element bent between two sections of an arc.

Rigid, perfectly plastic and in plane strain the sheet keeps its thickness (Hill 1950): with the turn k for each length
of the flat sheet, its radii are 1/k -+ h/2. Volume is kept, so that a fibre at the height y above the inner face of the
flat sheet lies at the radius r with r^2 = a^2 + 2 y / k; all heights follow from that.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.materials import J2
from umform_book.plastic.plane_strain import plane_strain_modulus
from umform_book.sharp_bends.arc_bending import ArcBending

Floats = NDArray[np.float64]

#: Change of curvature by which the fibre at rest is found, as a part of the curvature.
_TURN = 0.01


def kept_fibre(kh: float) -> float:
    """Height over h in the flat sheet, from the inner face, of the fibre that is as long as it was: r = 1/k."""
    return 0.5 - kh / 8.0


def resting_fibre(kh: float) -> float:
    """Height over h in the flat sheet of the fibre without stress: r = sqrt(a b) [Hill1950]."""
    return 0.5 - kh / 4.0


def resting_place(kh: float) -> float:
    """Distance of the fibre without stress from the inner face of the bent sheet, over h [Hill1950]."""
    a, b = 1.0 / kh - 0.5, 1.0 / kh + 0.5
    return float(np.sqrt(a * b) - a)


def moment(kh: float, yield_stress: float, hardening: float, thickness: float = 1.0, fibres: int = 400) -> float:
    """Moment per width of a rigid-plastic sheet of constant thickness, its work summed over fibres and curvatures.

    The stretch of a fibre is sqrt((1 - kh/2)^2 + 2 kh y), y its height over h; its plastic strain is 2/sqrt(3) of all
    that it was stretched and compressed. Without hardening the sum is Hill's 2/sqrt(3) y h^2/4 at any curvature.
    """
    y = (np.arange(fibres) + 0.5) / fibres
    path = np.linspace(0.0, kh, fibres + 1)[:, None]
    turns = np.abs(np.diff(0.5 * np.log((1.0 - 0.5 * path) ** 2 + 2.0 * path * y), axis=0))
    flowed = 2.0 / np.sqrt(3.0) * (turns.sum(axis=0) - 0.5 * turns[-1])
    work = 2.0 / np.sqrt(3.0) * (yield_stress + hardening * flowed) * turns[-1]
    return float(work.mean() / (kh / fibres) * thickness**2)


def springback(moment: float, inner: float, outer: float, material: J2) -> float:
    """Part of its angle that an arc loses without its moment (per width): a curved bar in plane strain.

    Timoshenko & Goodier, Theory of Elasticity, section 29 (Golovin): (dv/dr - v/r) of the solution for pure bending.
    """
    a, b = inner, outer
    n = (b**2 - a**2) ** 2 - (2.0 * a * b * np.log(b / a)) ** 2
    return float(8.0 * moment * (b**2 - a**2) / (plane_strain_modulus(material) * n))


class Arc(ArcBending):
    """An element, or a stack, bent to one curvature after the other."""

    def radii(self) -> Floats:
        """Radii of the layers of nodes, shape (layers + 1,), from the inner to the outer face."""
        z = np.linspace(-0.5, 0.5, len(self.w)) * self.thickness
        return np.asarray(1.0 / self.curvature + z + self.w)

    def closed_springback(self) -> float:
        """Moment and radii of the closed form."""
        radii, material = self.radii(), self.model.bodies.only.material
        assert isinstance(material, J2)
        return springback(self.moment, radii[0], radii[-1], material)

    def kept(self) -> float:
        """Height over h in the flat sheet, from the inner face, of the fibre that is as long as it was."""
        return self._height_at(1.0, self.curvature * self.radii())

    def resting(self) -> float:
        """Height of the fibre whose length does not change while the curvature grows by a hundredth."""
        before = self.curvature * self.radii()
        self.bend_to((1.0 + _TURN) * self.curvature)
        return self._height_at(0.0, self.curvature * self.radii() - before)

    def released(self) -> float:
        """Part of its angle that the arc loses: unloaded in two steps to about a tenth of the moment, then linear.

        The arc is put back after it.
        """
        before = self.model.system.snapshot(), self.w, self.rate, self.curvature, self.moment
        loaded = self.curvature
        guess = self.closed_springback()
        steps = []
        for part in (0.5, 0.9):
            self.bend_to(loaded * (1.0 - part * guess))
            steps.append((self.curvature, self.moment))
        (k1, m1), (k2, m2) = steps
        snapshot, self.w, self.rate, self.curvature, self.moment = before
        self.model.system.restore(snapshot)
        return 1.0 - (k2 - m2 * (k1 - k2) / (m1 - m2)) / loaded

    def _height_at(self, value: float, of_layers: Floats) -> float:
        return float(np.interp(value, of_layers, np.linspace(0.0, 1.0, len(of_layers))))
