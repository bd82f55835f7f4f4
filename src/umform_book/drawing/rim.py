"""Ears by a formula: a flange that is compressed around the cup, and nothing else, as its rim is."""

from __future__ import annotations

import numpy as np

from umform.materials import Metal
from umform.results.forming import EarProfile
from umform.sheet_metals import uniaxial


def compressed_flange(material: Metal, blank: float, wall: float) -> EarProfile:
    r"""Lengths that the radii of a flange have in the wall, by the r-values alone.

    A point of the blank at the radius R goes to the wall with the strain ln(wall / R) around the cup. Uniaxial
    compression in that direction, at right angles to its radius, stretches the radius by :math:`-r / (1 + r)` of it,

    .. math:: h = \int_{wall}^{blank} (R / wall)^m \, dR , \qquad m = r / (1 + r) .

    The state at the rim from which Yoon, Dick and Barlat (Int. J. Plasticity 27 (2011) 1165-1184) begin.

    Parameters
    ----------
    material : Metal
        Metal with the r-values.
    blank, wall : float
        Radii of the blank and of the middle of the wall.

    Returns
    -------
    EarProfile
    """
    angle = np.arange(0.0, 360.0, 7.5)
    r = np.array([uniaxial(material.yield_function, around + 90.0)[1] for around in angle])
    power = 1.0 + r / (1.0 + r)
    return EarProfile(angle, wall / power * ((blank / wall) ** power - 1.0))
