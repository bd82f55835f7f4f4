"""PARDISO's memory for one matrix, and its phases."""

from __future__ import annotations

import ctypes
import weakref
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import _core
from . import mkl
from .protocol import FloatArray, IntArray
from .sheet_blocks import SheetBlocks

CHOLESKY, INDEFINITE, UNSYMMETRIC = 2, -2, 11
IN_BLOCKS = -20  # PARDISO's type -2 too
ANALYSE, FACTOR, SOLVE = 11, 22, 33
PIVOT_NOT_POSITIVE = -4
_FORGET, _DIVIDE, _RELEASE = 0, 332, -1


@dataclass(eq=False)
class Matrix:
    """The stored entries in compressed rows, as PARDISO reads them."""

    data: FloatArray
    indices: IntArray
    indptr: IntArray


class Handle:
    """PARDISO's memory for one matrix, released with this object.

    Parameters
    ----------
    kind : int
        PARDISO's type of matrix.
    matrix : Matrix or SheetBlocks
        The stored entries; its pattern is the same in all calls.
    """

    def __init__(self, kind: int, matrix: Matrix | SheetBlocks) -> None:
        n = len(matrix.indptr) - 1
        self.kind = self._type = kind
        self._stored = matrix
        self.order = np.zeros(n, dtype=np.int32)
        self._library = mkl.library()
        self._memory = np.zeros(64, dtype=np.int64)
        self._parameters = np.zeros(64, dtype=np.int32)
        for place, value in _PARAMETERS.items():
            self._parameters[place] = value
        weakref.finalize(self, _call, self._library, self._memory, self._parameters, kind, _RELEASE, matrix, self.order)

    def call(self, phase: int, matrix: Matrix, b: FloatArray | None = None, x: FloatArray | None = None) -> int:
        """Run a phase and return PARDISO's error code."""
        return _call(self._library, self._memory, self._parameters, self.kind, phase, matrix, self.order, b, x)

    def forget(self) -> None:
        """Release the memory of the factors, and keep the analysis."""
        _call(self._library, self._memory, self._parameters, self._type, _FORGET, self._stored, self.order)

    def eliminate_in(self, order: NDArray[np.int32]) -> None:
        """Use a given order in the analysis."""
        self.order[:] = order
        self._parameters[4] = 1

    @property
    def fill(self) -> int:
        """Number of entries in the factors."""
        return int(self._parameters[17])

    @property
    def negative_pivots(self) -> int:
        """Number of negative pivots of a symmetric matrix; PARDISO does not count them for Cholesky."""
        return int(self._parameters[22])

    @property
    def perturbed_pivots(self) -> int:
        """Number of pivots that PARDISO replaced because they are negligible relative to the norm of the matrix."""
        return int(self._parameters[13])

    def pivots(self) -> tuple[FloatArray, FloatArray]:
        """Return the pivots and the diagonal of the matrix, both in the order of elimination."""
        pivots, diagonal = np.zeros(len(self.order)), np.zeros(len(self.order))
        self._library.pardiso_getdiag(
            _address(self._memory), _address(pivots), _address(diagonal), _integer(1), _integer(0)
        )
        return pivots, diagonal

    def equation(self, place: int) -> int:
        """The equation of a pivot from its position in the order of elimination."""
        return int(self.order[place])


class BlockHandle(Handle):
    """L D L^T factors, without pivoting, of the block matrix of a sheet, for positive definite matrices."""

    def __init__(self, sheet: _core.SheetOrder) -> None:
        self._blocks = SheetBlocks(sheet)
        super().__init__(INDEFINITE, self._blocks)
        self.kind = IN_BLOCKS
        self.eliminate_in(sheet.vertices)
        self._parameters[20] = 0  # no pivoting
        self._parameters[36] = self._blocks.size

    def call(self, phase: int, matrix: Matrix, b: FloatArray | None = None, x: FloatArray | None = None) -> int:
        """Run a phase with the entries of the pattern; a pivot that is not positive stops a factorisation."""
        if phase == FACTOR:
            self._blocks.fill(matrix.indptr, matrix.indices, matrix.data)
            self._diagonal = matrix.data[matrix.indptr[:-1]]
        spread = None if b is None else self._blocks.spread(b)
        found = None if spread is None else np.empty_like(spread)
        code = self._run(phase, spread, found)
        if phase == FACTOR and code == 0 and (self.negative_pivots or self.perturbed_pivots):
            return PIVOT_NOT_POSITIVE
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
        return _call(self._library, self._memory, self._parameters, self._type, phase, self._blocks, self.order, b, x)


# Parameters in PARDISO's numbering, counted from 0; others are 0.
_PARAMETERS = {
    0: 1,  # these values instead of the defaults
    1: 2,  # nested dissection (METIS)
    4: 2,  # return the order of elimination; 1: use the given one
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
    matrix: Matrix | SheetBlocks,
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
