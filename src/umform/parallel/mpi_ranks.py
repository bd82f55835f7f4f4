"""The ranks of MPI: sums and maxima that are equal on all of them, to the last bit."""

from __future__ import annotations

import hashlib
import time as clock
from collections.abc import Callable
from functools import cache
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from umform.parallel.petsc import petsc

Floats = NDArray[np.float64]
_Sum = TypeVar("_Sum", float, Floats)
_Answer = TypeVar("_Answer")


class MpiRanks:
    """All processes started by mpiexec, see :class:`umform.ranks.Ranks`.

    Attributes
    ----------
    petsc_comm : communicator of petsc4py
        For vectors and matrices.
    comm : communicator of mpi4py
        A copy for sums, parcels and files, so that messages are not mixed up; objects may be of any size.
    """

    def __init__(self) -> None:
        self.petsc_comm: Any = petsc().COMM_WORLD
        from mpi4py.util.pkl5 import Intracomm

        whole = self.petsc_comm.tompi4py()
        self.comm: Any = Intracomm(whole.Dup())
        self._trouble = whole.Dup()
        self.rank: int = self.comm.rank
        self.size: int = self.comm.size

    def sum(self, value: _Sum) -> _Sum:
        """Sum in the order of the ranks: MPI does not guarantee that all ranks get the same bits from a reduction."""
        mine: Floats = np.array(value, dtype=float)
        parts = np.empty((self.size, *mine.shape))
        self.comm.Allgather(mine, parts)
        total: Floats = parts.sum(axis=0)
        return total if isinstance(value, np.ndarray) else float(total)

    def max(self, value: float) -> float:
        """Largest of the numbers; NaN if one is NaN."""
        parts = np.empty(self.size)
        self.comm.Allgather(np.array([value], dtype=float), parts)
        return float(parts.max())

    def any(self, flag: bool) -> bool:
        """Whether the condition holds on any rank."""
        return self.max(float(flag)) > 0.0

    def dot(self, a: Floats, b: Floats) -> float:
        """Scalar product of two vectors of which each rank has its own entries."""
        return self.sum(float(a @ b))

    def join(self, state: bytes) -> bytes:
        """Digests of the states of all ranks."""
        return b"".join(self.comm.allgather(hashlib.blake2b(state, digest_size=16).digest()))

    def text(self, mine: str) -> str:
        """The text of the first rank that has one."""
        return next((one for one in self.comm.allgather(mine) if one), "")

    def rows(self, matrix: Floats) -> Floats:
        """Triangular factors of the rows of all ranks, below each other."""
        few = np.linalg.qr(matrix, mode="r") if len(matrix) > matrix.shape[1] else matrix
        return np.concatenate(self.comm.allgather(few))

    def agree(self, error: Exception | None) -> None:
        """Raise the error of the first rank that has one, on all of them."""
        if self.any(error is not None):
            raise next(one for one in self.comm.allgather(error) if one is not None)

    def on_first(self, work: Callable[[], _Answer]) -> _Answer | None:
        """Call a function on the first rank only; None on the others. Its error is raised on all of them."""
        answer, problem = None, None
        if self.rank == 0:
            try:
                answer = work()
            except Exception as error:
                problem = error
        self.agree(problem)
        return answer

    def arrive(self, seconds: float) -> bool:
        """Whether all ranks arrive here within a time; they do not if one has failed alone."""
        request, start = self._trouble.Ibarrier(), clock.perf_counter()
        while not request.Test():
            if clock.perf_counter() - start > seconds:
                return False
            clock.sleep(0.01)
        return True

    def abort(self) -> None:
        """End all processes at once."""
        self.comm.Abort(1)


@cache
def world() -> MpiRanks:
    """All processes started by mpiexec."""
    return MpiRanks()
