"""Unknowns of the solver: T in u = T q + c, forces and the tangent over the unknowns. docs/theory, 5.10"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Ids
from umform.model.supports.constraints import Groups
from umform.solvers import Pattern

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]


@dataclass(frozen=True)
class Reduction:
    """The entries of T^T K T as sums of entries of K. eq. (5.19)

    Attributes
    ----------
    target : ndarray of int
        Entry of T^T K T to which each contribution is added; each entry occurs.
    factor : ndarray
        Factor of the entry of K.
    source : ndarray of int, optional
        Entry of K of each contribution; without it there is one contribution of each entry, in their order.
    """

    target: NDArray[np.intp]
    factor: Floats
    source: NDArray[np.intp] | None = None

    def __call__(self, values: Floats) -> Floats:
        """Values of T^T K T from those of K."""
        taken = values if self.source is None else values[self.source]
        return np.asarray(np.bincount(self.target, weights=self.factor * taken), dtype=np.float64)


class Unknowns:
    """Free degrees of freedom, half the differences of tied ones, and the null space of constraints: u = T q + c.

    The columns of T are orthonormal: one entry 1, the entries -1/sqrt(2) and 1/sqrt(2) of a tie, or a vector of the
    null space of a group of constraints. eqs. (5.17), (5.42)

    Parameters
    ----------
    free : ndarray of int
        Degrees of freedom that are neither held nor prescribed nor tied nor in a group.
    pairs : ndarray of int, shape (k, 2)
        Tied ones.
    groups : Groups
        Constraints in local axes.
    size : int
        All degrees of freedom.
    """

    def __init__(self, free: NDArray[np.int64], pairs: Ids, groups: Groups, size: int) -> None:
        self.free, self.pairs, self.groups, self.size = free, pairs, groups, size

    @property
    def equations(self) -> Numbers:
        """Degrees of freedom that have an equation in K: free ones, lower and upper tied ones, those of groups."""
        return np.concatenate([self.free, *self.pairs.T, self.groups.dofs]).astype(np.int64)

    @property
    def reduced(self) -> bool:
        """Whether K is more than the tangent over the unknowns."""
        return len(self.pairs) + len(self.groups.dofs) > 0

    def restrict(self, r: Floats) -> Floats:
        """T^T r. eq. (5.18)"""
        parts = [r[self.free]]
        if len(self.pairs):
            lower, upper = self.pairs.T
            parts.append((r[upper] - r[lower]) * np.sqrt(0.5))
        if self.groups.count:
            parts.append(self.groups.restrict(r))
        return parts[0] if len(parts) == 1 else np.concatenate(parts)

    def extend(self, x: Floats) -> Floats:
        """T x. eq. (5.17)"""
        u = np.zeros(self.size)
        free, ties = len(self.free), len(self.pairs)
        u[self.free] = x[:free]
        if ties:
            half = x[free : free + ties] * np.sqrt(0.5)
            u[self.pairs[:, 0]], u[self.pairs[:, 1]] = -half, half
        if self.groups.count:
            self.groups.extend(x[free + ties :], u)
        return u

    def reduction(self, rows: Ids, columns: Ids, symmetric: bool) -> tuple[Pattern, Reduction]:
        """Pattern of T^T K T, and the map from the entries of K to its entries. eq. (5.19)

        Parameters
        ----------
        rows, columns : ndarray of int
            Place of each entry of K, which has the equations :attr:`equations`.
        symmetric : bool
            Whether only upper triangles are stored.
        """
        first, unknown, weight = self._columns()
        shares = np.diff(first)
        source = None
        if np.all(shares == 1):
            one, other = first[rows], first[columns]
        else:  # an entry of K contributes to all pairs of the unknowns of its row and of its column
            source = np.repeat(np.arange(len(rows)), shares[rows] * shares[columns])
            at = np.arange(len(source)) - np.repeat(*_starts(shares[rows] * shares[columns]))
            rows, columns = rows[source], columns[source]
            one, other = first[rows] + at // shares[columns], first[columns] + at % shares[columns]
        i, j, factor = unknown[one], unknown[other], weight[one] * weight[other]
        if symmetric:
            factor = np.where((i == j) & (rows != columns), 2.0 * factor, factor)  # represents two entries of K
            if source is not None:
                keep = (rows != columns) | (i <= j)  # a diagonal entry represents itself only
                source, i, j, factor = source[keep], i[keep], j[keep], factor[keep]
            i, j = np.minimum(i, j), np.maximum(i, j)
        n = len(self.free) + len(self.pairs) + self.groups.count
        places, target = np.unique(i.astype(np.int64) * n + j, return_inverse=True)
        indptr = np.searchsorted(places, np.arange(n + 1, dtype=np.int64) * n).astype(np.int32)
        pattern = Pattern(n, indptr, (places % n).astype(np.int32), symmetric)
        return pattern, Reduction(target, factor, source)

    def _columns(self) -> tuple[Numbers, Numbers, Floats]:
        """Rows of T over the equations of K: where each begins, its unknowns and weights."""
        free, ties, groups = len(self.free), len(self.pairs), self.groups
        single = np.concatenate([np.arange(free + ties), np.arange(free, free + ties)])
        weight = np.concatenate([np.ones(free), np.full(ties, -np.sqrt(0.5)), np.full(ties, np.sqrt(0.5))])
        order = np.argsort(groups.place, kind="stable")
        many = np.bincount(groups.place, minlength=len(groups.dofs))
        first = np.concatenate(
            [np.arange(len(single)), len(single) + np.cumsum(many) - many, [len(single) + many.sum()]]
        )
        unknown = np.concatenate([single, free + ties + groups.unknown[order]])
        return first.astype(np.int64), unknown.astype(np.int64), np.concatenate([weight, groups.weight[order]])


def _starts(counts: Numbers) -> tuple[Numbers, Numbers]:
    """Where each run of so many begins, and the counts: arguments of np.repeat."""
    return np.cumsum(counts) - counts, counts
