"""Straight elements in the gap between two round tools."""

from __future__ import annotations

import numpy as np


def thickness_in_gap(gap: float, radius: float, around: int, points: int) -> float:
    """Thickness of elements that are chords and fill the gap between two round tools, eq. (4.192).

    Parameters
    ----------
    gap : float
        Distance of the tools.
    radius : float
        Their radius.
    around : int
        Elements on a quarter of the circle.
    points : int
        Contact points per facet in the direction around the tools.

    Returns
    -------
    float
        To the second order in the angle of a chord.
    """
    xi = np.abs(np.polynomial.legendre.leggauss(points)[0])
    length = 0.5 * np.pi * radius / around
    return gap - float(xi.max() ** 2 - xi.min() ** 2) * length**2 / (8.0 * radius)
