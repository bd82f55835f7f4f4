"""What processes that share a model must agree on: sums, largest values, errors. In one process each is its own share.

A rank is one process of a run under MPI. Everything that decides how a run goes on passes through here, so that all
ranks decide alike; `umform.parallel` has the ranks of MPI.
"""

from __future__ import annotations

from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_Sum = TypeVar("_Sum", float, Floats)


class Ranks(Protocol):
    """The ranks that share a model; each method gives the same answer on all of them, to the last bit."""

    @property
    def rank(self) -> int:
        """Number of this rank, counted from 0; the first one writes files and talks."""

    @property
    def size(self) -> int:
        """How many there are."""

    def sum(self, value: _Sum) -> _Sum:
        """Sum of a number or of an array of one shape."""

    def max(self, value: float) -> float:
        """Largest of the numbers."""

    def any(self, flag: bool) -> bool:
        """Whether one of them says so."""

    def dot(self, a: Floats, b: Floats) -> float:
        """Scalar product of two vectors of which each rank has its own entries."""

    def join(self, state: bytes) -> bytes:
        """Something that is equal only if the states of all ranks are."""

    def rows(self, matrix: Floats) -> Floats:
        """A matrix with the same row space and singular values as the rows of all ranks."""

    def agree(self, error: Exception | None) -> None:
        """Raise the error of the first rank that has one, on all of them."""


class OneRank:
    """One process that has the whole model."""

    rank = 0
    size = 1

    def sum(self, value: _Sum) -> _Sum:
        """The number itself."""
        return value

    def max(self, value: float) -> float:
        """The number itself."""
        return value

    def any(self, flag: bool) -> bool:
        """The answer itself."""
        return bool(flag)

    def dot(self, a: Floats, b: Floats) -> float:
        """Scalar product."""
        return float(a @ b)

    def join(self, state: bytes) -> bytes:
        """The state itself."""
        return state

    def rows(self, matrix: Floats) -> Floats:
        """The matrix itself."""
        return matrix

    def agree(self, error: Exception | None) -> None:
        """Raise it."""
        if error is not None:
            raise error


ONE: Ranks = OneRank()
