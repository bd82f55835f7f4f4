"""PETSc's assembly from coordinates: positions once per pattern, values once per matrix, including sums over the ranks.

petsc4py has it since release 3.19; before, the same two functions are called in PETSc's library.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.errors import SolveError
from umform.parallel.petsc import petsc

Floats = NDArray[np.float64]


def preallocate(matrix: Any, rows: NDArray[Any], columns: NDArray[Any]) -> None:
    """Set the positions of the values of a matrix; a position may occur several times, and on several ranks.

    Parameters
    ----------
    matrix : Mat of petsc4py
        With its sizes and its type.
    rows, columns : ndarray of int
        Global numbers of row and column of each value; PETSc may overwrite them.
    """
    kind = petsc().IntType
    i, j = np.ascontiguousarray(rows, dtype=kind), np.ascontiguousarray(columns, dtype=kind)
    if hasattr(matrix, "setPreallocationCOO"):
        matrix.setPreallocationCOO(i, j)
        return
    integers = np.ctypeslib.ndpointer(kind, flags="C")
    _call(
        "MatSetPreallocationCOO", (ctypes.c_void_p, ctypes.c_ssize_t, integers, integers), matrix.handle, len(i), i, j
    )


def set_values(matrix: Any, values: Floats) -> None:
    """Set the values of a matrix at the positions of :func:`preallocate`; previous values are discarded."""
    petsc_mode = petsc().InsertMode.INSERT_VALUES
    if hasattr(matrix, "setValuesCOO"):
        matrix.setValuesCOO(values, petsc_mode)
        return
    numbers = np.ctypeslib.ndpointer(np.float64, flags="C")
    _call("MatSetValuesCOO", (ctypes.c_void_p, numbers, ctypes.c_int), matrix.handle, values, int(petsc_mode))
    matrix.stateIncrease()


def _call(name: str, kinds: tuple[Any, ...], *arguments: Any) -> None:
    """Call a function of the PETSc that petsc4py is linked with."""
    function = getattr(ctypes.CDLL(petsc().__file__), name)
    function.argtypes, function.restype = kinds, ctypes.c_int
    error = function(*arguments)
    if error:
        raise SolveError(f"{name} of PETSc has failed", value=f"error {error}", remedy="see what PETSc has printed")
