"""Sheets: order of elimination of their equations, and their matrix in square blocks for PARDISO."""

from __future__ import annotations

import numpy as np

from .. import _core
from .protocol import FloatArray, IntArray, Pattern

# Largest relative number of additional equations from padding; those of supported nodes are few.
_FILLING = 1.1


class SheetBlocks:
    """Upper triangle of the blocks by rows, padded with equations x = 0 to one size.

    Parameters
    ----------
    sheet : SheetOrder
        Groups of equations and their order of elimination.

    Attributes
    ----------
    data, indices, indptr : arrays
        Entries of the blocks, one block after the other; column of each block; start of each row of blocks.
    shape : tuple of int
        Rows and columns of blocks.
    size : int
        Rows of a block.
    """

    def __init__(self, sheet: _core.SheetOrder) -> None:
        self._pattern = sheet.blocks()
        self._place = self._pattern.place
        self.size = self._pattern.size
        self.indices, self.indptr = self._pattern.indices, self._pattern.indptr
        self.shape = (len(self.indptr) - 1, len(self.indptr) - 1)
        self.data = np.empty(len(self.indices) * self.size**2)

    def fill(self, indptr: IntArray, indices: IntArray, values: FloatArray) -> None:
        """Copy the entries of the pattern of the sheet."""
        self._pattern.fill(indptr, indices, values, self.data)

    def spread(self, b: FloatArray) -> FloatArray:
        """Right-hand sides, shape (n,) or (n, k), in the rows of the blocks; columns contiguous."""
        spread = np.zeros((self.shape[0] * self.size, *b.shape[1:]), order="F")
        spread[self._place] = b
        return spread

    def gather(self, x: FloatArray) -> FloatArray:
        """Extract the rows of the equations."""
        return np.asarray(x[self._place], order="F")


def sheet_of(pattern: Pattern) -> _core.SheetOrder | None:
    """The order of elimination of a sheet; None if the matrix is of another kind."""
    upper = pattern.upper()
    if upper is None:
        return None
    sheet = _core.SheetOrder(*upper)
    return sheet if len(sheet.vertices) else None


def worth_blocks(sheet: _core.SheetOrder, n: int) -> bool:
    """Whether nearly all groups of n equations have one size."""
    return len(sheet.vertices) * sheet.largest <= _FILLING * n
