"""Check points, directions and lengths given by users."""

from __future__ import annotations

from functools import partial
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue, NotFinite
from umform.spec import Checked
from umform.spec.types import FARTHEST

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def unit_vector(direction: Direction, where: str = "direction") -> tuple[float, float, float]:
    """Unit vector from "x", "-y", ... or three components."""
    if isinstance(direction, str):
        sign, name = (-1.0, direction[1:]) if direction.startswith("-") else (1.0, direction)
        if name not in _AXES:
            raise InvalidValue(
                "a direction is x, y, z, -x, -y, -z or three numbers",
                where=where,
                value=direction,
                cause="another word",
                remedy="a word such as -z, or three numbers",
            )
        direction = (sign * _AXES[name][0], sign * _AXES[name][1], sign * _AXES[name][2])
    vector = as_numbers(direction)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise NotFinite(
            "a direction needs three finite numbers",
            where=where,
            value=direction,
            cause="another count of numbers, nan or inf",
            remedy="three numbers such as (0.0, 0.0, 1.0), or a word such as z",
        )
    length = float(np.linalg.norm(vector))
    if length == 0.0:
        raise InvalidValue(
            "a direction must not be the zero vector",
            where=where,
            cause="a difference of two points that coincide",
            remedy="three numbers that are not all zero",
        )
    x, y, z = (float(c) for c in vector / length)
    return x, y, z


def right_angle(x: Direction, y: Direction, where: str = "x, y") -> tuple[Point, Point]:
    """Two unit vectors at right angles.

    Raises
    ------
    InvalidValue
        If they are not at right angles.
    """
    first, second = unit_vector(x, "x"), unit_vector(y, "y")
    cosine = float(np.dot(first, second))
    if abs(cosine) > 1e-9:
        raise InvalidValue(
            "two directions must be at right angles",
            where=where,
            value=f"{float(np.degrees(np.arccos(cosine))):.6g} degrees between {x} and {y}",
            cause="rounded numbers, or two directions chosen apart",
            remedy="give y as the cross product of x and a third direction",
        )
    return first, second


def rotation_matrix(vector: ArrayLike) -> NDArray[np.float64]:
    """Matrix of a rotation vector v in radians: 1 + sin a K + 2 sin²(a/2) K², a = |v|, K x = v/a × x (Rodrigues)."""
    v = np.asarray(vector, dtype=float)
    angle = float(np.linalg.norm(v))
    if angle == 0.0:
        return np.eye(3)
    K = np.cross(v / angle, np.eye(3), axisb=0, axisc=0)
    return np.asarray(np.eye(3) + np.sin(angle) * K + 2.0 * np.sin(0.5 * angle) ** 2 * (K @ K))


def point(values: ArrayLike, where: str = "point", size: int = 3) -> list[float]:
    """Coordinates of a point as a list of finite numbers."""
    vector = as_numbers(values)
    if vector.shape != (size,) or not (np.abs(vector) <= FARTHEST).all():
        raise NotFinite(
            f"a point needs {'two' if size == 2 else 'three'} finite numbers",
            where=where,
            value=values,
            cause=f"another count of numbers, nan, inf, or a number beyond {FARTHEST:g}",
            remedy="give its coordinates as finite numbers",
        )
    return [float(c) for c in vector]


def pair(values: Any) -> tuple[float, float]:
    """Two coordinates as floats."""
    return float(values[0]), float(values[1])


def coordinates(x: NDArray[np.float64]) -> str:
    """A place as text, with four digits."""
    return f"({', '.join(f'{value:.4g}' for value in x + 0.0)})"


def lengths(values: ArrayLike, where: str = "size", size: int = 3) -> list[float]:
    """Lengths that are finite and greater than zero."""
    return [positive(length, where, where) for length in point(values, where, size)]


def positive(value: float, where: str, what: str = "radius") -> float:
    """A length that is finite and greater than zero."""
    if not 0.0 < value <= FARTHEST:
        raise InvalidValue(
            f"the {what} must be positive",
            where=where,
            value=value,
            cause=f"a sign, a missing value, nan, or beyond {FARTHEST:g}",
            remedy="give a length above zero",
        )
    return float(value)


def not_negative(value: float, where: str, what: str = "radius") -> float:
    """A length that is finite and at least zero."""
    if not 0.0 <= value <= FARTHEST:
        raise InvalidValue(
            f"the {what} must not be negative",
            where=where,
            value=value,
            cause=f"a sign, nan, or beyond {FARTHEST:g}",
            remedy="give a length, or zero",
        )
    return float(value)


def as_numbers(values: ArrayLike) -> NDArray[np.float64]:
    """An array; empty if the values are not numbers."""
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        return np.empty(0)


#: "x", "y", "z", "-x", "-y", "-z", or three numbers.
Direction = Annotated[str | tuple[float, float, float], Checked(unit_vector)]
#: Three coordinates.
Point = Annotated[tuple[float, float, float], Checked(point)]
#: Two coordinates in a plane.
Point2 = Annotated[tuple[float, float], Checked(partial(point, size=2))]
#: Three lengths above zero.
Size = Annotated[tuple[float, float, float], Checked(lengths)]
#: Two lengths above zero.
Size2 = Annotated[tuple[float, float], Checked(partial(lengths, size=2))]
