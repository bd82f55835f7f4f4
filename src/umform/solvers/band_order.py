"""Orders of the equations that make the band of a symmetric matrix narrow.

Reverse Cuthill-McKee finds the ends of a strip; moving each equation to the middle of its neighbours then takes an
eighth to a quarter off the bandwidth.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from .protocol import IntArray, Pattern

IntIndex = NDArray[np.intp]

#: So many steps tell a sheet from a strip.
_FAR = 200


def orders(pattern: Pattern) -> Iterator[IntIndex]:
    """Yield ways to number the equations one after the other along the strip: the place of each."""
    indptr, indices = _both_triangles(pattern)
    places = _inverse(cuthill_mckee(indptr, indices)[::-1])
    yield places
    for _ in range(2):
        middle = np.add.reduceat(places[indices], indptr[:-1]) / np.diff(indptr)
        places = _inverse(np.argsort(middle, kind="stable"))
        yield places


def bandwidth(places: IntIndex, rows: IntArray, columns: IntArray) -> int:
    """Return how far the entries lie from the diagonal at most."""
    return int(np.abs(places[rows] - places[columns]).max())


def cuthill_mckee(indptr: IntArray, indices: IntArray) -> IntIndex:
    """Walk over a graph from its equation of the fewest neighbours, all that are equally far from there at a time.

    In each front the neighbours of the first come first, and among these the one with fewer neighbours of its own
    (E. Cuthill, J. McKee, Reducing the bandwidth of sparse symmetric matrices, Proc. 24th Nat. Conf. ACM, 1969). A part
    of the graph that nothing connects with the others is walked over after them in the same way.

    Parameters
    ----------
    indptr, indices : array of int
        Compressed rows of both triangles, none empty.

    Returns
    -------
    array of int, shape (n,)
        The equations in their order.
    """
    degree = np.diff(indptr)
    by_degree = np.argsort(degree, kind="stable")
    seen = np.zeros(len(degree), dtype=bool)
    fronts: list[IntIndex] = []
    count = 0
    front = by_degree[:0]
    while count < len(degree):
        if not len(front):
            front = by_degree[np.argmin(seen[by_degree])][None]
        seen[front] = True
        fronts.append(front)
        count += len(front)
        neighbours, of = _step(indptr, indices, front)
        new = np.flatnonzero(~seen[neighbours])
        found, first = np.unique(neighbours[new], return_index=True)
        front = found[np.lexsort((degree[found], of[new[first]]))]
    return np.concatenate(fronts)


def wider_than(bandwidth: int, pattern: Pattern) -> bool:
    """Whether a short walk over the graph shows that the band of no order is so narrow.

    In a band of half width b the equations that k steps lead to from one equation are at most 2 k b. Here the steps go
    up in the rows that are stored; in a sheet they find a number that grows with k^2.
    """
    seen = np.zeros(pattern.n, dtype=bool)
    seen[0] = True
    front, count, steps = np.zeros(1, dtype=np.int64), 0, 0
    while len(front) and count <= 2 * steps * bandwidth and steps < _FAR:
        front = np.unique(_step(pattern.indptr, pattern.indices, front)[0])
        front = front[~seen[front]]
        seen[front] = True
        count, steps = count + len(front), steps + 1
    return count > 2 * steps * bandwidth


def _step(indptr: IntArray, indices: IntArray, front: IntIndex) -> tuple[IntIndex, IntIndex]:
    """Columns of the rows of a front, one row after the other, and the place in the front of the row of each."""
    lengths = indptr[front + 1] - indptr[front]
    ends = np.cumsum(lengths)
    entries = np.arange(ends[-1]) + np.repeat(indptr[front] - (ends - lengths), lengths)
    return indices[entries], np.repeat(np.arange(len(front)), lengths)


def _both_triangles(pattern: Pattern) -> tuple[IntArray, IntArray]:
    """Compressed rows of the matrix of which the pattern stores the upper triangle."""
    above = pattern.indices > pattern.rows
    rows = np.concatenate([pattern.indices[above], pattern.rows])
    columns = np.concatenate([pattern.rows[above], pattern.indices])
    indptr = np.concatenate([[0], np.cumsum(np.bincount(rows))])
    return indptr, columns[np.argsort(rows, kind="stable")]


def _inverse(order: IntIndex) -> IntIndex:
    """Return the place of each equation in an order."""
    places = np.empty(len(order), dtype=np.intp)
    places[order] = np.arange(len(order))
    return places
