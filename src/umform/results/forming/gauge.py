"""Lay a part into its gauge: by the best fit of all its points, or on three of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Laid:
    """A part that was moved as a rigid body.

    Attributes
    ----------
    points : ndarray, shape (n, 3)
        Where its points are now.
    distance : ndarray, shape (n,)
        From the points of the gauge.
    rotation : ndarray, shape (3, 3)
    shift : ndarray, shape (3,)
        A point x is now at rotation x + shift.
    """

    points: Floats
    distance: Floats
    rotation: Floats
    shift: Floats

    @property
    def largest(self) -> float:
        """Largest distance."""
        return float(self.distance.max())


def lay_by_best_fit(points: ArrayLike, gauge: ArrayLike) -> Laid:
    """Move a part so that the sum of the squares of the distances of its points from those of the gauge is least.

    Parameters
    ----------
    points, gauge : array_like, shape (n, 3)
        Points of the part, and the places where the gauge has them.

    Returns
    -------
    Laid
        eq. (5.67)
    """
    x, y = _pairs(points, gauge)
    a, b = x.mean(axis=0), y.mean(axis=0)
    U, _, Vt = np.linalg.svd((x - a).T @ (y - b))
    sign = np.array([1.0, 1.0, np.sign(np.linalg.det(U @ Vt))])
    rotation = Vt.T @ (sign[:, None] * U.T)
    return _laid(x, y, rotation, b - rotation @ a)


def lay_on_three_points(points: ArrayLike, gauge: ArrayLike, supports: ArrayLike) -> Laid:
    """Move a part so that the first of three points lies in its place, the second on its line, the third in its plane.

    Parameters
    ----------
    points, gauge : array_like, shape (n, 3)
        Points of the part, and the places where the gauge has them.
    supports : array_like of int, shape (3,)
        Which of them the part lies on.

    Returns
    -------
    Laid
    """
    x, y = _pairs(points, gauge)
    chosen = np.asarray(supports)
    if chosen.shape != (3,) or len(set(chosen.tolist())) < 3 or chosen.min() < 0 or chosen.max() >= len(x):
        raise InvalidValue(
            "a part lies on three different points of it",
            where="supports",
            value=", ".join(str(k) for k in chosen.ravel().tolist()),
            cause="numbers of points that are not there, or one of them twice",
            remedy="three numbers of points that are not on a line",
        )
    own, wanted = _axes(x[chosen]), _axes(y[chosen])
    rotation = wanted.T @ own
    return _laid(x, y, rotation, y[chosen[0]] - rotation @ x[chosen[0]])


def far_apart(points: Floats) -> list[int]:
    """Three points of a large triangle: the farthest from the middle, then from that point, then from their line."""
    first = int(np.linalg.norm(points - points.mean(axis=0), axis=1).argmax())
    second = int(np.linalg.norm(points - points[first], axis=1).argmax())
    areas = np.linalg.norm(np.cross(points - points[first], points[second] - points[first]), axis=1)
    return [first, second, int(areas.argmax())]


def _pairs(points: ArrayLike, gauge: ArrayLike) -> tuple[Floats, Floats]:
    x, y = np.asarray(points, dtype=float), np.asarray(gauge, dtype=float)
    if x.shape != y.shape or x.ndim != 2 or x.shape[1] != 3 or len(x) < 3:
        raise InvalidValue(
            "a part and its gauge have the same points, three at least",
            where="gauge",
            value=f"{x.shape} and {y.shape}",
            remedy="the same nodes in the part and in the shape that it should have",
        )
    return x, y


def _axes(p: Floats) -> Floats:
    """Axes (3, 3) of three points: along the first two, in their plane, normal to it."""
    first = p[1] - p[0]
    normal = np.cross(first, p[2] - p[0])
    if not np.linalg.norm(normal) > 1e-9 * (first @ first):
        raise InvalidValue(
            "the three points that a part lies on are on a line",
            where="points",
            value="; ".join(f"({x:.4g}, {y:.4g}, {z:.4g})" for x, y, z in p + 0.0),
            cause="points along one edge, or of a sheet of one element across",
            remedy="three points of a large triangle",
        )
    first, normal = first / np.linalg.norm(first), normal / np.linalg.norm(normal)
    return np.array([first, np.cross(normal, first), normal])


def _laid(x: Floats, y: Floats, rotation: Floats, shift: Floats) -> Laid:
    moved = x @ rotation.T + shift
    return Laid(moved, np.linalg.norm(moved - y, axis=1), rotation, shift)
