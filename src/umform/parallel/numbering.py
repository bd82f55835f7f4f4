"""Global numbers of nodes and unknowns, consecutive on each rank; computed on the first rank."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Ids
from umform.model import Model
from umform.solvers import Pattern

Numbers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class SharedPattern(Pattern):
    """Pattern of the part of the tangent on a rank.

    Parameters
    ----------
    n : int
        Number of equations of all ranks.
    indptr, indices, symmetric
        As in :class:`umform.solvers.Pattern`, over the unknowns that are known here, in their numbers here.
    numbers : ndarray of int
        Global number of each of these unknowns.
    own : int
        How many unknowns this rank owns.
    modes : callable
        Returns the rigid-body modes at the unknowns that this rank owns, shape (6, own): the near-null space.
    ranks : MpiRanks
        Those that share the tangent.
    """

    numbers: Numbers
    own: int
    modes: Any
    ranks: Any

    def __post_init__(self) -> None:
        """Release the pattern after the analysis."""

    @property
    def rows(self) -> Ids:
        """Row of each entry, in the numbers of this rank."""
        return np.repeat(np.arange(len(self.indptr) - 1, dtype=np.int32), np.diff(self.indptr))


@dataclass(frozen=True)
class Owners:
    """Owners of the nodes and unknowns of a whole model.

    Attributes
    ----------
    node : ndarray of int32, shape (nodes,)
        Rank that owns a node: the first of those that have it.
    equation : ndarray of int, shape (3 * nodes,)
        Global number of the unknown of a free degree of freedom, -1 elsewhere.
    tie : ndarray of int, shape (tied pairs,)
        Global number of the unknown of a pair.
    own : ndarray of int, shape (ranks,)
        Number of unknowns that each rank owns.
    """

    node: Ids
    equation: Numbers
    tie: Numbers
    own: Numbers

    @classmethod
    def of(cls, model: Model, cells: Sequence[Numbers]) -> Owners:
        """Number the unknowns of a model whose cells are assigned to ranks.

        Parameters
        ----------
        model : Model
            The whole model.
        cells : sequence of ndarray of int
            Cells of each rank.
        """
        node = np.zeros(len(model.mesh.points), dtype=np.int32)
        for rank in reversed(range(len(cells))):
            node[model.mesh.connectivity[cells[rank]]] = rank
        pairs = tied_pairs(model)
        constrained = model.supports.constrained()
        constrained[pairs] = True
        free = np.flatnonzero(~constrained)
        owner = np.concatenate([node[free // 3], node[pairs[:, 0] // 3]])
        number = np.empty(len(owner), dtype=np.int64)
        number[np.argsort(owner, kind="stable")] = np.arange(len(owner))
        equation = np.full(constrained.size, -1, dtype=np.int64)
        equation[free] = number[: len(free)]
        return cls(node, equation, number[len(free) :], np.bincount(owner, minlength=len(cells)))

    def consecutive_nodes(self) -> Numbers:
        """Global number of each node, so that those of one rank are consecutive."""
        number = np.empty(len(self.node), dtype=np.int64)
        number[np.argsort(self.node, kind="stable")] = np.arange(len(self.node))
        return number


def tied_pairs(model: Model) -> Ids:
    """Pairs (lower, upper) of tied degrees of freedom of all ties, shape (k, 2)."""
    return np.concatenate([np.empty((0, 2), dtype=np.int32), *[tie.dofs for tie in model.supports.ties]])
