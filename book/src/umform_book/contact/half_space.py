"""A block that is large enough for a half-space, with a fine mesh where a tool touches it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.mesh import Mesh

Floats = NDArray[np.float64]

E, NU = 1000.0, 0.3
#: Modulus of an elastic half-space against a rigid tool.
E_STAR = E / (1 - NU**2)


def growing(size: float, fine: float, end: float, growth: float) -> Floats:
    """Grid lines from 0 to ``end``: of equal ``size`` up to ``fine``, then each larger than the last by ``growth``."""
    lines = list(np.linspace(0.0, fine, round(fine / size) + 1))
    step = size
    while lines[-1] < end:
        step *= growth
        lines.append(lines[-1] + step)
    x = np.array(lines)
    coarse = x > fine
    x[coarse] = fine + (x[coarse] - fine) * (end - fine) / (x[-1] - fine)
    return x


def block(size: float, end: float, growth: float, cell: str, *, plane: bool) -> Mesh:
    """Block below z = 0 with elements of a size around the origin.

    Parameters
    ----------
    size : float
        Edge of the elements where the tool touches.
    end : float
        Half-width and depth of the block.
    growth : float
        Size of an element over that of its neighbour nearer to the tool.
    cell : {"hex8", "hex18"}
        Cell type.
    plane : bool
        One element of width 1 along y, for plane strain; else a quarter of a block.
    """
    across = growing(size, 1.5 if size < 0.5 else 2.0, end, growth)
    depth = -growing(size, 1.0, end, growth)[::-1]
    return mesh.grid(across, [0.0, 1.0] if plane else across, depth, cell)
