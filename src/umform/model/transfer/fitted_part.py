"""The mesh of the part of a sheet inside of a line, with an edge on the line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Mesh
from umform.mesh.fitted.layer import Layer
from umform.mesh.fitted.sheet import Sheet
from umform.mesh.mesh import FACES

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

#: Lateral faces of a cell by the side of its stack: s0, r1, s1, r0.
_SIDES = np.array([FACES.index(name) for name in ("s0", "r1", "s1", "r0")])


@dataclass(frozen=True)
class FittedMesh:
    """The mesh of the part.

    Attributes
    ----------
    mesh : Mesh
        Its cells and nodes, with the sets that remain, and the sets ``cut``.
    parents : ndarray of int, shape (cells,)
        Cell of the whole mesh in which each cell lies.
    nodes : ndarray of int, shape (nodes,)
        Node of the whole mesh, -1 for new ones.
    same : ndarray of bool, shape (cells,)
        Whether a cell has the places of its parent.
    weights : tuple of ndarray
        Nodes of the whole mesh (nodes, 4) and their shares (nodes, 4), by which each node lies in it.
    """

    mesh: Mesh
    parents: Numbers
    nodes: Numbers
    same: NDArray[np.bool_]
    weights: tuple[Numbers, Floats]

    def at_nodes(self, values: Floats) -> Floats:
        """Values at the nodes of values (n, 3) at those of the whole mesh. eq. (1.31)"""
        at, share = self.weights
        out: Floats = np.einsum("na,nai->ni", share, values[at])
        return out


def fitted_mesh(whole: Mesh, sheet: Sheet, layer: Layer) -> FittedMesh:
    """The mesh of the stacks of a layer."""
    levels = sheet.nodes.shape[1]
    fibres = np.unique(layer.quads)
    count = len(sheet.nodes)
    around = np.tile(np.arange(count + layer.new)[:, None], (1, 4))  # fibres by which each one lies in the sheet
    share = np.tile([1.0, 0.0, 0.0, 0.0], (count + layer.new, 1))
    around[layer.moved], share[layer.moved] = sheet.quads[layer.places.quad], layer.places.weights
    around, share = around[fibres], share[fibres]
    old = np.where(fibres < count, fibres, 0)
    names = np.where((fibres < count)[:, None], sheet.nodes[old], -1).ravel()
    order = np.argsort(np.where(names < 0, len(whole.points) + np.arange(len(names)), names), kind="stable")
    ranked = np.empty(len(names), dtype=np.int64)
    ranked[order] = np.arange(len(names))
    number = ranked.reshape(-1, levels)
    at = np.moveaxis(sheet.nodes[around], 2, 1).reshape(-1, 4)[order]
    shares = np.repeat(share, levels, axis=0)[order]
    corners = number[np.searchsorted(fibres, layer.quads)]  # [stack][corner][level]
    cells = np.concatenate([corners[:, :, :-1], corners[:, :, 1:]], axis=1)
    connectivity = np.moveaxis(cells, 2, 1).reshape(-1, 8)
    parents = sheet.cells[layer.parents].ravel()
    same = np.repeat(_unmoved(layer), levels - 1)
    points = np.einsum("na,nai->ni", shares, whole.points[at])
    kept = np.where(names[order] >= 0)[0]
    still = kept[shares[kept].max(axis=1) == 1.0]
    points[still] = whole.points[at[still, shares[still].argmax(axis=1)]]
    sets = {
        name: _members(np.asarray(ids), at, shares, len(whole.points))
        for name, ids in whole.sets.items()
        if name != "cut"
    }
    lateral = _LateralFaces(sheet, layer, around, share, fibres)
    faces = {name: lateral.of(np.asarray(rows), whole, parents) for name, rows in whole.faces.items() if name != "cut"}
    faces["cut"] = lateral.cut()
    mesh = Mesh(points, {whole.cell: connectivity.astype(np.int32)}, sets, faces)
    return FittedMesh(mesh, parents, names[order], same, (at, shares))


def _unmoved(layer: Layer) -> NDArray[np.bool_]:
    """Stacks that are those of the sheet."""
    moved = np.asarray(np.isin(layer.quads, layer.moved).any(axis=1))
    moved[len(layer.inner) :] = True
    return np.logical_not(moved)


def _members(ids: NDArray[np.integer], at: Numbers, shares: Floats, count: int) -> NDArray[np.int32]:
    """Nodes that lie between nodes of a set."""
    inside = np.zeros(count, dtype=bool)
    inside[ids] = True
    return np.flatnonzero((inside[at] | (shares == 0.0)).all(axis=1)).astype(np.int32)


class _LateralFaces:
    """Faces of the new cells in the sets of the old ones."""

    def __init__(self, sheet: Sheet, layer: Layer, around: Numbers, share: Floats, fibres: Numbers) -> None:
        self._sheet, self._layer = sheet, layer
        place = np.searchsorted(fibres, layer.quads)
        ends = np.stack([place, np.roll(place, -1, axis=1)], axis=2)  # [stack][side][end]
        self._support = np.where(share > 0.0, around, -1)[ends].reshape(*ends.shape[:2], -1)
        sides = np.sort(np.stack([layer.quads, np.roll(layer.quads, -1, axis=1)], axis=2), axis=2)
        number = np.unique(sides.reshape(-1, 2), axis=0, return_inverse=True)[1].ravel()
        lone = np.bincount(number)[number].reshape(-1, 4) == 1
        edges = sheet.edge_stacks[0][sheet.rim]
        self._rims, self._count = edges, len(sheet.nodes)
        self._lone = np.argwhere(lone)
        self._on = [self._edges(stack, side) for stack, side in self._lone]

    def _edges(self, stack: int, side: int) -> list[tuple[int, int]]:
        """The edges of the rim of the sheet along which a side lies; none of a side of the cut."""
        ends = self._layer.quads[stack, [side, (side + 1) % 4]]
        if (ends >= self._count).all():  # both on the line
            return []
        fibres = self._support[stack, side]
        fibres = fibres[fibres >= 0]
        if not np.isin(fibres, self._rims).all():
            return []
        along = self._rims[np.isin(self._rims, fibres).all(axis=1)]
        return [(int(a), int(b)) for a, b in along]

    def cut(self) -> NDArray[np.int32]:
        """Faces of the edge that no rim of the sheet has."""
        layers = self._sheet.cells.shape[1]
        rows = [
            (stack * layers + k, _SIDES[side])
            for (stack, side), along in zip(self._lone, self._on, strict=True)
            if not along
            for k in range(layers)
        ]
        return np.array(rows, dtype=np.int32).reshape(-1, 2)

    def of(self, rows: NDArray[np.integer], whole: Mesh, parents: Numbers) -> NDArray[np.int32]:
        """Faces of a set: lower and upper ones of the parents; lateral ones that lie on the same edges of the rim."""
        found = []
        for face in (0, 1):
            found.append([(c, face) for c in np.flatnonzero(np.isin(parents, rows[rows[:, 1] == face, 0]))])
        layers = self._sheet.cells.shape[1]
        stack = np.empty(len(whole.connectivity), dtype=np.int64)
        level = np.empty_like(stack)
        stack[self._sheet.cells] = np.arange(len(self._sheet.cells))[:, None]
        level[self._sheet.cells] = np.arange(layers)
        side_of = {int(face): side for side, face in enumerate(_SIDES)}
        edges = set()
        for cell, face in rows[rows[:, 1] > 1]:
            quad, side = self._sheet.quads[stack[cell]], side_of[int(face)]
            a, b = sorted((int(quad[side]), int(quad[(side + 1) % 4])))
            edges.add((a, b, int(level[cell])))
        found.append(
            [
                (at * layers + k, int(_SIDES[side]))
                for (at, side), along in zip(self._lone, self._on, strict=True)
                for k in range(layers)
                if any((*edge, k) in edges for edge in along)
            ]
        )
        return np.array([row for part in found for row in part], dtype=np.int32).reshape(-1, 2)
