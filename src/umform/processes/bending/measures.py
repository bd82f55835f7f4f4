"""What is measured on a curve of force over displacement: values at marks, jumps, roughness."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Degree of the polynomial that stands for the smooth curve. Higher ones change the roughness by a few percent only.
SMOOTH_DEGREE = 4


def at_marks(u: Floats, F: Floats, marks: tuple[float, ...]) -> list[float | None]:
    """Forces at given displacements, interpolated linearly; None beyond the end of the curve."""
    if not u.size:
        return [None] * len(marks)
    reached = u[-1] * (1.0 + 1e-9)
    return [float(np.interp(mark, u, F)) if mark <= reached else None for mark in marks]


def jump(u: Floats, F: Floats, start: float, window: float) -> float | None:
    """Largest |dF|/F within any window of the displacement beyond ``start``.

    dF is the difference of the largest and the smallest force in the window, F the force where the window begins. The
    slope of a smooth curve counts too, so that no curve has zero.

    Returns
    -------
    float or None
        None if the curve is shorter than one window beyond the start.
    """
    if not u.size:
        return None
    tiny = 1e-9 * window
    begins = u[(u >= start - tiny) & (u <= u[-1] - window + tiny)]
    largest = None
    for begin in begins:
        end = begin + window
        inside = F[(u >= begin - tiny) & (u <= end + tiny)]
        forces = np.append(inside, np.interp(end, u, F))
        ratio = float(np.ptp(forces) / abs(forces[0]))
        largest = ratio if largest is None else max(largest, ratio)
    return largest


def roughness(u: Floats, F: Floats, start: float) -> float | None:
    """Root mean square of the deviation from a smooth fit beyond ``start``, relative to the mean force there.

    The fit is the polynomial of degree `SMOOTH_DEGREE` of least squares.

    Returns
    -------
    float or None
        None if there are too few points for the fit.
    """
    beyond = u > start
    if int(beyond.sum()) <= SMOOTH_DEGREE + 1:
        return None
    x, y = u[beyond], F[beyond]
    smooth = Polynomial.fit(x, y, SMOOTH_DEGREE)
    return float(np.sqrt(np.mean((y - smooth(x)) ** 2)) / abs(y.mean()))
