"""Shares to sums and back: each rank owns some numbers and knows more of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.parallel.mpi_ranks import MpiRanks
from umform.parallel.petsc import petsc

Floats = NDArray[np.float64]


class Exchange:
    """What a rank knows of numbered items, each of which one rank owns.

    Parameters
    ----------
    numbers : ndarray of int
        Global numbers of the items that are known here; those that a rank owns are consecutive.
    own : int
        How many items this rank owns.
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
        """Sums over the ranks of their shares (known items,), for the items that are owned here."""
        self._known.array[:] = shares
        self._own.set(0.0)
        self._scatter.scatter(self._known, self._own, addv=self._add, mode=self._back)
        return np.array(self._own.array)

    def spread(self, own: Floats) -> Floats:
        """Values of the known items from those that each rank owns."""
        self._own.array[:] = own
        self._scatter.scatter(self._own, self._known)
        return np.array(self._known.array)
