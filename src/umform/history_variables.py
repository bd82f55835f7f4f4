"""Histories by name: where each variable that a point remembers is among its numbers.

A law of the kernels states names and sizes once; `history_variables` of a law and of a block are these tables. A law of
the user's own states them as ``state={"back_stress": 6, "eqps": 1}``. Columns are found here only.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import accumulate
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from umform import _core

Floats = NDArray[np.float64]


def columns(history_variables: Mapping[str, int]) -> dict[str, slice]:
    """Columns of each quantity in the last axis of a history.

    Parameters
    ----------
    history_variables : mapping of str to int
        Names and sizes in their order.
    """
    ends = accumulate(history_variables.values())
    return {name: slice(end - size, end) for (name, size), end in zip(history_variables.items(), ends, strict=True)}


def named(history: Floats, history_variables: Mapping[str, int]) -> dict[str, Floats]:
    """The history_variables of a history by name, as views.

    Parameters
    ----------
    history : ndarray, shape (..., numbers)
        Of any points.
    history_variables : mapping of str to int
        Names and sizes in their order.

    Returns
    -------
    dict of str to ndarray, shape (..., size)

    Examples
    --------
    >>> import numpy as np
    >>> from umform.history_variables import named
    >>> history = np.arange(14.0).reshape(2, 7)  # of two points
    >>> named(history, {"back_stress": 6, "eqps": 1})["eqps"]
    array([[ 6.],
           [13.]])
    """
    return {name: history[..., part] for name, part in columns(history_variables).items()}


def history_of(block: _core.ShellBlock | _core.ContactBlock) -> dict[str, Floats]:
    """A copy of the converged history of elements (cells, points, size) or facets (points, size), by name."""
    return named(block.state, block.history_variables)
