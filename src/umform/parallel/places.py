"""Arrays over all nodes, cells or facets of a model on the first rank, and their rows on each rank."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.parallel.mpi_ranks import MpiRanks

Floats = NDArray[np.float64]


class Places:
    """Local rows of an array over a whole model.

    Parameters
    ----------
    rows : ndarray of int
        Indices of the local rows.
    ranks : MpiRanks
        Those that share the model; the first rank stores the rows of all.

    Attributes
    ----------
    count : int
        Rows of the whole array, on the first rank.
    """

    def __init__(self, rows: NDArray[np.int64], ranks: MpiRanks) -> None:
        self.ranks, self._here = ranks, len(rows)
        self._rows = ranks.comm.gather(rows)
        self.count = 1 + max(int(part.max(initial=-1)) for part in self._rows or [rows])

    def collect(self, values: Floats) -> Floats | None:
        """The whole array on the first rank, from the rows (rows here, ...) of each; None on the others."""
        values = np.ascontiguousarray(values, dtype=float)
        if self._rows is None:
            self.ranks.comm.Send(values, dest=0)
            return None
        whole = np.full((self.count, *values.shape[1:]), np.nan)
        for rank, rows in enumerate(self._rows):
            part = values if rank == 0 else np.empty((len(rows), *values.shape[1:]))
            if rank > 0:
                self.ranks.comm.Recv(part, source=rank)
            whole[rows] = part
        return whole

    def hand_out(self, whole: Floats | None) -> Floats:
        """The local rows of a whole array, which the first rank has."""
        comm = self.ranks.comm
        if self._rows is None or whole is None:
            part = np.empty((self._here, *comm.bcast(None)))
            comm.Recv(part, source=0)
            return part
        comm.bcast(whole.shape[1:])
        for rank, rows in enumerate(self._rows[1:], start=1):
            comm.Send(np.ascontiguousarray(whole[rows], dtype=float), dest=rank)
        return np.ascontiguousarray(whole[self._rows[0]], dtype=float)
