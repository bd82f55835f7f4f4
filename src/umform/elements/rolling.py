"""The rolling direction of a sheet, with which the local axes of the Gauss points may be aligned."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.spec import check_arguments

Floats = NDArray[np.float64]
Vector = tuple[float, float, float]
#: One vector, one for each cell, or a function of the cell centres that returns these.
Rolling = ArrayLike | Callable[[Floats, Floats, Floats], ArrayLike]


def rolling_at(angle: float, line: ArrayLike = (0.0, 1.0, 0.0), normal: ArrayLike = (0.0, 0.0, 1.0)) -> Vector:
    """Rolling direction at an angle to the bend line.

    Parameters
    ----------
    angle : float
        Degrees from the bend line to the rolling direction, counter-clockwise about the normal: 0 along the line, 90
        across it.
    line, normal : array_like, shape (3,)
        Bend line, and normal of the flat sheet.

    Returns
    -------
    tuple of float
        A unit vector.

    Raises
    ------
    InvalidValue
        If the angle is not finite, or the line is along the normal.

    Examples
    --------
    >>> from umform import rolling_at
    >>> rolling_at(0.0)
    (0.0, 1.0, 0.0)
    """
    check_arguments(rolling_at, angle=angle)
    along, up = np.array(line, dtype=float), np.array(normal, dtype=float)
    across = np.cross(along, up) if along.shape == up.shape == (3,) else np.zeros(3)
    if not (np.isfinite(angle) and np.linalg.norm(across) > 0.0):
        raise InvalidValue(
            "a rolling direction needs a finite angle, and a bend line that is not along the normal of the sheet",
            where="rolling",
            value=f"angle {angle}, line {along.tolist()}, normal {up.tolist()}",
            cause="the same direction twice, or a vector of zeros",
            remedy="rolling_at(45, line=(0, 1, 0), normal=(0, 0, 1))",
        )
    across /= np.linalg.norm(across)
    along = np.cross(up, across)
    along /= np.linalg.norm(along)
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    x, y, z = (float(part) + 0.0 for part in c * along - s * across)
    return x, y, z


def rolling_directions(rolling: Rolling | None, centres: Floats) -> Floats | None:
    """One unit vector, shape (3,), or one for each cell, shape (cells, 3); None stays None.

    Parameters
    ----------
    rolling : array_like, shape (3,) or (cells, 3), or callable, optional
        Rolling direction in global components, of any length; or a function of the coordinates x, y, z of the centres
        of the cells, arrays (cells,), that returns the vectors (cells, 3).
    centres : ndarray, shape (cells, 3)
        Centres of the cells.

    Raises
    ------
    InvalidValue
        If a vector is zero or not finite, or their number is wrong.
    """
    if rolling is None:
        return None
    cells = len(centres)
    given = rolling(*centres.T) if callable(rolling) else rolling
    try:
        vectors = np.array(given, dtype=float)
    except (TypeError, ValueError):  # a letter, for instance
        vectors = np.empty(0)
    if vectors.shape not in ((3,), (cells, 3)):
        raise InvalidValue(
            "rolling must be one vector, or one for each cell",
            where="rolling",
            value=given if isinstance(given, str) else f"shape {vectors.shape}",
            cause="a name of an axis, or a vector for each node",
            remedy=f"rolling=(1, 0, 0), or an array of shape ({cells}, 3)",
        )
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    wrong = ~(np.isfinite(length) & (length > 0.0))
    if wrong.any():
        first = int(np.argmax(wrong))
        raise InvalidValue(
            "a rolling direction must have a length",
            where="rolling" if vectors.ndim == 1 else f"rolling, cell {first}",
            value=vectors.reshape(-1, 3)[first].tolist(),
            cause="a vector of zeros, or an entry that is no number",
            remedy="rolling=(1, 0, 0)",
        )
    directions: Floats = vectors / length
    return directions
