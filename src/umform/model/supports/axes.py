"""Local axes for supports: a rotated Cartesian frame, or cylindrical coordinates.

The directions are those of the undeformed mesh, one frame for each node. docs/theory, 5.10
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.model.terms.forces import Vector
from umform.surfaces import Direction, unit_vector

Floats = NDArray[np.float64]

#: A point nearer to the axis than this part of the largest distance has no radial direction.
_ON_AXIS = 1e-9


class Axes(Protocol):
    """Three named unit vectors at each point."""

    @property
    def letters(self) -> str:
        """The letters of the three directions."""

    def at(self, points: Floats) -> Floats:
        """Unit vectors at points (n, 3): shape (n, 3, 3), rows in the order of the letters."""


@dataclass(frozen=True)
class Cylindrical:
    """Cylindrical coordinates: r away from the axis, t around it by the right-hand rule, a along it.

    Parameters
    ----------
    origin, axis : tuple of float
        A point of the axis, and its direction as a unit vector.
    """

    origin: tuple[float, float, float]
    axis: tuple[float, float, float]
    letters: str = "rta"

    def at(self, points: Floats) -> Floats:
        """Radial, tangential and axial unit vectors at points, shape (n, 3, 3).

        Raises
        ------
        InvalidValue
            If a point lies on the axis.
        """
        axis, arms = np.array(self.axis), points - np.array(self.origin)
        arms = arms - np.outer(arms @ axis, axis)
        distances = np.linalg.norm(arms, axis=1)
        alone = np.flatnonzero(distances <= _ON_AXIS * max(float(np.abs(points).max(initial=0.0)), 1e-300))
        if len(alone):
            raise InvalidValue(
                "a point on the axis has no radial direction",
                where="cylindrical axes",
                value=f"point {np.round(points[alone[0]], 6).tolist()}",
                cause="the axis passes through the nodes that are held",
                remedy="leave the nodes on the axis out, or hold them in x, y and z",
            )
        radial = arms / distances[:, None]
        return np.stack([radial, np.cross(axis, radial), np.broadcast_to(axis, radial.shape)], axis=1)


@dataclass(frozen=True)
class Turned:
    """Rotated Cartesian axes x, y, z.

    Parameters
    ----------
    frame : tuple of tuple of float
        The three unit vectors.
    """

    frame: tuple[tuple[float, ...], ...]
    letters: str = "xyz"

    def at(self, points: Floats) -> Floats:
        """The same three unit vectors at all points, shape (n, 3, 3)."""
        return np.broadcast_to(np.array(self.frame), (len(points), 3, 3))


#: The axes of the model.
GLOBAL = Turned(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))


def cylindrical(origin: Vector, axis: Direction) -> Cylindrical:
    """Cylindrical axes r, t, a for supports.

    Parameters
    ----------
    origin : array_like, shape (3,)
        A point of the axis.
    axis : str or array_like, shape (3,)
        Direction of the axis.

    Returns
    -------
    Cylindrical
        r points away from the axis, t around it by the right-hand rule, a along it.

    Raises
    ------
    InvalidValue
        If the axis has no length, or the origin is not a point.

    Examples
    --------
    >>> from umform import cylindrical
    >>> around_y = cylindrical((0, 0, 0), "y")
    """
    x, y, z = _point(origin)
    a, b, c = (float(part) for part in unit_vector(axis, "axis of cylindrical axes"))
    return Cylindrical((x, y, z), (a, b, c))


def turned(x: Direction, y: Direction) -> Turned:
    """Rotated Cartesian axes: x along the first vector, y in the plane of both, z normal to it.

    Parameters
    ----------
    x, y : str or array_like, shape (3,)
        Two directions that are not parallel.

    Returns
    -------
    Turned
        The axes x, y, z.

    Raises
    ------
    InvalidValue
        If the vectors are parallel or have no length.

    Examples
    --------
    >>> import umform as uf
    >>> axes = uf.turned((1, 1, 0), (-1, 1, 0))
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp = model.hold_director("x0", "x", axes=axes)
    """
    first = np.array(unit_vector(x, "x of turned axes"))
    second = np.array(unit_vector(y, "y of turned axes"))
    normal = np.cross(first, second)
    size = float(np.linalg.norm(normal))
    if size < 1e-9:
        raise InvalidValue(
            "two axes must not be parallel",
            where="turned axes",
            value=(x, y),
            cause="the same direction twice, or one and its opposite",
            remedy="give two directions in a plane",
        )
    normal /= size
    frame = (first, np.cross(normal, first), normal)
    return Turned(tuple(tuple(float(part) for part in vector) for vector in frame))


def directions_at(axes: Axes, letters: str, points: Floats) -> list[tuple[str, Floats]]:
    """The unit vectors (n, 3) at points for each letter; unknown letters are refused."""
    for letter in letters if isinstance(letters, Iterable) else [letters]:
        if letter not in tuple(axes.letters):
            raise InvalidValue(
                "the axes have no such direction",
                where="supports",
                value=letter,
                cause=f"these axes have the directions {', '.join(axes.letters)}",
                remedy=f"letters of {axes.letters}",
            )
    frames = axes.at(points)
    return [(letter, frames[:, axes.letters.index(letter)]) for letter in letters]


def unit_normals(normals: ArrayLike, count: int) -> Floats:
    """Unit vectors (count, 3) along given vectors, one for all or one for each node.

    Raises
    ------
    InvalidValue
        If their number is wrong, or one has no length.
    """
    given = np.asarray(normals, dtype=float)
    if given.shape not in ((3,), (count, 3)):
        raise InvalidValue(
            "give one normal, or one for each node",
            where="supports",
            value=f"normals of shape {given.shape}, {count} nodes",
            cause="normals of other nodes than those that are held",
            remedy=f"an array of shape (3,) or ({count}, 3), in the order of the numbers of the nodes",
        )
    vectors = np.broadcast_to(given, (count, 3))
    sizes = np.linalg.norm(vectors, axis=1)
    if not (np.isfinite(sizes).all() and (sizes > 0.0).all()):
        raise InvalidValue(
            "a normal must be finite and have a length",
            where="supports",
            value=normals,
            cause="a zero vector, or a division by zero on the way to it",
            remedy="give finite vectors that are not zero",
        )
    return np.asarray(vectors / sizes[:, None], dtype=np.float64)


def _point(origin: Vector) -> tuple[float, float, float]:
    point = np.asarray(origin, dtype=float)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise InvalidValue(
            "a point has three finite coordinates",
            where="cylindrical axes",
            value=origin,
            cause="a point of a plane, or a coordinate that is not finite",
            remedy="a point (x, y, z) of the axis",
        )
    return float(point[0]), float(point[1]), float(point[2])
