"""Detect singular matrices up to round-off, by the displacement of least resistance.

A pivot alone is no criterion: the round-off of one that should vanish grows with the mesh, and a thin, well supported
strip may have a smaller one. Therefore inverse iteration finds the displacement w of least resistance. A matrix with K
w = 0 differs from K by a part of its entries of at least |K w| / ||K| |w||, eq. (5.53) (W. Oettli & W. Prager,
Compatibility of approximate solution of linear equations with given error bounds for coefficients and right-hand sides,
Numer. Math. 6 (1964) 405-409). If that is below the round-off of the entries, the matrix cannot be distinguished from a
singular one.

The test is made for a weak pivot, and for the first matrix of a pattern if a solution is large relative to its
right-hand side, eq. (5.75): a mechanism that hardly moves the equations which are eliminated last leaves no weak pivot.
Bending of very thin sheets resists less than round-off, too, eq. (5.80): the model decides on those, eq. (5.99).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .protocol import FloatArray

#: Range of pivots, relative to their columns, for which the test is made; smaller ones are round-off alone.
_WEAK, _NOTHING = 1e-8, 1e-15
#: Resistance above which a solution is no mechanism: round-off leaves 1e-13 of one.
_LARGE = 1e-10
#: Relative accuracy of the entries.
_ROUNDING = 0.5 * float(np.finfo(np.float64).eps)


@dataclass(frozen=True, eq=False)
class Loose:
    """A mechanism of a matrix.

    Attributes
    ----------
    equation : int
        That of the weakest pivot, or the one with the largest motion.
    motion : array, shape (n,), optional
        The displacement; None if unknown.
    """

    equation: int
    motion: FloatArray | None = None


#: Displacement -> relative resistance of the result of inverse iteration from there; and that result.
Resistance = Callable[[FloatArray], tuple[float, FloatArray]]


def weak_pivot(pivots: FloatArray, size: FloatArray, resistance: Resistance) -> Loose | None:
    """The mechanism, if the weakest pivot shows that the matrix cannot be distinguished from a singular one.

    Parameters
    ----------
    pivots, size : arrays, shape (n,)
        The pivots, and the magnitude of the entries that they come from.
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
    """The mechanism, if a solution for a right-hand side of all equations shows that the matrix is singular.

    Parameters
    ----------
    count : int
        Number of equations.
    once, resistance : callables
        `Iteration.resistance` after one solve, and after two more for a large solution.
    """
    part, motion = once(np.cos(np.arange(1.0, count + 1.0)))  # of all wavelengths, and reproducible
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
        """|K w| / ||K| |w|| for the w of least resistance after some solves, and w, all scaled."""
        w = start / float(np.linalg.norm(start))
        for _ in range(solves):
            w = self.solve(w / self.row) / self.column
            length = float(np.linalg.norm(w))
            if not np.isfinite(length):
                return 0.0, start
            if length == 0.0:
                return np.inf, start
            w /= length  # so that K w = (previous w) / length
        return 1.0 / (length * float(np.linalg.norm(self.row * self.magnitude(self.column * np.abs(w))))), w
