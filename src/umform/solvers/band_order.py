"""Orders of the equations that make the band of a symmetric matrix narrow.

Reverse Cuthill-McKee, that of SciPy, finds the ends of a strip; moving each equation to the middle of its neighbours
then takes an eighth to a quarter off the bandwidth.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from .protocol import IntArray, Pattern

IntIndex = NDArray[np.intp]


def orders(pattern: Pattern) -> Iterator[IntIndex]:
    """Yield ways to number the equations one after the other along the strip: the place of each."""
    from scipy import sparse  # slow to import: a matrix that is no strip does without
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    ones, shape = np.ones(pattern.nnz, dtype=np.int32), (pattern.n, pattern.n)
    upper = sparse.csr_matrix((ones, pattern.indices, pattern.indptr), shape=shape)
    graph = (upper + upper.T).tocsr()
    places = _inverse(reverse_cuthill_mckee(graph, symmetric_mode=True))
    yield places
    for _ in range(2):
        middle = np.add.reduceat(places[graph.indices], graph.indptr[:-1]) / np.diff(graph.indptr)
        places = _inverse(np.argsort(middle, kind="stable"))
        yield places


def bandwidth(places: IntIndex, rows: IntArray, columns: IntArray) -> int:
    """Return how far the entries lie from the diagonal at most."""
    return int(np.abs(places[rows] - places[columns]).max())


def _inverse(order: IntIndex) -> IntIndex:
    """Return the place of each equation in an order."""
    places = np.empty(len(order), dtype=np.intp)
    places[order] = np.arange(len(order))
    return places
