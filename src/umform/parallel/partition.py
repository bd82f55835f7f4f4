"""Assign cells to ranks: the graph of the columns of cells, partitioned by a library of PETSc.

All stacked cells belong to one rank: contact, ties and thickness then need no neighbour through the sheet, and the
graph is that of a surface.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph

from umform.errors import InvalidValue
from umform.mesh import Ids, Mesh
from umform.parallel.mpi_ranks import MpiRanks
from umform.parallel.petsc import PREFIX, petsc


def partition(mesh: Mesh | None, ranks: MpiRanks) -> Ids | None:
    """Rank of each cell, on the first rank, which has the mesh; each rank gets its rows of the graph.

    PETSc uses PT-Scotch or ParMETIS, depending on its build; ``-umform_mat_partitioning_type`` selects another one.

    Parameters
    ----------
    mesh : Mesh or None
        All cells, on the first rank.
    ranks : MpiRanks
        Those that share them.

    Returns
    -------
    ndarray of int32, shape (cells,), or None
        None on the other ranks.

    Raises
    ------
    InvalidValue
        If a rank would have no cell.
    """
    if mesh is None:
        ranks.comm.gather(_parts(ranks.comm.recv(source=0), ranks))
        ranks.agree(None)
        return None
    if ranks.size == 1:
        return np.zeros(len(mesh.connectivity), dtype=np.int32)
    column = columns(mesh)
    mine, *others = _graphs(mesh, column, ranks.size)
    for rank, graph in enumerate(others, start=1):
        ranks.comm.send(graph, dest=rank)
    part = np.concatenate(ranks.comm.gather(_parts(mine, ranks))).astype(np.int32)
    ranks.agree(_empty(part, ranks.size))
    return part[column]


def _empty(part: Ids, size: int) -> InvalidValue | None:
    """The error for a rank without a column."""
    empty = np.setdiff1d(np.arange(size), part)
    if len(empty) == 0:
        return None
    return InvalidValue(
        "a rank has no cell",
        where=f"rank {empty[0]} of {size}",
        value=f"{len(part)} columns of cells",
        cause="there are too many ranks for so small a mesh",
        remedy="start fewer ranks: one for some thousand cells, or more, pays",
    )


def columns(mesh: Mesh) -> Ids:
    """Column of each cell: the cells above each other; shape (cells,)."""
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


def _graphs(mesh: Mesh, column: Ids, size: int) -> Iterator[sparse.csr_matrix]:
    """Columns that share a lateral edge, a row for each column; for each rank about as many rows, and its entries."""
    corners, count = mesh.connectivity[:, :4], int(column.max()) + 1
    shape, entry = (count, len(mesh.points)), np.ones(corners.size, dtype=np.int32)
    nodes = sparse.csr_matrix((entry, (np.repeat(column, 4), corners.ravel())), shape=shape)
    nodes.data[:] = 1  # cells of one column may share nodes
    others = nodes.T.tocsr()
    ends = np.linspace(0, count, size + 1).astype(np.int64)
    for first, last in pairwise(ends):
        shared = (nodes[first:last] @ others).tocoo()
        close = (shared.data >= 2) & (shared.row + first != shared.col)
        entries = (shared.data[close], (shared.row[close], shared.col[close]))
        graph = sparse.csr_matrix(entries, shape=shared.shape)
        graph.sort_indices()
        yield graph


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
