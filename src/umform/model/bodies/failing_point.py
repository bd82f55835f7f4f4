"""The point of an element at which its law failed, in words for a message."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.history_variables import named


def at_failing_point(block: _core.ShellBlock, cell: int, u: NDArray[np.float64]) -> str:
    """Point of a cell at which its law failed, as text; empty if it failed for another reason.

    Parameters
    ----------
    block : ShellBlock
        The elements.
    cell : int
        Row of the element in the block.
    u : ndarray, shape (nodes * 3,)
        Displacements at which it failed.
    """
    point, E = block.failing_point(cell, u)
    if point < 0:
        return ""
    text = f" at its point {point} with the strain ({', '.join(f'{value:.4g}' for value in E)})"
    eqps = named(block.state[cell, point], block.history_variables).get("eqps")
    return text if eqps is None else f"{text}, plastic strain {eqps.item():.4g}"
