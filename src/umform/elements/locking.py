"""Locking of elements in sharp bends: how many layers a bend needs. docs/theory, eq. (2.29)"""

from __future__ import annotations

import math

#: Tolerated ratio of the false moment to the plastic one.
LOCKING = 0.05
#: Order of the thickness strain above which the straight director is the limit.
HIGHEST = 4
#: More layers than this are not proposed.
MOST = 10


def locking_moment(order: int, strain: float, stiffness: float, layers: int = 1) -> float:
    """False moment of sharp-bend locking over the plastic moment, eq. (2.29).

    Parameters
    ----------
    order : int
        Order of the thickness strain.
    strain : float
        x_s, the strain at the surface.
    stiffness : float
        Bulk modulus over yield stress.
    layers : int
        Stacked elements: each bends about its own middle, so that x_s of (2.27) is that of a layer.
    """
    m = order + 1
    beta = (m + 1) / 2 * 2.0**m * math.factorial(m) ** 2 / math.factorial(2 * m)
    return math.sqrt(3.0) * m * beta**2 / (2 * m + 1) * stiffness * strain ** (2 * m - 1) / float(layers) ** (2 * m)


def layers_for(order: int, thickness: float, radius: float, stiffness: float) -> int:
    """Fewest layers that bend over a radius with a false moment of at most 5 %. eq. (2.29)

    Parameters
    ----------
    order : int
        Order of the thickness strain.
    thickness, radius : float
        Of the sheet, and of the inner face on the tool.
    stiffness : float
        Bulk modulus over yield stress.
    """
    strain = thickness / (2.0 * radius + thickness)
    fits = (n for n in range(1, MOST) if locking_moment(min(max(order, 1), HIGHEST), strain, stiffness, n) <= LOCKING)
    return next(fits, MOST)
