"""Whether a weak pivot means that a matrix is singular: asked of the displacement that it lets go.

A pivot alone does not tell. Rounding leaves the more of one that should vanish the larger the mesh is, and a thin strip
that is well held may have less. So of a weak one the displacement w is found that the matrix K resists least, by
inverse iteration. A matrix with K w = 0 differs from K by a part of its entries of at least |K w| / ||K| |w||,
eq. (5.53) (W. Oettli & W. Prager, Compatibility of approximate solution of linear equations with given error bounds for
coefficients and right-hand sides, Numer. Math. 6 (1964) 405-409). Where that is below the rounding of the entries,
nothing says that the matrix is not that one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .protocol import FloatArray

#: Parts of its column: a pivot above the first is none to ask about, one below the second is not worth it.
_WEAK, _NOTHING = 1e-8, 1e-15
#: The entries are known to this part of themselves.
_ROUNDING = 0.5 * float(np.finfo(np.float64).eps)


def vanishing_equation(pivots: FloatArray, size: FloatArray, resistance: Callable[[int], float]) -> int | None:
    """Return the equation of the weakest pivot if the matrix cannot be told from a singular one.

    Parameters
    ----------
    pivots, size : arrays, shape (n,)
        The pivots, and the size of the entries that they come from.
    resistance : callable
        `resistance` of this module for the place of a pivot: called for a weak one only.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.where(size > 0.0, np.abs(pivots) / np.abs(size), 0.0)
    weakest = int(np.argmin(part))
    if part[weakest] > _WEAK:
        return None
    if part[weakest] > _NOTHING and resistance(weakest) > _ROUNDING:
        return None
    return weakest


def resistance(
    equation: int,
    row: FloatArray,
    column: FloatArray,
    solve: Callable[[FloatArray], FloatArray],
    magnitude: Callable[[FloatArray], FloatArray],
) -> float:
    """Return |K w| / ||K| |w|| for the displacement w that K resists least, as far as two solves find it.

    Parameters
    ----------
    equation : int
        Where the inverse iteration starts: the equation of a weak pivot.
    row, column : arrays, shape (n,)
        Scales that make the equations and the unknowns comparable.
    solve, magnitude : callables
        K^-1 x, and the product of x with the absolute values of K.
    """
    w = np.zeros(len(row))
    w[equation] = 1.0
    for _ in range(2):
        w = solve(w / row) / column
        length = float(np.linalg.norm(w))
        if not np.isfinite(length):
            return 0.0
        w /= length  # so that K w = (what w was) / length
    return 1.0 / (length * float(np.linalg.norm(row * magnitude(column * np.abs(w)))))
