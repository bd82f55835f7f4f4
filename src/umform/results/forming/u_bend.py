"""Springback of a U-bend as NUMISHEET 93 measures it: two angles and the radius of the side wall."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue

Floats = NDArray[np.float64]

#: Heights above the bottom at which the wall is looked at, mm.
HEIGHTS = (15.0, 35.0, 55.0)
#: Part of the half width of a bottom that is taken as flat.
_FLAT = 0.6


@dataclass(frozen=True)
class UBendAngles:
    """Angles in degrees and radius of a U-bend; without springback both angles are 90 degrees. eq. (5.68)

    Attributes
    ----------
    theta1 : float
        Between the bottom and the wall.
    theta2 : float
        Between the wall and the flange.
    radius : float
        Of curvature of the wall.
    """

    theta1: float
    theta2: float
    radius: float

    def __str__(self) -> str:
        return f"theta1 {self.theta1:.1f}°, theta2 {self.theta2:.1f}°, radius of the wall {self.radius:.0f}"


def u_bend_angles(
    line: Floats, heights: tuple[float, float, float] = HEIGHTS, *, flange: int = 10, flat: float | None = None
) -> UBendAngles:
    """Measure half of a U-bend.

    Parameters
    ----------
    line : ndarray, shape (n, 2)
        Mid-surface (x, z) from the middle of the bottom to the end of the flange.
    heights : tuple of float
        Where the wall is looked at, above the middle of the bottom.
    flange : int
        Points at the end of the line whose chord is the flange.
    flat : float, optional
        Half of the flat part of the bottom; default: 0.6 of its half width. The chord of the bottom goes from its
        middle as far as the lowest height, as in NUMISHEET 93, but not beyond the flat part.

    Raises
    ------
    InvalidValue
        If the wall does not reach the heights.
    """
    rise = line[:, 1] - line[0, 1]
    if not rise.max() > heights[2]:
        raise InvalidValue(
            "the wall of the U-bend does not reach the heights at which it is measured",
            where="u_bend_angles",
            value=f"heights {heights}, the wall ends at {rise.max():.4g}",
            cause="a short stroke",
            remedy="lower heights, or a longer stroke",
        )
    low, middle, high = (crossing(line, height) for height in heights)
    reach = min(heights[0], _FLAT * (low[0] - line[0, 0]) if flat is None else flat)
    bottom = line[max(int(np.argmax(line[:, 0] - line[0, 0] >= reach)), 1)] - line[0]
    end = line[-1] - line[-1 - flange]
    theta1, theta2 = angle_between(-bottom, middle - low), angle_between(end, low - middle)
    return UBendAngles(theta1, theta2, circle(low, middle, high))


def crossing(line: Floats, height: float) -> Floats:
    """Where the wall is at a height above the bottom."""
    z = line[:, 1] - line[0, 1]
    k = int(np.argmax(z > height))
    part = (height - z[k - 1]) / (z[k] - z[k - 1])
    point: Floats = line[k - 1] + part * (line[k] - line[k - 1])
    return point


def angle_between(a: Floats, b: Floats) -> float:
    """Degrees."""
    return float(np.degrees(np.arccos(np.clip(a @ b / (np.linalg.norm(a) * np.linalg.norm(b)), -1.0, 1.0))))


def circle(a: Floats, b: Floats, c: Floats) -> float:
    """Radius of the circle through three points."""
    sides = [np.linalg.norm(q - p) for p, q in ((a, b), (b, c), (c, a))]
    area = 0.5 * abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    return float(np.prod(sides) / (4.0 * max(area, 1e-12)))
