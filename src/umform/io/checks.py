"""Checks that all readers and writers share."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue, NotFinite

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Fields = Mapping[str, ArrayLike]


def check_points(points: FloatArray, where: str) -> None:
    """Reject positions that are not finite.

    Parameters
    ----------
    points : ndarray of float, shape (n, 3)
        Positions.
    where : str
        The place, for the message.

    Raises
    ------
    NotFinite
        A coordinate is NaN or infinite.
    """
    wrong = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if wrong.size:
        raise NotFinite(
            f"{wrong.size} of {len(points)} points have a coordinate that is not finite",
            where=f"{where + ', ' if where else ''}point {wrong[0]}",
            value=points[wrong[0]],
            remedy="repair the mesh where it was made",
        )


def check_ids(cells: IntArray, points: int, where: str) -> None:
    """Reject cells that name points which do not exist.

    Parameters
    ----------
    cells : ndarray of int, shape (m, k)
        The points of each cell.
    points : int
        Number of points.
    where : str
        The place, for the message.

    Raises
    ------
    InvalidValue
        A point number is negative or too large.
    """
    wrong = np.flatnonzero(((cells < 0) | (cells >= points)).any(axis=1))
    if wrong.size:
        raise InvalidValue(
            f"{wrong.size} of {len(cells)} cells name points that do not exist",
            where=f"{where + ', ' if where else ''}cell {wrong[0]}",
            value=cells[wrong[0]],
            remedy=f"use the point numbers 0 to {points - 1}",
        )


def field_arrays(fields: Fields | None, count: int, place: str) -> dict[str, FloatArray]:
    """Turn fields into arrays.

    Parameters
    ----------
    fields : mapping of str to array_like of float, or None
        Fields by name.
    count : int
        Number of points or cells.
    place : str
        ``"point"`` or ``"cell"``, for the message.

    Returns
    -------
    dict of str to ndarray of float, shape (count,) or (count, c)
        The fields.

    Raises
    ------
    InvalidValue
        A field has another shape, or a name that a file cannot hold.
    """
    arrays = {name: np.asarray(field, dtype=np.float64) for name, field in (fields or {}).items()}
    for name, array in arrays.items():
        if array.ndim not in (1, 2) or len(array) != count or array.size == 0:
            raise InvalidValue(
                f"a {place} field must have the shape ({count},) or ({count}, components)",
                where=f"field {name!r}",
                value=array.shape,
                cause="values at other places, such as those of points for cells",
                remedy="a value, or a row of components, for each of them",
            )
        if not name or name == "." or "/" in name:
            raise InvalidValue(
                "a field needs a name without '/'",
                where=f"{place} data",
                value=repr(name),
                cause="files take the sign for a folder",
                remedy="another name, such as stress_top",
            )
    return arrays
