"""Whether a matrix is singular as far as rounding lets anybody say: asked of the displacement that it resists least.

A pivot alone does not tell. Rounding leaves the more of one that should vanish the larger the mesh is, and a thin strip
that is well held may have less. So the displacement w is found that the matrix K resists least, by inverse iteration. A
matrix with K w = 0 differs from K by a part of its entries of at least |K w| / ||K| |w||, eq. (5.53) (W. Oettli & W.
Prager, Compatibility of approximate solution of linear equations with given error bounds for coefficients and
right-hand sides, Numer. Math. 6 (1964) 405-409). Where that is below the rounding of the entries, nothing says that the
matrix is not that one.

It is asked where a pivot is weak, and of the first matrix of a pattern where a solution is large beside its right-hand
side, eq. (5.75): a mechanism that hardly moves the equations which are eliminated last leaves no weak pivot. Bending of
very thin sheets resists less than rounding, too, eq. (5.80).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .protocol import FloatArray

#: Parts of its column: a pivot above the first is none to ask about, one below the second is nothing but rounding.
_WEAK, _NOTHING = 1e-8, 1e-15
#: A solution that its matrix resists more than this is none of a mechanism: rounding leaves 1e-13 of one.
_LARGE = 1e-10
#: The entries are known to this part of themselves.
_ROUNDING = 0.5 * float(np.finfo(np.float64).eps)


@dataclass(frozen=True, eq=False)
class Loose:
    """What a matrix does not resist.

    Attributes
    ----------
    equation : int
        That of the weakest pivot, or the one that moves most.
    motion : array, shape (n,), optional
        The displacement; None where it is not known.
    """

    equation: int
    motion: FloatArray | None = None


#: Displacement -> how much the matrix resists what inverse iteration from there finds, part of its entries; and that.
Resistance = Callable[[FloatArray], tuple[float, FloatArray]]


def weak_pivot(pivots: FloatArray, size: FloatArray, resistance: Resistance) -> Loose | None:
    """Return what is loose if the weakest pivot says that the matrix cannot be told from a singular one.

    Parameters
    ----------
    pivots, size : arrays, shape (n,)
        The pivots, and the size of the entries that they come from.
    resistance : callable
        `Iteration.resistance`: called for a weak pivot only.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.where(size > 0.0, np.abs(pivots) / np.abs(size), 0.0)
    weakest = int(np.argmin(part))
    if part[weakest] > _WEAK:
        return None
    if not part[weakest] > 0.0:
        return Loose(weakest)  # nothing can be divided by it
    start = np.zeros(len(pivots))
    start[weakest] = 1.0
    least, motion = resistance(start)
    return None if least > _ROUNDING and part[weakest] > _NOTHING else Loose(weakest, motion)


def large_solution(count: int, once: Resistance, resistance: Resistance) -> Loose | None:
    """Return what is loose if a solution for a right-hand side of all equations says that the matrix is singular.

    Parameters
    ----------
    count : int
        Number of equations.
    once, resistance : callables
        `Iteration.resistance` after one solve, and after two more of what is large.
    """
    part, motion = once(np.cos(np.arange(1.0, count + 1.0)))  # of all wavelengths, and the same in each run
    if part > _LARGE:
        return None
    least, motion = resistance(motion)
    return None if least > _ROUNDING else Loose(int(np.argmax(np.abs(motion))), motion)


@dataclass(frozen=True, eq=False)
class Iteration:
    """Inverse iteration with factors.

    Attributes
    ----------
    row, column : arrays, shape (n,)
        Scales that make the equations and the unknowns comparable.
    solve, magnitude : callables
        K^-1 x, and the product of x with the absolute values of K.
    """

    row: FloatArray
    column: FloatArray
    solve: Callable[[FloatArray], FloatArray]
    magnitude: Callable[[FloatArray], FloatArray]

    def resistance(self, start: FloatArray, solves: int = 2) -> tuple[float, FloatArray]:
        """Return |K w| / ||K| |w|| for the w that K resists least, as far as some solves find it, and w, all scaled."""
        w = start / float(np.linalg.norm(start))
        for _ in range(solves):
            w = self.solve(w / self.row) / self.column
            length = float(np.linalg.norm(w))
            if not np.isfinite(length):
                return 0.0, start
            if length == 0.0:
                return np.inf, start
            w /= length  # so that K w = (what w was) / length
        return 1.0 / (length * float(np.linalg.norm(self.row * self.magnitude(self.column * np.abs(w))))), w
