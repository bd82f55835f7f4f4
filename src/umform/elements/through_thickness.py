"""Quadrature rules through the thickness."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.elements.legendre import legendre
from umform.elements.staggered import staggered
from umform.errors import InvalidValue

Rule = tuple[NDArray[np.float64], NDArray[np.float64]]

#: Most points through the thickness.
MOST_POINTS = 20
#: The names of the rules.
RULES = ("gauss", "lobatto", "split", "graded", "staggered")
#: Abscissae on [0, 1] of the graded rule by the number of points in both halves, and the weights of the outermost
#: that are free (docs/theory, 2.10; found by tools/graded_points.py from 16 points on).
_GRADED: dict[int, tuple[tuple[float, ...], tuple[float, ...]]] = {
    8: ((0.1047, 0.4443, 0.7651, 0.9480), ()),
    10: ((0.0744, 0.3303, 0.6113, 0.8176, 0.9535), ()),
    12: ((0.0715, 0.3046, 0.5392, 0.7309, 0.8591, 0.9598), ()),
    16: (
        (0.0622, 0.2791, 0.4470, 0.5829, 0.7066, 0.8073, 0.8802, 0.9608),
        (0.1125, 0.0869, 0.0660, 0.0863),
    ),
    18: (
        (0.0633, 0.2741, 0.4278, 0.5420, 0.6533, 0.7500, 0.8277, 0.8852, 0.9619),
        (0.1046, 0.0871, 0.0677, 0.0567, 0.0841),
    ),
    20: (
        (0.0635, 0.2679, 0.4099, 0.5122, 0.6109, 0.7010, 0.7777, 0.8397, 0.8883, 0.9638),
        (0.0940, 0.0841, 0.0692, 0.0554, 0.0528, 0.0811),
    ),
}


def thickness_rule(points: int, rule: str = "gauss", surface: tuple[int, int] = (2, 2)) -> Rule:
    """Abscissae and weights through the thickness on [-1, 1].

    Parameters
    ----------
    points : int
        2 to 20.
    rule : {"gauss", "lobatto", "split", "graded", "staggered"}
        ``split`` puts points/2 Gauss points into each half, exact for the kink of the stress at the mid-surface;
        ``graded`` puts as many nearer to the faces, where a mild bend begins to flow: 8, 10, 12, 16, 18 or 20
        points; with ``staggered`` neighbouring columns of points have different heights, an even number from 6 on.
    surface : (int, int)
        Points of the element along r and s: the staggered rule has a set of heights for each of their columns.

    Returns
    -------
    ndarray, ndarray
        Arrays (points,); of the staggered rule (columns, points), where r varies first.
    """
    if points not in range(2, MOST_POINTS + 1):
        raise InvalidValue(
            "the number of thickness points must be a whole number from 2 to 20",
            where="thickness_points",
            value=points,
            cause="a fraction, or the points of all layers together",
            remedy="5 for bending with plasticity, 2 for elastic sheets",
        )
    if rule not in RULES:
        raise InvalidValue("unknown thickness rule", value=rule, remedy=f"{', '.join(RULES[:-1])} or {RULES[-1]}")
    if rule == "staggered":
        return staggered(points, surface)
    if rule == "graded":
        return _graded(points)
    if rule == "split" and points % 2:
        raise InvalidValue(
            "the split rule needs an even number of thickness points", value=points, remedy=f"take {points + 1}"
        )
    return {"gauss": _core.gauss, "lobatto": _core.lobatto, "split": _core.split}[rule](points)


def _graded(points: int) -> Rule:
    """Abscissae and free weights of the table; the inner weights make each half exact to a degree. eq. (2.47)"""
    if points not in _GRADED:
        raise InvalidValue(f"the graded rule has {_counts()} points", value=points, remedy="take 18")
    half, given = (np.array(part) for part in _GRADED[points])
    inner = len(half) - len(given)
    values = np.stack([legendre(order, 2.0 * half - 1.0) for order in range(inner)])
    means = np.eye(inner)[0] - values[:, inner:] @ given  # all polynomials but the constant have no mean
    weights = np.concatenate([np.linalg.solve(values[:, :inner], means), given])
    return np.concatenate([-half[::-1], half]), np.concatenate([weights[::-1], weights])


def _counts() -> str:
    *some, last = map(str, _GRADED)
    return f"{', '.join(some)} or {last}"
