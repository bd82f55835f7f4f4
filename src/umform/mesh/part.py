"""A part of a mesh as a new mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.mesh.mesh import Ids, Mesh, nodes_of_faces
from umform.mesh.neighbours import connected
from umform.mesh.numbers import unique

Numbers = NDArray[np.int64]


@dataclass(frozen=True)
class MeshPart:
    """Some of the cells of a mesh.

    Attributes
    ----------
    mesh : Mesh
        The kept cells with their nodes and the remaining sets, which may be empty. Its sets of nodes and faces ``cut``
        are lateral faces that a removed cell shared.
    cells : ndarray of int
        Indices of its cells in the whole mesh, increasing.
    nodes : ndarray of int
        Indices of its nodes in the whole mesh, increasing.
    pieces : int
        Number of parts that share no node.
    """

    mesh: Mesh
    cells: Numbers
    nodes: Numbers
    pieces: int


def part_of_mesh(mesh: Mesh, kept: NDArray[np.bool_]) -> MeshPart:
    """A part of a mesh; nodes and cells keep their order.

    Parameters
    ----------
    mesh : Mesh
        The whole.
    kept : ndarray of bool, shape (cells,)
        Mask of the cells to keep; at least one.
    """
    cells = np.flatnonzero(kept)
    nodes = unique(mesh.connectivity[cells])
    node = np.full(len(mesh.points), -1, dtype=np.int32)
    node[nodes] = np.arange(len(nodes), dtype=np.int32)
    cell = np.full(len(kept), -1, dtype=np.int32)
    cell[cells] = np.arange(len(cells), dtype=np.int32)
    sets = {name: node[ids][node[ids] >= 0] for name, ids in mesh.sets.items()}
    faces = {name: _renumbered(rows, cell) for name, rows in mesh.faces.items()}
    connectivity = node[mesh.connectivity[cells]]
    cut = _renumbered(_cut_faces(mesh, kept), cell)
    sets.pop("cut", None)
    made = Mesh(mesh.points[nodes], {mesh.cell: connectivity}, sets, {**faces, "cut": cut})
    return MeshPart(made, cells, nodes.astype(np.int64), int(sheets_of(made).max()) + 1)


def sheets_of(mesh: Mesh) -> Numbers:
    """Number of the sheet that each cell belongs to, from 0: sheets share no node; shape (cells,)."""
    cells = mesh.connectivity
    links = np.stack([np.repeat(cells[:, 0], cells.shape[1] - 1), cells[:, 1:].ravel()], axis=1)
    return connected(len(mesh.points), links)[cells[:, 0]]


def joined_by_faces(mesh: Mesh, cells: Numbers) -> Numbers:
    """Number of the part in which each of some cells lies; parts share edges or single nodes at most; (cells,)."""
    sides = [np.sort(mesh.connectivity[cells][:, nodes], axis=1) for nodes in nodes_of_faces(mesh.cell)]
    links, before = [], len(cells)
    for kind in (sides[:2], sides[2:]):  # upper and lower faces may have more nodes than the lateral ones
        number = np.unique(np.concatenate(kind), axis=0, return_inverse=True)[1].ravel()
        links.append(np.stack([np.tile(np.arange(len(cells)), len(kind)), before + number], axis=1))
        before += int(number.max()) + 1
    return connected(before, np.concatenate(links))[: len(cells)]


def stacks(mesh: Mesh) -> Numbers:
    """Stack of each cell: cells above each other through the thickness, shape (cells,)."""
    half, count = mesh.connectivity.shape[1] // 2, len(mesh.connectivity)
    faces = np.sort(np.concatenate([mesh.connectivity[:, :half], mesh.connectivity[:, half:]]), axis=1)
    number = np.unique(faces, axis=0, return_inverse=True)[1].ravel()
    links = np.stack([np.tile(np.arange(count), 2), count + number], axis=1)
    return connected(count + int(number.max()) + 1, links)[:count]


def _renumbered(rows: NDArray[np.integer], cell: Ids) -> Ids:
    """Faces with cell indices of the whole mesh."""
    left = rows[cell[rows[:, 0]] >= 0]
    return np.stack([cell[left[:, 0]], left[:, 1]], axis=1).astype(np.int32)


def _cut_faces(mesh: Mesh, kept: NDArray[np.bool_]) -> Ids:
    """Lateral faces between kept and removed cells."""
    local = nodes_of_faces(mesh.cell)[2:]
    sides = np.sort(np.stack([mesh.connectivity[:, nodes] for nodes in local], axis=1), axis=2)
    count = sides.shape[0] * sides.shape[1]
    number = np.unique(sides.reshape(count, -1), axis=0, return_inverse=True)[1].ravel()
    side_kept = np.repeat(kept, len(local))
    gone = np.zeros(count, dtype=bool)
    gone[number[~side_kept]] = True
    rows = np.flatnonzero(side_kept & gone[number])
    return np.stack([rows // len(local), 2 + rows % len(local)], axis=1).astype(np.int32)
