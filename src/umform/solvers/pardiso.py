"""MKL PARDISO, called directly in the library of the PyPI package `mkl`, for comparison.

The equations of a sheet are ordered here (`umform._core.SheetOrder`): those of a fibre are one vertex, and the
separators are minimal cuts. PARDISO's METIS orders single equations, which takes longer and gives more entries; it is
used for all other matrices. Large sheets are stored as blocks of two neighbouring fibres: the analysis then takes a
quarter of the time. PARDISO does not return the pivots of Cholesky factors of blocks, so these are L D L^T without
exchanges.

It factorises strips 3 to 7 times faster than SuperLU and sheets 6 to 8 times. A symmetric matrix is first tried with
Cholesky; a pivot that is not positive leads to Bunch-Kaufman factors, which cost 1.0 to 1.5 times as much and give the
inertia, until a matrix has no negative pivot. LU for unsymmetric matrices costs twice as much. Matching and scaling
would make the analysis depend on the values and the factors of a sheet 3 times more expensive: they are off, and the
residual is checked instead.
"""

from __future__ import annotations

import numpy as np

from .. import _core
from ..errors import SolveError
from . import mkl
from .pardiso_handle import (
    ANALYSE,
    CHOLESKY,
    FACTOR,
    IN_BLOCKS,
    INDEFINITE,
    PIVOT_NOT_POSITIVE,
    SOLVE,
    UNSYMMETRIC,
    BlockHandle,
    Handle,
    Matrix,
)
from .protocol import (
    Factorisation,
    FloatArray,
    Pattern,
    backward_error,
    check_accuracy,
    not_factored,
    singular,
    vanishing_pivot,
)
from .sheet_blocks import sheet_of, worth_blocks

_POSITIVE = (CHOLESKY, IN_BLOCKS)  # factors that stop at the first pivot that is not positive
_CAUSES = {
    -1: "the pattern is not consistent",
    -2: "not enough memory",
    -3: "the ordering failed",
    -8: "the factors need more than 2^31 entries",
}
# Smallest number of equations for blocks: below, Cholesky factors are a few per cent faster.
_LARGE = 100_000
# Below this number of equations one thread: two save up to 20 ms, but take 2 to 5 times as long on a busy machine.
_SMALL = 25_000


class Pardiso:
    """Supernodal factorisation: Cholesky, Bunch-Kaufman or LU; on all threads where the matrix is large enough."""

    name = "pardiso"
    _factored = False
    _handle: Handle

    def analyse(self, pattern: Pattern) -> None:
        """Order the equations by nested dissection; a symmetric matrix is first tried with Cholesky."""
        self._pattern = pattern
        self._matrix = Matrix(
            np.empty(pattern.nnz),  # not allocated: PARDISO reads the values given to `factor`
            np.ascontiguousarray(pattern.indices, dtype=np.int32),
            np.ascontiguousarray(pattern.indptr, dtype=np.int32),
        )
        self._threads = 1 if pattern.n < _SMALL else None
        self._sheet = self._order()
        self._handles: dict[int, Handle] = {}
        self._next = self._first_kind()
        self._take(self._next)

    def factor(self, values: FloatArray) -> Factorisation:
        """Factorise; after a pivot that is not positive, Cholesky is skipped until no pivot is negative."""
        self._factored = False
        self._matrix.data = self._pattern.checked(values)
        with mkl.threads(self._threads):
            self._factorise()
            handle = self._handle
            # PARDISO does not always return the pivots of unsymmetric matrices: the residual of each solve is checked.
            weakest = vanishing_pivot(*handle.pivots()) if self._pattern.symmetric else None
        if weakest is not None or handle.perturbed_pivots:
            raise singular(self.name, None if weakest is None else handle.equation(weakest))
        self._factored = True
        return Factorisation(handle.negative_pivots if self._pattern.symmetric else None, handle.fill)

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve; without Cholesky the residual is checked, since pivoting is restricted."""
        if not self._factored:
            raise not_factored()
        b = np.array(self._pattern.checked_rhs(rhs), order="F")
        x = np.empty_like(b)
        with mkl.threads(self._threads):
            self._check(self._handle.call(SOLVE, self._matrix, b, x), "solve")
        if self._handle.kind not in _POSITIVE:
            self._check_residual(x, b)
        return x

    def memory(self) -> int:
        """State that affects later results, besides the values: the kind of factors for the next matrix."""
        return self._next

    def recall(self, kind: int) -> None:
        """Restore the kind of factors of a run."""
        self._next = self._first_kind() if kind in _POSITIVE else kind

    def _factorise(self) -> None:
        """Factors of the next kind, or of an indefinite matrix; and the kind for the next matrix."""
        tried = self._next
        self._take(tried)
        code = self._handle.call(FACTOR, self._matrix)
        if code == PIVOT_NOT_POSITIVE and tried in _POSITIVE:
            self._next = INDEFINITE
            self._take(INDEFINITE)
            code = self._handle.call(FACTOR, self._matrix)
        self._check(code, "factorise")
        if tried == INDEFINITE and not self._handle.negative_pivots:
            self._next = self._first_kind()

    def _order(self) -> _core.SheetOrder | None:
        """The order of a sheet; None leaves the order to PARDISO."""
        return sheet_of(self._pattern)

    def _first_kind(self) -> int:
        if not self._pattern.symmetric:
            return UNSYMMETRIC
        n = self._pattern.n
        blocks = n >= _LARGE and self._sheet is not None and worth_blocks(self._sheet, n)
        return IN_BLOCKS if blocks else CHOLESKY

    def _take(self, kind: int) -> None:
        """Select a kind of factors: those of another kind are released, its analysis is kept."""
        if self._handles and self._handle.kind == kind:
            return
        self._factored = False
        if self._handles:
            self._handle.forget()
        if kind in self._handles:
            self._handle = self._handles[kind]
            return
        self._handle = self._handles[kind] = self._made(kind)
        with mkl.threads(self._threads):
            self._check(self._handle.call(ANALYSE, self._matrix), "analyse")

    def _made(self, kind: int) -> Handle:
        if self._sheet is not None and kind == IN_BLOCKS:
            return BlockHandle(self._sheet)
        handle = Handle(kind, self._matrix)
        if self._sheet is not None:
            handle.eliminate_in(self._sheet.equations)
        return handle

    def _check(self, code: int, deed: str) -> None:
        if code == PIVOT_NOT_POSITIVE:
            raise singular(self.name, None)
        if code:
            raise SolveError(
                f"PARDISO could not {deed} the matrix",
                where=f"{self._pattern.n} equations, {self._pattern.nnz} entries",
                value=code,
                cause=_CAUSES.get(code, "see the error codes of PARDISO in the manual of MKL"),
                remedy="choose another solver, or a smaller model",
            )

    def _check_residual(self, x: FloatArray, b: FloatArray) -> None:
        from scipy import sparse  # imported late: slow, and Cholesky does not need it

        shape = (self._pattern.n, self._pattern.n)
        matrix = sparse.csr_matrix((self._matrix.data, self._matrix.indices, self._matrix.indptr), shape=shape)
        product = matrix @ x
        if self._pattern.symmetric:
            product += matrix.T @ x - (matrix.diagonal() * x.T).T
        size = max(float(matrix.data.max()), -float(matrix.data.min()))
        check_accuracy(self.name, backward_error(b - product, size, x, b))


def available() -> bool:
    """Whether MKL is installed."""
    return mkl.find() is not None
