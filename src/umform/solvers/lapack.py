"""Cholesky factors of a symmetric band by LAPACK: by that of MKL where MKL is installed, else by SciPy's.

Both are tuned libraries with about the same speed in narrow bands. MKL comes first since it is loaded in a twentieth of
the time that the import of `scipy.linalg` takes, which is as long as a small model takes to be solved.

A band has shape (n, bandwidth + 1): row j holds the column j of the lower triangle from its diagonal downwards.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache

import numpy as np

from . import mkl
from .protocol import FloatArray

_COLUMN_MAJOR, _LOWER = 102, b"L"


def factorise(band: FloatArray) -> tuple[FloatArray, int]:
    """Factorise a band in its place.

    Returns
    -------
    factors : ndarray, shape (n, bandwidth + 1)
        The Cholesky factor in the place of the lower triangle.
    first_bad : int
        Number, from 1, of the first pivot that is not positive; 0 if all are.
    """
    if mkl.find() is None:
        from scipy.linalg import lapack  # slow to import

        factors, first_bad = lapack.dpbtrf(band.T, lower=1, overwrite_ab=1)
        return factors.T, first_bad
    n, rows = band.shape
    return band, _mkl_functions()[0](_COLUMN_MAJOR, _LOWER, n, rows - 1, band.ctypes.data, rows)


def solve(factors: FloatArray, rhs: FloatArray) -> FloatArray:
    """Solve with the factors of a band, in the place of right-hand sides (n,) or, in Fortran's order, (n, k)."""
    if mkl.find() is None:
        from scipy.linalg import lapack  # slow to import

        return np.asarray(lapack.dpbtrs(factors.T, rhs, lower=1, overwrite_b=1)[0])
    n, rows = factors.shape
    count = 1 if rhs.ndim == 1 else rhs.shape[1]
    _mkl_functions()[1](_COLUMN_MAJOR, _LOWER, n, rows - 1, count, factors.ctypes.data, rows, rhs.ctypes.data, n)
    return rhs


@cache
def _mkl_functions() -> tuple[Callable[..., int], Callable[..., int]]:
    """MKL's dpbtrf and dpbtrs in the C interface of LAPACK."""
    library, integer, char, address = mkl.library(), ctypes.c_int, ctypes.c_char, ctypes.c_void_p
    factorise, solve = library.LAPACKE_dpbtrf_work, library.LAPACKE_dpbtrs_work
    factorise.argtypes = [integer, char, integer, integer, address, integer]
    solve.argtypes = [integer, char, integer, integer, integer, address, integer, address, integer]
    return factorise, solve
