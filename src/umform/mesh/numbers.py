"""Set operations on integers without numpy's, which import masked arrays: a tenth of the time of a short run."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def unique(numbers: ArrayLike) -> NDArray[Any]:
    """The sorted unique numbers of an array."""
    ordered = np.sort(np.asarray(numbers), axis=None)
    first = np.ones(ordered.size, dtype=bool)
    np.not_equal(ordered[1:], ordered[:-1], out=first[1:])
    return ordered[first]


def common(some: ArrayLike, others: ArrayLike) -> NDArray[Any]:
    """The sorted numbers that two arrays have in common."""
    both = np.sort(np.concatenate([unique(some), unique(others)]))
    twice: NDArray[Any] = both[1:][both[1:] == both[:-1]]
    return twice


def median(numbers: ArrayLike) -> float:
    """Median; NaN for an empty array."""
    ordered = np.sort(np.asarray(numbers, dtype=np.float64), axis=None)
    if ordered.size == 0:
        return math.nan
    return float(0.5 * (ordered[(ordered.size - 1) // 2] + ordered[ordered.size // 2]))
