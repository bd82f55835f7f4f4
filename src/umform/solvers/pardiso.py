"""MKL PARDISO, called directly in the library of the PyPI package `mkl`: the fastest but for narrow bands.

The equations of a sheet are put in order here (`umform._core.SheetOrder`): those of a fibre are one vertex, and
the separators are minimal cuts. PARDISO's own METIS orders each equation by itself, which takes longer and leaves
more to factorise; it orders all other matrices. Large sheets go in as blocks, one for two neighbouring fibres: the
analysis takes a quarter of the time then. PARDISO does not give the pivots of Cholesky factors of blocks, so
these are L D L^T without exchanges.

Against SuperLU it factorises strips 3 to 7 times faster and sheets 10 times and more. Cholesky comes first;
once a pivot is not positive the pattern stays with Bunch-Kaufman factors, which cost 1.0 to 1.5 times as much
and know the inertia; LU for unsymmetric matrices costs twice as much. Matching and scaling would tie the
analysis to the values and make the factors of a sheet 3 times dearer: they are off, and the residual is
checked instead.
"""

from __future__ import annotations

import ctypes
import weakref
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..errors import SolveError
from . import mkl
from .protocol import (
    Factorisation,
    FloatArray,
    IntArray,
    Pattern,
    backward_error,
    check_accuracy,
    not_factored,
    singular,
    vanishing_pivot,
)
from .sheet_blocks import SheetBlocks, worth_blocks

_CHOLESKY, _INDEFINITE, _UNSYMMETRIC = 2, -2, 11
_IN_BLOCKS = -20  # PARDISO's type -2 too
_POSITIVE = (_CHOLESKY, _IN_BLOCKS)  # factors that end with the first pivot that is not positive
_ANALYSE, _FACTOR, _SOLVE, _DIVIDE, _RELEASE = 11, 22, 33, 332, -1
_PIVOT_NOT_POSITIVE = -4
_CAUSES = {
    -1: "the pattern is not consistent",
    -2: "not enough memory",
    -3: "the ordering failed",
    -8: "the factors need more than 2^31 entries",
}
# From so many equations on blocks are worth it: below, Cholesky factors take a few per cent less than those of blocks.
_LARGE = 100_000


class Pardiso:
    """Supernodal factorisation on all threads: Cholesky, Bunch-Kaufman or LU."""

    name = "pardiso"
    _factored = False
    _handle: _Handle

    def analyse(self, pattern: Pattern) -> None:
        """Order the equations by nested dissection; Cholesky is expected of a symmetric matrix."""
        self._pattern = pattern
        self._matrix = _Matrix(
            np.empty(pattern.nnz),  # never touched: PARDISO reads the values that `factor` is given
            np.ascontiguousarray(pattern.indices, dtype=np.int32),
            np.ascontiguousarray(pattern.indptr, dtype=np.int32),
        )
        self._sheet = self._order()
        self._start(self._first_kind())

    def factor(self, values: FloatArray) -> Factorisation:
        """Factorise; the first pivot that is not positive ends the use of Cholesky for this pattern."""
        self._factored = False
        self._matrix.data = self._pattern.checked(values)
        code = self._handle.call(_FACTOR, self._matrix)
        if code == _PIVOT_NOT_POSITIVE and self._handle.kind in _POSITIVE:
            self._start(_INDEFINITE)
            code = self._handle.call(_FACTOR, self._matrix)
        self._check(code, "factorise")
        handle = self._handle
        # PARDISO does not always give the pivots of unsymmetric matrices; there the residual of each solve is checked.
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
        self._check(self._handle.call(_SOLVE, self._matrix, b, x), "solve")
        if self._handle.kind not in _POSITIVE:
            self._check_residual(x, b)
        return x

    def memory(self) -> int:
        """What later answers follow from, beside the values: the kind of factors that the pattern has."""
        return self._handle.kind

    def recall(self, kind: int) -> None:
        """Go on with the kind of factors of a run that was kept."""
        if kind in _POSITIVE:
            kind = self._first_kind()
        if self._handle.kind != kind:
            self._start(kind)

    def _order(self) -> _core.SheetOrder | None:
        """Return the order of a sheet; None leaves it to PARDISO."""
        if not self._pattern.symmetric:
            return None
        sheet = _core.SheetOrder(self._matrix.indptr, self._matrix.indices)
        return sheet if len(sheet.vertices) else None

    def _first_kind(self) -> int:
        if not self._pattern.symmetric:
            return _UNSYMMETRIC
        n = self._pattern.n
        blocks = n >= _LARGE and self._sheet is not None and worth_blocks(self._sheet, n)
        return _IN_BLOCKS if blocks else _CHOLESKY

    def _start(self, kind: int) -> None:
        self._factored = False
        if self._sheet is not None and kind == _IN_BLOCKS:
            self._handle = _BlockHandle(self._sheet)
        else:
            self._handle = _Handle(kind, self._matrix)
            if self._sheet is not None:
                self._handle.eliminate_in(self._sheet.equations)
        self._check(self._handle.call(_ANALYSE, self._matrix), "analyse")

    def _check(self, code: int, deed: str) -> None:
        if code == _PIVOT_NOT_POSITIVE:
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


@dataclass(eq=False)
class _Matrix:
    """The stored entries in compressed rows, where PARDISO reads them."""

    data: FloatArray
    indices: IntArray
    indptr: IntArray


