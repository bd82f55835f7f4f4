"""Protocol of sparse solvers: input, output and guarantees.

A solver analyses a pattern once, then factorises matrices and solves right-hand sides; it is independent of the model.
Positions in the pattern are equations: free degrees of freedom, counted from 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidValue, NotFinite, SingularMatrix, SolveError

if TYPE_CHECKING:
    from scipy import sparse

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Pattern:
    """Pattern of a sparse matrix: compressed rows, columns sorted, every diagonal entry present.

    Parameters
    ----------
    n : int
        Number of equations.
    indptr : array of int32, shape (n + 1,)
        Start of each row in `indices`.
    indices : array of int32, shape (nnz,)
        Column of each entry.
    symmetric : bool
        True if only the upper triangle (with the diagonal) of a symmetric matrix is stored.
    """

    n: int
    indptr: IntArray
    indices: IntArray
    symmetric: bool

    def __post_init__(self) -> None:
        """Reject an invalid pattern: the solvers would read outside of their arrays."""
        if len(self.indptr) != self.n + 1 or self.indptr[0] != 0 or self.indptr[-1] != len(self.indices):
            raise _bad_pattern("the row starts do not fit the number of equations and of columns")
        lengths = np.diff(self.indptr)
        if np.any(lengths < 1) or np.any(self.indices < 0) or np.any(self.indices >= self.n):
            raise _bad_pattern("a row is empty or a column lies outside of the matrix")
        falls = self.indices[1:] <= self.indices[:-1]
        falls[self.indptr[1:-1] - 1] = False  # from row to row
        if falls.any():
            raise _bad_pattern("the columns of a row are not sorted or occur twice")
        if self.symmetric and np.array_equal(self.indices[self.indptr[:-1]], np.arange(self.n)):
            return  # each row begins with its diagonal entry
        rows = self.rows
        if np.count_nonzero(self.indices == rows) < self.n:
            raise _bad_pattern("a diagonal entry is missing")
        if self.symmetric:
            raise _bad_pattern("a symmetric pattern holds entries below the diagonal")

    @property
    def nnz(self) -> int:
        """Number of stored entries."""
        return len(self.indices)

    @property
    def rows(self) -> IntArray:
        """Row of each stored entry."""
        return np.repeat(np.arange(self.n, dtype=np.int32), np.diff(self.indptr))

    def upper(self) -> tuple[IntArray, IntArray] | None:
        """Starts and columns of the rows of the upper triangle; None if the pattern is not symmetric."""
        if self.symmetric:
            return np.ascontiguousarray(self.indptr, np.int32), np.ascontiguousarray(self.indices, np.int32)
        from scipy import sparse  # the import is slow

        shape = (self.n, self.n)
        mirrored = sparse.csr_matrix((np.empty(self.nnz, np.int8), self.indices, self.indptr), shape=shape).tocsc()
        if not (np.array_equal(mirrored.indptr, self.indptr) and np.array_equal(mirrored.indices, self.indices)):
            return None
        rows = self.rows
        above = self.indices >= rows
        indptr = np.concatenate([[0], np.cumsum(np.bincount(rows[above], minlength=self.n))])
        return indptr.astype(np.int32), self.indices[above].astype(np.int32)

    def positions(self) -> sparse.csr_matrix:
        """The full matrix; its entries are the positions of the values, counted from 1."""
        from scipy import sparse  # the import is slow

        counted = np.arange(1, self.nnz + 1, dtype=np.int64)
        stored = sparse.csr_matrix((counted, self.indices, self.indptr), shape=(self.n, self.n))
        if not self.symmetric:
            return stored
        return (stored + sparse.triu(stored, 1).T).tocsr()

    def checked(self, values: FloatArray) -> FloatArray:
        """The values as contiguous float64; a wrong number of them, NaN and infinity are refused."""
        values = np.ascontiguousarray(values, dtype=np.float64)  # no copy if they are already
        if values.shape != (self.nnz,):
            raise InvalidValue(
                "The values do not fit the pattern of the matrix",
                value=f"shape {values.shape} instead of ({self.nnz},)",
                remedy="analyse the pattern that the values belong to",
            )
        with np.errstate(over="ignore", invalid="ignore"):
            total = float(values.sum())
        if not math.isfinite(total):  # a sum may overflow: check each value
            finite = np.isfinite(values)
            if finite.all():
                return values
            entry = int(np.argmin(finite))
            raise NotFinite(
                "The matrix holds a value that is not finite",
                where=f"equation {int(np.searchsorted(self.indptr, entry, side='right')) - 1}",
                value=float(values[entry]),
                cause="an element or a contact point has left the range of its formulas",
                remedy="take a smaller step",
            )
        return values

    def checked_rhs(self, rhs: FloatArray) -> FloatArray:
        """Right-hand sides as float64; wrong sizes and non-finite values are refused."""
        rhs = np.asarray(rhs, dtype=np.float64)
        if rhs.ndim not in (1, 2) or len(rhs) != self.n:
            raise InvalidValue(
                "The right-hand side does not fit the matrix",
                value=f"shape {rhs.shape} for {self.n} equations",
                remedy="give one number per equation, several right-hand sides as columns",
            )
        finite = np.isfinite(rhs)
        if not finite.all():
            raise NotFinite(
                "The right-hand side holds a value that is not finite",
                where=f"equation {int(np.argwhere(~finite)[0, 0])}",
                cause="an element or a contact point has left the range of its formulas",
                remedy="take a smaller step",
            )
        return rhs


@dataclass(frozen=True)
class Factorisation:
    """Information on the matrix from a factorisation.

    Parameters
    ----------
    negative_pivots : int or None
        Number of negative pivots of a symmetric matrix, which is that of its negative eigenvalues; None if it is
        unknown or the matrix is not symmetric. A stable equilibrium has none.
    fill : int
        Number of entries in the factors.
    odd : bool or None
        Whether the determinant is negative, which means an odd number of negative real eigenvalues; None if unknown.
    """

    negative_pivots: int | None
    fill: int
    odd: bool | None = None


class SparseSolver(Protocol):
    """A direct solver: `analyse` once per pattern, `factor` once per matrix, `solve` once per right-hand side."""

    name: str

    def analyse(self, pattern: Pattern) -> None:
        """Order the equations and plan the factorisation; earlier factors are released."""

    def factor(self, values: FloatArray) -> Factorisation:
        """Factorise the matrix with these values on the last analysed pattern.

        The values are not copied: they must not change while the factors are in use.

        Raises
        ------
        NotFinite
            If a value is NaN or infinite.
        SingularMatrix
            If a pivot vanishes; `value` is the number of its equation if the solver knows it.
        """

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve K x = rhs, for one right-hand side (1D) or for the columns of several (2D)."""


