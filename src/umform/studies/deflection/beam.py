"""A plate on edge as a beam on two supports. docs/theory, 5.16"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
#: Steel of ram and bed.
_E, _NU = 210e3, 0.3
#: Shear area of a rectangle over its area.
_SHEAR = 5.0 / 6.0


def beam_deflection(
    x: ArrayLike, span: float, height: float, thickness: float, line_load: float, start: float, end: float
) -> Floats:
    """Deflection of a steel plate on edge, on two supports, under a uniform line load on a part of it. eq. (5.94)

    Parameters
    ----------
    x : array_like, shape (n,)
        Distances from the first support.
    span : float
        Distance of the supports.
    height, thickness : float
        Section of the plate.
    line_load : float
        Force per length.
    start, end : float
        Where the load begins and ends.

    Returns
    -------
    ndarray, shape (n,)
        Deflection in the direction of the load: of bending and of shear.
    """
    x = np.asarray(x, dtype=float)
    E_I, G_A = _E * thickness * height**3 / 12.0, _SHEAR * _E / (2.0 * (1.0 + _NU)) * thickness * height
    support = line_load * (end - start) * (1.0 - 0.5 * (start + end) / span)

    def fourth(at: Floats) -> Floats:
        """E I times the deflection, with its slope at the first support left out."""
        loaded = np.maximum(at - start, 0.0) ** 4 - np.maximum(at - end, 0.0) ** 4
        return np.asarray(line_load * loaded / 24.0 - support * at**3 / 6.0)

    slope = -float(fourth(np.array(span))) / span
    loaded = np.maximum(x - start, 0.0) ** 2 - np.maximum(x - end, 0.0) ** 2
    return np.asarray((fourth(x) + slope * x) / E_I + (support * x - 0.5 * line_load * loaded) / G_A)


def beams_deflection(
    y: ArrayLike, span: float, plates: Sequence[tuple[float, float]], line_load: float, length: float
) -> Floats:
    """Sum of the deflections of plates under a load in the middle of the span, at distances from there. eq. (5.95)

    Parameters
    ----------
    y : array_like, shape (n,)
        Distances from the middle.
    span : float
        Distance of the supports.
    plates : sequence of tuple of float
        Height and thickness of each plate.
    line_load, length : float
        Force per length, and the length of what is loaded.
    """
    middle = 0.5 * span
    x, ends = middle + np.asarray(y, dtype=float), (middle - 0.5 * length, middle + 0.5 * length)
    return np.asarray(sum(beam_deflection(x, span, *plate, line_load, *ends) for plate in plates))


def crown(y: ArrayLike, span: float) -> Floats:
    """Rise of the bed for a crowning of 1, at distances from the middle. eq. (5.96)"""
    return np.asarray(1.0 - (2.0 * np.asarray(y, dtype=float) / span) ** 2)
