"""Collective operations of processes that share a model: sums, maxima, errors. A single process is a trivial case.

A rank is one process of a run under MPI. All data that decide the course of a run pass through here, so that all ranks
decide alike; `umform.parallel` implements the ranks of MPI.
"""

from __future__ import annotations

from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_Sum = TypeVar("_Sum", float, Floats)


class Ranks(Protocol):
    """The ranks that share a model; each method returns the same result on all of them, to the last bit."""

    @property
    def rank(self) -> int:
        """Index of this rank, from 0; the first one writes files and prints."""

    @property
    def size(self) -> int:
        """Number of ranks."""

    def sum(self, value: _Sum) -> _Sum:
        """Sum of a number or of an array of one shape."""

    def max(self, value: float) -> float:
        """Largest of the numbers."""

    def any(self, flag: bool) -> bool:
        """Whether the condition holds on any rank."""

    def dot(self, a: Floats, b: Floats) -> float:
        """Scalar product of two vectors of which each rank has its own entries."""

    def join(self, state: bytes) -> bytes:
        """A value that is equal only if the states of all ranks are equal."""

    def rows(self, matrix: Floats) -> Floats:
        """A matrix with the same row space and singular values as the rows of all ranks."""

    def agree(self, error: Exception | None) -> None:
        """Raise the error of the first rank that has one, on all of them."""


class OneRank:
    """One process that has the whole model."""

    rank = 0
    size = 1

    def sum(self, value: _Sum) -> _Sum:
        """The number."""
        return value

    def max(self, value: float) -> float:
        """The number."""
        return value

    def any(self, flag: bool) -> bool:
        """The condition."""
        return bool(flag)

    def dot(self, a: Floats, b: Floats) -> float:
        """Scalar product."""
        return float(a @ b)

    def join(self, state: bytes) -> bytes:
        """The state."""
        return state

    def rows(self, matrix: Floats) -> Floats:
        """The matrix."""
        return matrix

    def agree(self, error: Exception | None) -> None:
        """Raise it."""
        if error is not None:
            raise error


ONE: Ranks = OneRank()
