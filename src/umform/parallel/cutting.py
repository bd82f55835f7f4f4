"""The first rank cuts its model into parcels, one for each rank: all that grows with the mesh, in own numbers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Ids
from umform.model import Model
from umform.model.boundary import Control, Load, Prescribed, Pressure
from umform.model.ties import MidLine
from umform.parallel.numbering import Owners, tied_pairs

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Parcel:
    """What a rank gets of a model; its own numbers of nodes and cells, unless something else is said.

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
    controls : list of ndarray
        Of each control its degrees of freedom, its forces at owned nodes, or its faces.
    faces, facets : list of ndarray
        Of each contact its faces (cell, face), and their numbers among those of the whole contact.
    ties : list of ndarray, shape (k, 2)
        Pairs of each tie.
    numbers, node_numbers : ndarray of int
        Global numbers of the unknowns and of the nodes, those of a rank consecutive.
    own, before, count : int
        Unknowns that this rank, all ranks before it and all ranks own.
    u : ndarray, shape (3 * nodes,)
        Displacement.
    history : tuple of ndarray, optional
        State and enhanced parameters of the cells, if they have any yet.
    multipliers : list of ndarray or None
        Of each contact, if it has any yet.
    """

    cells: Numbers
    nodes: Numbers
    cell: str
    points: Floats
    connectivity: Ids
    owned: Numbers
    fixed: NDArray[np.bool_]
    controls: list[Ids | Floats]
    faces: list[Ids]
    facets: list[Numbers]
    ties: list[Ids]
    numbers: Numbers
    node_numbers: Numbers
    own: int
    before: int
    count: int
    u: Floats
    history: tuple[Floats, Floats] | None
    multipliers: list[Floats | None]


class Cutting:
    """A whole model whose cells have been given to ranks.

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
        self._contact_faces = [by_rank(part[contact.faces[:, 0]], size) for contact in whole.contacts]
        pressures = whole.of_kind(Pressure)
        self._pressed_faces = {control: by_rank(part[control.faces[:, 0]], size) for control in pressures}
        self._owners, self._pairs = Owners.of(whole, self._cells), tied_pairs(whole)
        # Numbers on the rank whose parcel is cut, -1 elsewhere.
        self._node = np.full(len(whole.mesh.points), -1, dtype=np.int32)
        self._cell = np.full(len(part), -1, dtype=np.int32)

    def parcel(self, rank: int) -> Parcel:
        """What a rank gets; the work grows with its part, and with the sets of the whole model."""
        cells, tied, nodes = self._cells[rank], *self._known(rank)
        self._node[nodes], self._cell[cells] = np.arange(len(nodes)), np.arange(len(cells))
        whole, owners = self._whole, self._owners
        owned = np.flatnonzero(owners.node[nodes] == rank)
        here = [of_rank[rank] for of_rank in self._contact_faces]
        number = owners.equation.reshape(-1, 3)[nodes].ravel()
        parcel = Parcel(
            cells=cells,
            nodes=nodes,
            cell=whole.mesh.cell,
            points=whole.mesh.points[nodes],
            connectivity=self._node[whole.mesh.connectivity[cells]],
            owned=owned,
            fixed=whole._fixed.reshape(-1, 3)[nodes].ravel(),
            controls=[self._of_control(control, rank, nodes, owned) for control in whole.controls],
            faces=[self._faces(contact.faces[rows]) for contact, rows in zip(whole.contacts, here, strict=True)],
            facets=here,
            ties=[self._dofs(tie.dofs)[(self._node[tie.dofs // 3] >= 0).all(axis=1)] for tie in whole.ties],
            numbers=np.concatenate([number[number >= 0], owners.tie[tied]]),
            node_numbers=self._consecutive[nodes],
            own=int(owners.own[rank]),
            before=int(owners.own[:rank].sum()),
            count=int(owners.own.sum()),
            u=whole.u.reshape(-1, 3)[nodes].ravel(),
            history=self._history(cells),
            multipliers=self._multipliers(here),
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
        return tied, np.union1d(nodes, self._pairs[tied] // 3).astype(np.int64)

    @cached_property
    def _consecutive(self) -> Numbers:
        return self._owners.consecutive_nodes()

    def _dofs(self, dofs: Ids) -> Ids:
        """Degrees of freedom here of those of the whole model; negative where there is none."""
        return (3 * self._node[dofs // 3] + dofs % 3).astype(np.int32)

    def _faces(self, faces: Ids) -> Ids:
        """Faces, rows (cell, face) of the whole mesh, in numbers of the rank."""
        return np.stack([self._cell[faces[:, 0]], faces[:, 1]], axis=1)

    def _of_control(self, control: Control, rank: int, nodes: Numbers, owned: Numbers) -> Ids | Floats:
        """What is here of a control; a load on a node that several ranks have counts for its owner."""
        if isinstance(control, Prescribed | MidLine):
            dofs = self._dofs(control.dofs)
            return dofs[dofs >= 0]
        if isinstance(control, Load):
            vector = np.zeros((len(nodes), 3))
            vector[owned] = control.vector.reshape(-1, 3)[nodes[owned]]
            return vector.ravel()
        if isinstance(control, Pressure):
            return self._faces(control.faces[self._pressed_faces[control][rank]])
        return np.empty(0)

    @cached_property
    def _begun(self) -> tuple[Floats, Floats] | None:
        """History of all cells, if they have one yet."""
        block = self._whole.block if "block" in vars(self._whole) else None
        return None if block is None else (block.state, block.alpha)

    def _history(self, cells: Numbers) -> tuple[Floats, Floats] | None:
        return None if self._begun is None else (self._begun[0][cells], self._begun[1][cells])

    def _multipliers(self, here: list[Numbers]) -> list[Floats | None]:
        return [
            contact.multipliers.reshape(len(contact.facets), -1)[rows].ravel() if "block" in vars(contact) else None
            for contact, rows in zip(self._whole.contacts, here, strict=True)
        ]


def by_rank(rank: Ids, size: int) -> list[Numbers]:
    """Numbers of the things that each rank has, in their order, from the rank of each thing."""
    ends = np.cumsum(np.bincount(rank, minlength=size))
    return np.split(np.argsort(rank, kind="stable"), ends[:-1])