@runtime_checkable
class Remembering(Protocol):
    """A solver whose results depend on previous matrices in the last bits: a checkpoint keeps its state."""

    def memory(self) -> int:
        """State that affects later results, besides the values."""

    def recall(self, kind: int) -> None:
        """Restore this state."""


@runtime_checkable
class Accepting(Protocol):
    """A solver whose factors can be used although `factor` refused them and named a displacement."""

    def accept(self) -> Factorisation:
        """Use these factors."""


# A pivot below this part of its diagonal entry is rounding error. Rounding leaves 1e-14 and more of a pivot that
# should vanish, growing with the mesh, so that a loose part of a large one may pass; a sheet that is free as a whole is
# refused before, by the model. Thin beams that are well held come near: 7e-13 for one of 1/3750 of its length.
_ROUNDING = 2e-13


def vanishing_pivot(pivots: FloatArray, scale: FloatArray) -> int | None:
    """Position of the weakest pivot if it is round-off.

    Parameters
    ----------
    pivots, scale : arrays, shape (n,)
        The pivots, and the magnitude of the same entries before the elimination.
    """
    excess = np.abs(pivots) - _ROUNDING * np.abs(scale)
    weakest = int(np.argmin(excess))
    return weakest if excess[weakest] < 0 else None


def backward_error(residual: FloatArray, size: float, x: FloatArray, rhs: FloatArray) -> float:
    """Residual relative to ``size |x| + |rhs|``, the largest of all right-hand sides.

    Round-off alone leaves about 1e-16; NaN if the solution is not finite.
    """
    whole = size * np.abs(x).max(axis=0) + np.abs(rhs).max(axis=0)
    return float(np.max(np.abs(residual).max(axis=0) / np.where(whole == 0.0, 1.0, whole)))


def check_accuracy(solver: str, error: float) -> None:
    """Reject a solution whose backward error is far above round-off."""
    if not error <= 1e-8:
        raise SolveError(
            "The solution of the linear equations is not accurate",
            where=f"solver {solver!r}",
            value=f"residual {error:.1e}",
            cause="the matrix needs pivots far from the diagonal, or is nearly singular",
            remedy="check the supports, and the sizes of the stiffnesses; compare with another solver",
        )


def singular(solver: str, equation: int | None, motion: FloatArray | None = None) -> SingularMatrix:
    """The error for a matrix with a vanishing pivot of this equation, with the displacement that it does not resist."""
    error = SingularMatrix(
        "The matrix is singular",
        where=f"solver {solver!r}" if equation is None else f"equation {equation}, solver {solver!r}",
        value=equation,
        cause="a part is free to move as a rigid body, or a limit point has been met",
        remedy="check the supports; at a limit point prescribe displacements instead of forces",
    )
    error.motion = motion
    return error


def not_factored() -> RuntimeError:
    """The error for a solve without factors."""
    return RuntimeError("solve() needs a successful factor() first")


def _bad_pattern(what: str) -> InvalidValue:
    return InvalidValue(
        f"This is no pattern of a matrix: {what}",
        remedy="sort the columns of each row, store the diagonal, and nothing below it if symmetric",
    )
