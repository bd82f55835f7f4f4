"""Division of a model into parcels, one for each rank: all data that grow with the mesh, in local numbering."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Ids
from umform.model import Model
from umform.model.terms.cut import Cut
from umform.parallel.numbering import Owners, tied_pairs

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Parcel:
    """The part of a rank of a model; local numbering of nodes and cells, unless stated otherwise.

    Attributes
    ----------
    cells, nodes : ndarray of int
        Numbers in the whole mesh of the cells and nodes that are here.
    cell : str
        Kind of the cells.
    points, connectivity : ndarray
        The mesh of this rank.
    owned : ndarray of int
        Nodes that this rank owns.
    fixed : ndarray of bool, shape (3 * nodes,)
        Degrees of freedom that are held.
    pieces : list
        Data of each body, control, tool, contact, other term and support, in this order.
    ties : list of ndarray, shape (k, 2)
        Pairs of each tie.
    numbers, node_numbers : ndarray of int
        Global numbers of the unknowns and of the nodes, those of a rank consecutive.
    own, before, count : int
        Unknowns that this rank, all ranks before it and all ranks own.
    u : ndarray, shape (3 * nodes,)
        Displacement.
    """

    cells: Numbers
    nodes: Numbers
    cell: str
    points: Floats
    connectivity: Ids
    owned: Numbers
    fixed: NDArray[np.bool_]
    pieces: list[Any]
    ties: list[Ids]
    numbers: Numbers
    node_numbers: Numbers
    own: int
    before: int
    count: int
    u: Floats


class Cutting:
    """A whole model whose cells are assigned to ranks.

    Parameters
    ----------
    whole : Model
        The model.
    part : ndarray of int32, shape (cells,)
        Rank of each cell.
    size : int
        Number of ranks.
    """

    def __init__(self, whole: Model, part: Ids, size: int) -> None:
        self._whole = whole
        self._cells = by_rank(part, size)
        self._owners, self._pairs = Owners.of(whole, self._cells), tied_pairs(whole)
        # Local numbers on the rank whose parcel is made, -1 elsewhere.
        self._node = np.full(len(whole.mesh.points), -1, dtype=np.int32)
        self._cell = np.full(len(part), -1, dtype=np.int32)

    def parcel(self, rank: int) -> Parcel:
        """Parcel of a rank; the work grows with its part, and with the sets of the whole model."""
        cells, tied, nodes = self._cells[rank], *self._known(rank)
        self._node[nodes], self._cell[cells] = np.arange(len(nodes)), np.arange(len(cells))
        whole, owners = self._whole, self._owners
        owned = np.flatnonzero(owners.node[nodes] == rank)
        cut = Cut(nodes, owned, self._node, self._cell)
        things: list[Any] = [*whole.bodies, *whole.controls, *whole.tools, *whole.contacts, *whole.system.others]
        things += whole.supports.holders
        number = owners.equation.reshape(-1, 3)[nodes].ravel()
        parcel = Parcel(
            cells=cells,
            nodes=nodes,
            cell=whole.mesh.cell,
            points=whole.mesh.points[nodes],
            connectivity=self._node[whole.mesh.connectivity[cells]],
            owned=owned,
            fixed=whole.supports.fixed.reshape(-1, 3)[nodes].ravel(),
            pieces=[thing.piece(cut) for thing in things],
            ties=[cut.dofs(tie.dofs)[(self._node[tie.dofs // 3] >= 0).all(axis=1)] for tie in whole.supports.ties],
            numbers=np.concatenate([number[number >= 0], owners.tie[tied]]),
            node_numbers=self._consecutive[nodes],
            own=int(owners.own[rank]),
            before=int(owners.own[:rank].sum()),
            count=int(owners.own.sum()),
            u=whole.u.reshape(-1, 3)[nodes].ravel(),
        )
        self._node[nodes], self._cell[cells] = -1, -1
        return parcel

    def _known(self, rank: int) -> tuple[NDArray[np.bool_], Numbers]:
        """Tied pairs of a rank, and its nodes: those of its cells, and partners of tied ones, even without a cell."""
        nodes = np.unique(self._whole.mesh.connectivity[self._cells[rank]])
        self._node[nodes] = 0
        known = self._node[self._pairs // 3] >= 0
        tied: NDArray[np.bool_] = np.logical_or(known[:, 0], known[:, 1])
        self._node[nodes] = -1
        later = [tie.dofs // 3 for holder in self._whole.supports.holders for tie in holder.ties]  # if others are freed
        partners = np.concatenate([self._pairs[tied] // 3, *(pair[np.isin(pair, nodes).any(axis=1)] for pair in later)])
        return tied, np.union1d(nodes, partners).astype(np.int64)

    @cached_property
    def _consecutive(self) -> Numbers:
        return self._owners.consecutive_nodes()


def by_rank(rank: Ids, size: int) -> list[Numbers]:
    """Indices of the items of each rank, in order, from the rank of each item."""
    ends = np.cumsum(np.bincount(rank, minlength=size))
    return np.split(np.argsort(rank, kind="stable"), ends[:-1])