class _Handle:
    """PARDISO's memory for one matrix, released with this object.

    Parameters
    ----------
    kind : int
        PARDISO's type of matrix.
    matrix : _Matrix or SheetBlocks
        The stored entries; its pattern stays the same from call to call.
    """

    def __init__(self, kind: int, matrix: _Matrix | SheetBlocks) -> None:
        n = len(matrix.indptr) - 1
        self.kind = kind
        self.order = np.zeros(n, dtype=np.int32)
        self._library = mkl.library()
        self._memory = np.zeros(64, dtype=np.int64)
        self._parameters = np.zeros(64, dtype=np.int32)
        for place, value in _PARAMETERS.items():
            self._parameters[place] = value
        weakref.finalize(self, _call, self._library, self._memory, self._parameters, kind, _RELEASE, matrix, self.order)

    def call(self, phase: int, matrix: _Matrix, b: FloatArray | None = None, x: FloatArray | None = None) -> int:
        """Run a phase and return PARDISO's error code."""
        return _call(self._library, self._memory, self._parameters, self.kind, phase, matrix, self.order, b, x)

    def eliminate_in(self, order: NDArray[np.int32]) -> None:
        """Have the analysis take an order instead of looking for one."""
        self.order[:] = order
        self._parameters[4] = 1

    @property
    def fill(self) -> int:
        """Number of entries in the factors."""
        return int(self._parameters[17])

    @property
    def negative_pivots(self) -> int:
        """Number of negative pivots of a symmetric matrix; PARDISO counts none under Cholesky."""
        return int(self._parameters[22])

    @property
    def perturbed_pivots(self) -> int:
        """Number of pivots that PARDISO has replaced because they vanish beside the norm of the matrix."""
        return int(self._parameters[13])

    def pivots(self) -> tuple[FloatArray, FloatArray]:
        """Return the pivots and the diagonal of the matrix, both in the order of elimination."""
        pivots, diagonal = np.zeros(len(self.order)), np.zeros(len(self.order))
        self._library.pardiso_getdiag(
            _address(self._memory), _address(pivots), _address(diagonal), _integer(1), _integer(0)
        )
        return pivots, diagonal

    def equation(self, place: int) -> int:
        """Return the equation of a pivot from its place in the order of elimination."""
        return int(self.order[place])


class _BlockHandle(_Handle):
    """L D L^T factors, without exchanges, of the matrix of a sheet in blocks: those of a positive definite one."""

    def __init__(self, sheet: _core.SheetOrder) -> None:
        self._blocks = SheetBlocks(sheet)
        super().__init__(_INDEFINITE, self._blocks)
        self.kind = _IN_BLOCKS
        self.eliminate_in(sheet.vertices)
        self._parameters[20] = 0  # no exchanges
        self._parameters[36] = self._blocks.size

    def call(self, phase: int, matrix: _Matrix, b: FloatArray | None = None, x: FloatArray | None = None) -> int:
        """Run a phase with the entries of the pattern; a pivot that is not positive ends a factorisation."""
        if phase == _FACTOR:
            self._blocks.fill(matrix.indptr, matrix.indices, matrix.data)
            self._diagonal = matrix.data[matrix.indptr[:-1]]
        spread = None if b is None else self._blocks.spread(b)
        found = None if spread is None else np.empty_like(spread)
        code = self._run(phase, spread, found)
        if phase == _FACTOR and code == 0 and (self.negative_pivots or self.perturbed_pivots):
            return _PIVOT_NOT_POSITIVE
        if x is not None and found is not None:
            x[...] = self._blocks.gather(found)
        return code

    @property
    def fill(self) -> int:
        """Number of entries in the factors."""
        return super().fill * self._blocks.size**2

    def pivots(self) -> tuple[FloatArray, FloatArray]:
        """Return the pivots and the diagonal of the matrix, both in the order of the equations."""
        ones = self._blocks.spread(np.ones(len(self._diagonal)))
        inverse = np.empty_like(ones)
        self._run(_DIVIDE, ones, inverse)
        return 1.0 / self._blocks.gather(inverse), self._diagonal

    def equation(self, place: int) -> int:
        """Return the equation of a pivot."""
        return place

    def _run(self, phase: int, b: FloatArray | None, x: FloatArray | None) -> int:
        return _call(self._library, self._memory, self._parameters, _INDEFINITE, phase, self._blocks, self.order, b, x)


# By PARDISO's own numbers, counted from 0; what is not named is 0.
_PARAMETERS = {
    0: 1,  # these values instead of the defaults
    1: 2,  # nested dissection (METIS)
    4: 2,  # return the order of elimination; 1: take the one that is given
    9: 15,  # replace pivots below 1e-15 |K|
    17: -1,  # count the entries of the factors
    20: 1,  # Bunch-Kaufman pivots for symmetric indefinite matrices
    34: 1,  # rows and columns count from 0
    55: 1,  # keep the diagonal for `pardiso_getdiag`
}


def _call(
    library: ctypes.CDLL,
    memory: NDArray[np.int64],
    parameters: NDArray[np.int32],
    kind: int,
    phase: int,
    matrix: _Matrix | SheetBlocks,
    order: NDArray[np.int32],
    b: FloatArray | None = None,
    x: FloatArray | None = None,
) -> int:
    code = ctypes.c_int(0)
    columns = 1 if b is None or b.ndim == 1 else b.shape[1]
    library.pardiso(
        _address(memory),
        _integer(1),
        _integer(1),
        _integer(kind),
        _integer(phase),
        _integer(len(order)),
        _address(matrix.data),
        _address(matrix.indptr),
        _address(matrix.indices),
        _address(order),
        _integer(columns),
        _address(parameters),
        _integer(0),
        None if b is None else _address(b),
        None if x is None else _address(x),
        ctypes.byref(code),
    )
    return code.value


def _address(array: NDArray[np.generic]) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)


def _integer(value: int) -> object:
    return ctypes.byref(ctypes.c_int(value))


def available() -> bool:
    """Return whether the library of MKL is installed here."""
    return mkl.find() is not None
