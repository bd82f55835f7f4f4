"""Staggered heights: the columns of points of an element do not share their places through the thickness.

All columns of an element see nearly the same stretch and curvature, and so their heights together are the rule of the
section. docs/theory, 2.10
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.errors import InvalidValue

Floats = NDArray[np.float64]

#: The cells of a column are as dense as 1 + a t^p: denser near the faces, where a mild bend begins to flow. Found by
#: tools/staggered_points.py
DENSITY = (0.5, 6)
#: Fewest points of a column: what makes constants and t^2 exact shifts weight between three points of a half.
_FEWEST = 6


def default_points(surface: tuple[int, int]) -> int:
    """Points of a column: the fewer, the more columns share a section."""
    if 3 in surface:
        return 18
    return 20 if 1 in surface else 12


def phases(surface: tuple[int, int]) -> Floats:
    """Places of the columns in the cells of the section, between 0 and 1, r first. eq. (2.51)"""
    r, s = (_centres(count) for count in surface)
    if surface == (2, 2):  # else two columns on a diagonal would be alike
        s = 0.5 * s
    return np.asarray((0.5 + s[:, None] + r[None, :]).ravel() % 1.0)


def _centres(count: int) -> Floats:
    """Middles of the parts of an interval of length one that are as long as the Gauss weights, from its middle."""
    w = 0.5 * _core.gauss(count)[1]
    return np.asarray(np.cumsum(w) - 0.5 * w - 0.5)


def staggered(points: int, surface: tuple[int, int]) -> tuple[Floats, Floats]:
    """Heights and weights, arrays (columns, points)."""
    if points % 2 or points < _FEWEST:
        raise InvalidValue(
            f"a staggered column has an even number of points, {_FEWEST} at least",
            value=points,
            remedy=f"take {max(_FEWEST, points + points % 2)}, or {default_points(surface)}, the default",
        )
    t, w = staggered_halves(phases(surface), points // 2)
    return np.concatenate([-t[:, ::-1], t], axis=1), np.concatenate([w[:, ::-1], w], axis=1)


def section_rule(points: int, surface: tuple[int, int] = (2, 2)) -> tuple[Floats, Floats]:
    """The heights of all columns together, with the shares that the columns have in a section of the element."""
    t, w = staggered(points, surface)
    along, across = (0.5 * _core.gauss(count)[1] for count in surface)
    weights = w * np.outer(across, along).ravel()[:, None]
    order = np.argsort(t, axis=None)
    return t.ravel()[order], weights.ravel()[order]


def staggered_halves(at: Floats, points: int, density: tuple[float, float] = DENSITY) -> tuple[Floats, Floats]:
    """Heights and weights of the upper halves of columns with these phases, arrays (columns, points). eq. (2.51)"""
    a, p = density
    t = np.linspace(0.0, 1.0, 20001)
    share = (t + a * t ** (p + 1) / (p + 1)) / (1.0 + a / (p + 1))
    cell = np.arange(points)
    place = np.where(cell % 2 == 0, at[:, None], 1.0 - at[:, None])
    heights = np.interp((cell + place) / points, share, t)
    sizes = np.diff(np.interp(np.arange(points + 1) / points, share, t))
    return heights, np.array([_exact(x, sizes) for x in heights])


def _exact(heights: Floats, sizes: Floats) -> Floats:
    """The sizes of the cells, changed least so that constants and t^2 are exact. eq. (2.52)"""
    powers = np.stack([np.ones_like(heights), heights**2])
    missing = np.array([1.0, 1.0 / 3.0]) - powers @ sizes
    weighted = powers * sizes
    return np.asarray(sizes + weighted.T @ np.linalg.solve(weighted @ powers.T, missing))
