"""The rolling direction of a sheet, which the local axes of the Gauss points may follow."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue

Floats = NDArray[np.float64]


def rolling_directions(rolling: ArrayLike | None, cells: int) -> Floats | None:
    """One unit vector, shape (3,), or one for each cell, shape (cells, 3); None stays None.

    Parameters
    ----------
    rolling : array_like, shape (3,) or (cells, 3), optional
        Rolling direction in global components, of any length.
    cells : int
        Number of cells of the mesh.

    Raises
    ------
    InvalidValue
        If a vector is zero or not finite, or their number is neither one nor that of the cells.
    """
    if rolling is None:
        return None
    vectors = np.array(rolling, dtype=float)
    if vectors.shape not in ((3,), (cells, 3)):
        raise InvalidValue(
            "rolling must be one vector, or one for each cell",
            where="rolling",
            value=f"shape {vectors.shape}",
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
