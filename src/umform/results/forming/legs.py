"""Angle between the straight legs of a bent section."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Leg:
    """The least-squares line through the end of a mid-surface.

    Attributes
    ----------
    points : ndarray, shape (n, 2)
        The points of the end.
    direction : ndarray, shape (2,)
        Unit vector along the line, towards the end.
    deviation : float
        Largest distance of a point from the line.
    """

    points: Floats
    direction: Floats
    deviation: float

    @classmethod
    def of(cls, s: Floats, line: Floats, length: float, least: int = 2) -> Self:
        """The leg at the end of a line.

        Parameters
        ----------
        s : ndarray, shape (n,)
            Way along the undeformed sheet, rising.
        line : ndarray, shape (n, 2)
            Mid-surface now.
        length : float
            Length of the leg in the undeformed sheet.
        least : int, optional
            Number of points that it has at least: those of an element.

        Raises
        ------
        InvalidValue
            The leg is longer than the section.
        """
        if not 0.0 < length < s[-1] - s[0]:
            raise InvalidValue(
                "a leg is a part of its section",
                where="leg",
                value=length,
                cause="a length of the whole sheet, or another unit",
                remedy=f"less than {0.5 * (s[-1] - s[0]):.4g}, half of the section",
            )
        first = min(int(np.searchsorted(s, s[-1] - length * (1.0 + 1e-9))), len(s) - least)
        points = line[first:]
        away = points - points.mean(axis=0)
        direction = np.linalg.svd(away)[2][0]
        direction = direction * np.sign(direction @ (points[-1] - points[0]))
        across = away @ np.array([-direction[1], direction[0]])
        return cls(points, direction, float(np.abs(across).max()))


def angle_between(one: Floats, other: Floats) -> float:
    """Angle between two directions of shape (2,), in degrees: 180 for the two legs of a flat sheet."""
    cross = one[0] * other[1] - one[1] * other[0]
    return float(np.degrees(np.arctan2(abs(cross), one @ other)))
