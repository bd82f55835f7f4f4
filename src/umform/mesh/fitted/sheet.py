"""The sheet as quadrilaterals: stacks of cells through the thickness and fibres through its nodes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.errors import MeshError
from umform.mesh.mesh import Mesh
from umform.mesh.neighbours import connected

Numbers = NDArray[np.int64]


@dataclass(frozen=True)
class Sheet:
    """Stacks and fibres of a mesh of 8-node cells.

    Attributes
    ----------
    quads : ndarray of int, shape (stacks, 4)
        Fibres at the corners of each stack, in the order of the lower faces.
    cells : ndarray of int, shape (stacks, layers)
        Cells of each stack, from below.
    nodes : ndarray of int, shape (fibres, layers + 1)
        Nodes of each fibre, from below.
    """

    quads: Numbers
    cells: Numbers
    nodes: Numbers

    @classmethod
    def of(cls, mesh: Mesh) -> Sheet:
        """The stacks of a mesh.

        Raises
        ------
        MeshError
            If the cells have 18 nodes, or the number of layers varies.
        """
        if mesh.cell != "hex8":
            raise MeshError("only 8-node cells can be fitted to a line", value=mesh.cell)
        lower, upper = mesh.connectivity[:, :4], mesh.connectivity[:, 4:]
        links = np.stack([lower.ravel(), upper.ravel()], axis=1)
        fibre = connected(len(mesh.points), links)
        used = np.unique(fibre)
        fibre = np.searchsorted(used, fibre)
        level = np.zeros(len(mesh.points), dtype=np.int64)
        for _ in range(len(mesh.points)):  # as often as there are layers
            above = level.copy()
            np.maximum.at(above, links[:, 1], level[links[:, 0]] + 1)
            if np.array_equal(above, level) or above.max() > len(mesh.connectivity):
                break
            level = above
        layers = int(level.max())
        corners = fibre[lower]
        key = np.sort(corners, axis=1)
        stack = np.unique(key, axis=0, return_inverse=True)[1].ravel()
        count = int(stack.max()) + 1
        layer = level[lower].min(axis=1)
        even = (level[lower] == layer[:, None]).all() and (level[upper] == layer[:, None] + 1).all()
        if not even or len(stack) != count * layers or len(mesh.points) != len(used) * (layers + 1):
            raise MeshError("the number of layers varies over the sheet", value=f"up to {layers} layers")
        cells = np.empty((count, layers), dtype=np.int64)
        cells[stack, layer] = np.arange(len(stack))
        nodes = np.empty((len(used), layers + 1), dtype=np.int64)
        nodes[fibre, level] = np.arange(len(mesh.points))
        return cls(corners[cells[:, 0]], cells, nodes)

    @cached_property
    def edge_stacks(self) -> tuple[Numbers, Numbers]:
        """Edges as pairs of fibres (e, 2), ascending, and for each side of each stack its edge (stacks, 4)."""
        sides = np.stack([self.quads, np.roll(self.quads, -1, axis=1)], axis=2)
        edges, number = np.unique(np.sort(sides, axis=2).reshape(-1, 2), axis=0, return_inverse=True)
        return edges, number.reshape(-1, 4)

    @cached_property
    def rim(self) -> NDArray[np.bool_]:
        """Whether an edge belongs to one stack only, shape (e,)."""
        edges, number = self.edge_stacks
        lone: NDArray[np.bool_] = np.bincount(number.ravel(), minlength=len(edges)) == 1
        return lone
