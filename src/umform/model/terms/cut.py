"""The part of a mesh on a rank: numbers of nodes, degrees of freedom, cells and faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Ids = NDArray[np.int32]
Numbers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Cut:
    """Numbers on one rank for numbers of the whole model.

    Attributes
    ----------
    nodes : ndarray of int
        Nodes of the rank, in the numbering of the whole model.
    owned : ndarray of int
        Those that the rank owns, in its numbering; a shared node belongs to one rank.
    node, cell : ndarray of int32
        Number on the rank of each node and cell of the whole model, -1 if it is elsewhere.
    """

    nodes: Numbers
    owned: Numbers
    node: Ids
    cell: Ids

    def dofs(self, dofs: Ids) -> Ids:
        """Degrees of freedom on the rank; negative if they are elsewhere."""
        return (3 * self.node[dofs // 3] + dofs % 3).astype(np.int32)

    def nodes_of(self, nodes: Ids) -> tuple[Ids, Numbers]:
        """Of some nodes those that the rank owns, in its numbering, and their rows in ``nodes``.

        A shared node is in the result of one rank only, so that its forces count once.
        """
        here = np.zeros(len(self.nodes) + 1, dtype=bool)  # the last entry stands for absent nodes: -1
        here[self.owned] = True
        rows = np.flatnonzero(here[self.node[nodes]])
        return self.node[nodes[rows]].astype(np.int32), rows

    def cells_of(self, cells: Numbers) -> tuple[Numbers, Numbers]:
        """Of some cells those on the rank, in its numbering, and their rows in ``cells``."""
        rows = np.flatnonzero(self.cell[cells] >= 0)
        return self.cell[cells[rows]].astype(np.int64), rows

    def faces_of(self, faces: Ids) -> tuple[Ids, Numbers]:
        """Of some faces, rows (cell, face), those on the rank, in its numbering, and their rows."""
        rows = np.flatnonzero(self.cell[faces[:, 0]] >= 0)
        return np.stack([self.cell[faces[rows, 0]], faces[rows, 1]], axis=1), rows
