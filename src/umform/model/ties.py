"""Ties of a lower and an upper node: the mean of their displacements is held, their difference is free.

A sheet of solid-shells has no node on its mid-surface. A hinge there holds the mean of the two nodes of a fibre, which
may rotate about it. docs/theory, 5.10
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.mesh import Ids, Mesh, Selector
from umform.model.control import OnDofs
from umform.solvers import Pattern

Floats = NDArray[np.float64]


@dataclass(eq=False, repr=False)
class MidLine(OnDofs):
    """Displacement of the mid-line of an edge in one direction; its force is the sum of the reactions on the sheet."""


@dataclass(frozen=True)
class Tie:
    """Pairs of degrees of freedom (lower, upper), shape (k, 2), whose mean is held or the value of a control."""

    dofs: Ids
    control: MidLine | None


def node_pairs(mesh: Mesh, nodes: Selector) -> Ids:
    """Outermost lower and upper nodes of the fibres through the sheet in a set.

    Parameters
    ----------
    mesh : Mesh
        Points and cells; lower node a of a cell of n nodes and its node a + n/2 belong to one fibre.
    nodes : str, callable or array_like
        Name of a set, predicate of x, y, z, node ids or a mask, see :meth:`umform.Mesh.nodes`.

    Returns
    -------
    ndarray of int32, shape (k, 2)

    Raises
    ------
    InvalidValue
        If the set does not hold both outermost nodes of a fibre that it holds a node of.
    """
    half = mesh.connectivity.shape[1] // 2
    links = np.unique(
        np.stack([mesh.connectivity[:, :half].ravel(), mesh.connectivity[:, half:].ravel()], axis=1), axis=0
    )
    if any(len(np.unique(side)) < len(links) for side in links.T):
        raise InvalidValue(
            "lower and upper nodes do not pair up",
            where="mesh",
            cause="neighbouring cells do not agree on the direction through the thickness",
            remedy="order the nodes of all cells from the same face of the sheet",
        )
    above = np.arange(len(mesh.points))
    above[links[:, 0]] = links[:, 1]
    bottoms = np.setdiff1d(links[:, 0], links[:, 1])
    tops = above[bottoms]
    fibre = np.full(len(mesh.points), -1)  # number of the fibre of each node
    fibre[bottoms] = fibre[tops] = np.arange(len(bottoms))
    while not np.array_equal(above[tops], tops):  # one layer of the stack at a time
        tops = above[tops]
        fibre[tops] = np.arange(len(bottoms))
    ids = mesh.nodes(nodes)
    touched = np.unique(fibre[ids])
    alone = touched[(touched < 0) | ~(np.isin(bottoms[touched], ids) & np.isin(tops[touched], ids))]
    if len(alone):
        raise InvalidValue(
            "a node has no partner on the other face of the sheet",
            where=f"node {ids[fibre[ids] == alone[0]][0]}",
            value=nodes if isinstance(nodes, str) else "predicate or list",
            cause="the set holds the nodes of one face only",
            remedy="take the set of the whole edge, x0 instead of x0_lower",
        )
    return np.stack([bottoms[touched], tops[touched]], axis=1).astype(np.int32)


@dataclass(frozen=True)
class Reduction:
    """The entries of T^T K T as sums of entries of K. eq. (5.19)

    Attributes
    ----------
    target : ndarray of int
        Entry of T^T K T that each entry of K goes to; each of them occurs.
    factor : ndarray
        What the entry of K is multiplied by.
    """

    target: NDArray[np.intp]
    factor: Floats

    def __call__(self, values: Floats) -> Floats:
        """Values of T^T K T from those of K."""
        return np.asarray(np.bincount(self.target, weights=self.factor * values), dtype=np.float64)


class Unknowns:
    """What the solver solves for: free degrees of freedom and half the differences of tied ones, u = T q + c.

    The columns of T are orthonormal: one entry 1, or the entries -1/sqrt(2) and 1/sqrt(2) of a tie. eq. (5.17)

    Parameters
    ----------
    free : ndarray of int
        Degrees of freedom that are neither held nor prescribed nor tied.
    pairs : ndarray of int, shape (k, 2)
        Tied ones.
    size : int
        All of them.
    """

    def __init__(self, free: NDArray[np.int64], pairs: Ids, size: int) -> None:
        self.free, self.pairs, self.size = free, pairs, size

    def restrict(self, r: Floats) -> Floats:
        """T^T r. eq. (5.18)"""
        if len(self.pairs) == 0:
            return r[self.free]
        lower, upper = self.pairs.T
        return np.concatenate([r[self.free], (r[upper] - r[lower]) * np.sqrt(0.5)])

    def extend(self, x: Floats) -> Floats:
        """T x. eq. (5.17)"""
        u = np.zeros(self.size)
        u[self.free] = x[: len(self.free)]
        if len(self.pairs):
            half = x[len(self.free) :] * np.sqrt(0.5)
            u[self.pairs[:, 0]], u[self.pairs[:, 1]] = -half, half
        return u

    def reduction(self, rows: Ids, columns: Ids, symmetric: bool) -> tuple[Pattern, Reduction]:
        """Pattern of T^T K T, and the map from the entries of K to its entries. eq. (5.19)

        Parameters
        ----------
        rows, columns : ndarray of int
            Place of each entry of K, which has an equation for each free degree of freedom, in their order, then one
            for each lower and then one for each upper tied one.
        symmetric : bool
            Whether only upper triangles are stored.
        """
        free, ties = len(self.free), len(self.pairs)
        unknown = np.concatenate([np.arange(free + ties), np.arange(free, free + ties)])
        weight = np.concatenate([np.ones(free), np.full(ties, -np.sqrt(0.5)), np.full(ties, np.sqrt(0.5))])
        i, j = unknown[rows], unknown[columns]
        factor = weight[rows] * weight[columns]
        if symmetric:
            factor = np.where((i == j) & (rows != columns), 2.0 * factor, factor)  # stands for two entries of K
            i, j = np.minimum(i, j), np.maximum(i, j)
        n = free + ties
        places, target = np.unique(i.astype(np.int64) * n + j, return_inverse=True)
        indptr = np.searchsorted(places, np.arange(n + 1, dtype=np.int64) * n).astype(np.int32)
        pattern = Pattern(n, indptr, (places % n).astype(np.int32), symmetric)
        return pattern, Reduction(target, factor)
