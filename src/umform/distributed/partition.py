"""Which rank gets which cells: the graph of the columns of cells, parted by a library that PETSc knows.

All cells on top of each other go to one rank: contact, ties and thickness then need no neighbour through the sheet, and
the graph is that of a surface.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from umform.distributed.mpi_ranks import MpiRanks
from umform.distributed.petsc import PREFIX, petsc
from umform.errors import InvalidValue
from umform.mesh import Ids, Mesh


def partition(mesh: Mesh, ranks: MpiRanks) -> Ids:
    """Rank of each cell, the same array on all ranks.

    PETSc takes PT-Scotch or ParMETIS, whichever it was built with; ``-umform_mat_partitioning_type`` names another one.

    Parameters
    ----------
    mesh : Mesh
        All cells, on all ranks.
    ranks : MpiRanks
        Those that share them.

    Returns
    -------
    ndarray of int32, shape (cells,)

    Raises
    ------
    InvalidValue
        If a rank would get no cell.
    """
    if ranks.size == 1:
        return np.zeros(len(mesh.connectivity), dtype=np.int32)
    column = columns(mesh)
    count = int(column.max()) + 1
    ends = np.linspace(0, count, ranks.size + 1).astype(np.int64)
    first, last = int(ends[ranks.rank]), int(ends[ranks.rank + 1])
    mine = _parts(_neighbours(mesh, column, first, last), ranks)
    part = np.concatenate(ranks.comm.allgather(mine))[column]
    empty = np.setdiff1d(np.arange(ranks.size), part)
    if len(empty):
        raise InvalidValue(
            "a rank has no cell",
            where=f"rank {empty[0]} of {ranks.size}",
            value=f"{count} columns of cells",
            cause="there are too many ranks for so small a mesh",
            remedy="start fewer ranks: one for some thousand cells, or more, pays",
        )
    return part.astype(np.int32)


def columns(mesh: Mesh) -> Ids:
    """Number of the column that each cell belongs to: the cells that lie on each other; shape (cells,)."""
    cells, half = mesh.connectivity, mesh.connectivity.shape[1] // 2
    count = len(cells)
    lower, upper = cells[:, :4], cells[:, half : half + 4]
    if not np.isin(upper, lower).any():  # one layer
        return np.arange(count, dtype=np.int32)
    faces = np.sort(np.concatenate([lower, upper]), axis=1)
    _, face = np.unique(faces, axis=0, return_inverse=True)
    face = face.ravel()
    members = sparse.csr_matrix((np.ones(2 * count), (face, np.tile(np.arange(count), 2))))
    _, column = csgraph.connected_components(members.T @ members, directed=False)
    return np.asarray(column, dtype=np.int32)


def _neighbours(mesh: Mesh, column: Ids, first: int, last: int) -> sparse.csr_matrix:
    """Columns that share a lateral edge with the columns first ... last - 1; a row for each of these."""
    corners = mesh.connectivity[:, :4]
    pairs = np.unique(np.stack([np.repeat(column, 4), corners.ravel()], axis=1), axis=0)
    shape = (int(column.max()) + 1, len(mesh.points))
    nodes = sparse.csr_matrix((np.ones(len(pairs), dtype=np.int32), (pairs[:, 0], pairs[:, 1])), shape=shape)
    shared = (nodes[first:last] @ nodes.T).tocoo()
    close = (shared.data >= 2) & (shared.row + first != shared.col)
    entries = (shared.data[close], (shared.row[close], shared.col[close]))
    graph = sparse.csr_matrix(entries, shape=shared.shape)
    graph.sort_indices()
    return graph


def _parts(graph: sparse.csr_matrix, ranks: MpiRanks) -> NDArray[np.int32]:
    """Part of each column of this rank's rows of the graph."""
    PETSc = petsc()
    rows, count = graph.shape
    adjacency: Any = PETSc.Mat().createAIJ(
        ((rows, count), (rows, count)),
        csr=(graph.indptr.astype(PETSc.IntType), graph.indices.astype(PETSc.IntType), graph.data.astype(float)),
        comm=ranks.petsc_comm,
    )
    adjacency = adjacency.convert("mpiadj")
    partitioning = PETSc.MatPartitioning().create(ranks.petsc_comm)
    partitioning.setOptionsPrefix(PREFIX)
    partitioning.setAdjacency(adjacency)
    partitioning.setFromOptions()
    answer = PETSc.IS()
    partitioning.apply(answer)
    return np.array(answer.getIndices(), dtype=np.int32)
