"""Sums of partial values and distribution of results: each rank owns some numbers and uses more of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.parallel.mpi_ranks import MpiRanks
from umform.parallel.petsc import petsc

Floats = NDArray[np.float64]


class Exchange:
    """Numbered items on a rank; each item has one owner.

    Parameters
    ----------
    numbers : ndarray of int
        Global numbers of the local items; those that a rank owns are consecutive.
    own : int
        Number of items that this rank owns.
    ranks : MpiRanks
        Those that share them.
    """

    def __init__(self, numbers: NDArray[np.int64], own: int, ranks: MpiRanks) -> None:
        PETSc = petsc()
        self._own = PETSc.Vec().createMPI((own, None), comm=ranks.petsc_comm)
        self._known = PETSc.Vec().createSeq(len(numbers), comm=PETSc.COMM_SELF)
        places = PETSc.IS().createGeneral(numbers.astype(PETSc.IntType), comm=PETSc.COMM_SELF)
        self._scatter = PETSc.Scatter().create(self._own, places, self._known, None)
        self._add = PETSc.InsertMode.ADD_VALUES
        self._back = PETSc.ScatterMode.REVERSE

    def sum(self, shares: Floats) -> Floats:
        """Sums over the ranks of partial values (local items,), for the owned items."""
        self._known.array[:] = shares
        self._own.set(0.0)
        self._scatter.scatter(self._known, self._own, addv=self._add, mode=self._back)
        return np.array(self._own.array)

    def spread(self, own: Floats) -> Floats:
        """Values of the local items from their owners."""
        self._own.array[:] = own
        self._scatter.scatter(self._own, self._known)
        return np.array(self._known.array)
