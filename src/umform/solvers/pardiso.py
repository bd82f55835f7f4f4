"""MKL PARDISO, called directly in the library of the PyPI package `mkl`: another solver to compare with.

The equations of a sheet are put in order here (`umform._core.SheetOrder`): those of a fibre are one vertex, and
the separators are minimal cuts. PARDISO's own METIS orders each equation by itself, which takes longer and leaves
more to factorise; it orders all other matrices. Large sheets go in as blocks, one for two neighbouring fibres: the
analysis takes a quarter of the time then. PARDISO does not give the pivots of Cholesky factors of blocks, so
these are L D L^T without exchanges.

Against SuperLU it factorises strips 3 to 7 times faster and sheets 6 to 8 times. Cholesky comes first; a pivot
that is not positive leads to Bunch-Kaufman factors, which cost 1.0 to 1.5 times as much and know the inertia, until a
matrix has no negative pivot any more. LU for unsymmetric matrices costs twice as much. Matching and scaling would tie
the analysis to the values and make the factors of a sheet 3 times dearer: they are off, and the residual is
checked instead.
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

_POSITIVE = (CHOLESKY, IN_BLOCKS)  # factors that end with the first pivot that is not positive
_CAUSES = {
    -1: "the pattern is not consistent",
    -2: "not enough memory",
    -3: "the ordering failed",
    -8: "the factors need more than 2^31 entries",
}
# From so many equations on blocks are worth it: below, Cholesky factors take a few per cent less than those of blocks.
_LARGE = 100_000
# Below so many equations one thread: two gain up to 20 ms, but take 2 to 5 times as long as one on a busy machine.
_SMALL = 25_000


class Pardiso:
    """Supernodal factorisation: Cholesky, Bunch-Kaufman or LU; on all threads where the matrix is large enough."""

    name = "pardiso"
    _factored = False
    _handle: Handle

    def analyse(self, pattern: Pattern) -> None:
        """Order the equations by nested dissection; Cholesky is expected of a symmetric matrix."""
        self._pattern = pattern
        self._matrix = Matrix(
            np.empty(pattern.nnz),  # never touched: PARDISO reads the values that `factor` is given
            np.ascontiguousarray(pattern.indices, dtype=np.int32),
            np.ascontiguousarray(pattern.indptr, dtype=np.int32),
        )
        self._threads = 1 if pattern.n < _SMALL else None
        self._sheet = self._order()
        self._handles: dict[int, Handle] = {}
        self._next = self._first_kind()
        self._take(self._next)

    def factor(self, values: FloatArray) -> Factorisation:
        """Factorise; after a pivot that is not positive, Cholesky is left out until none is negative any more."""
        self._factored = False
        self._matrix.data = self._pattern.checked(values)
        with mkl.threads(self._threads):
            self._factorise()
            handle = self._handle
            # PARDISO does not always give the pivots of unsymmetric matrices: the residual of each solve is checked.
            weakest = vanishing_pivot(*handle.pivots()) if self._pattern.symmetric else None
        if weakest is not None or handle.perturbed_pivots:
            raise singular(self.name, None if weakest is None else handle.equation(weakest))
        self._factored = True
        return Factorisation(handle.negative_pivots if self._pattern.symmetric else None, handle.fill)

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve; without Cholesky the residual is checked, as pivots are not sought everywhere."""
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
        """What later answers follow from, beside the values: the kind of factors that the next matrix is tried with."""
        return self._next

    def recall(self, kind: int) -> None:
        """Go on with the kind of factors of a run that was kept."""
        self._next = self._first_kind() if kind in _POSITIVE else kind

    def _factorise(self) -> None:
        """Factors of the kind that is next, or of an indefinite matrix; and what the next matrix is tried with."""
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
        """Return the order of a sheet; None leaves it to PARDISO."""
        return sheet_of(self._pattern)

    def _first_kind(self) -> int:
        if not self._pattern.symmetric:
            return UNSYMMETRIC
        n = self._pattern.n
        blocks = n >= _LARGE and self._sheet is not None and worth_blocks(self._sheet, n)
        return IN_BLOCKS if blocks else CHOLESKY

    def _take(self, kind: int) -> None:
        """Turn to a kind of factors: those of another kind are forgotten, its analysis is kept."""
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
        from scipy import sparse  # slow to import, and Cholesky does without it

        shape = (self._pattern.n, self._pattern.n)
        matrix = sparse.csr_matrix((self._matrix.data, self._matrix.indices, self._matrix.indptr), shape=shape)
        product = matrix @ x
        if self._pattern.symmetric:
            product += matrix.T @ x - (matrix.diagonal() * x.T).T
        size = max(float(matrix.data.max()), -float(matrix.data.min()))
        check_accuracy(self.name, backward_error(b - product, size, x, b))


def available() -> bool:
    """Return whether the library of MKL is installed here."""
    return mkl.find() is not None
