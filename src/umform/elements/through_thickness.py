"""Quadrature rules through the thickness."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.elements.legendre import legendre
from umform.errors import InvalidValue

#: Most points through the thickness.
MOST_POINTS = 20
#: Abscissae on [0, 1] of the graded rule by the number of points in both halves (docs/theory, 2.10).
_GRADED = {
    8: (0.1047, 0.4443, 0.7651, 0.9480),
    10: (0.0744, 0.3303, 0.6113, 0.8176, 0.9535),
    12: (0.0715, 0.3046, 0.5392, 0.7309, 0.8591, 0.9598),
    16: (0.0487, 0.2077, 0.3736, 0.5611, 0.7008, 0.8235, 0.8973, 0.9688),
    20: (0.0368, 0.1758, 0.3248, 0.3981, 0.5390, 0.6755, 0.7688, 0.8603, 0.9236, 0.9813),
}


def thickness_rule(points: int, rule: str = "gauss") -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Abscissae and weights through the thickness on [-1, 1].

    Parameters
    ----------
    points : int
        2 to 20.
    rule : {"gauss", "lobatto", "split", "graded"}
        ``split`` puts points/2 Gauss points into each half, which is exact for a stress with a kink at the mid-surface;
        ``graded`` moves them towards the faces, where a mild bend first yields: 8, 10, 12, 16 or 20 points.
    """
    if points not in range(2, MOST_POINTS + 1):
        raise InvalidValue("the number of thickness points must be a whole number from 2 to 20", value=points)
    if rule not in ("gauss", "lobatto", "split", "graded"):
        raise InvalidValue("unknown thickness rule", value=rule, remedy="gauss, lobatto, split or graded")
    if rule == "graded":
        return _graded(points)
    if rule == "split" and points % 2:
        raise InvalidValue(
            "the split rule needs an even number of thickness points", value=points, remedy=f"take {points + 1}"
        )
    return {"gauss": _core.gauss, "lobatto": _core.lobatto, "split": _core.split}[rule](points)


def _graded(points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Abscissae of the table, and weights that are exact to the degree points/2 - 1 on each half. eq. (2.47)"""
    if points not in _GRADED:
        raise InvalidValue("the graded rule has 8, 10, 12, 16 or 20 points", value=points, remedy="take 12")
    half = np.array(_GRADED[points])
    values = np.stack([legendre(order, 2.0 * half - 1.0) for order in range(len(half))])
    weights = np.linalg.solve(values, np.eye(len(half))[0])  # all polynomials but the constant have zero mean
    return np.concatenate([-half[::-1], half]), np.concatenate([weights[::-1], weights])
