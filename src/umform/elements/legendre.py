"""Legendre polynomials."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def legendre(order: int, t: NDArray[np.float64]) -> NDArray[np.float64]:
    """Legendre polynomial by Bonnet's recursion; importing those of numpy is slow."""
    before, here = np.zeros_like(t), np.ones_like(t)
    for n in range(order):
        before, here = here, ((2 * n + 1) * t * here - n * before) / (n + 1)
    return here
