"""Distinguish the bending of a very thin sheet from a mechanism: rigid motions of its parts. eqs. (5.99), (5.100)

The tangent of a very thin sheet resists bending less than the round-off of its entries (5.80), so that a solver cannot
tell it from the tangent of a mechanism. A mechanism of a sheet moves parts rigidly, which follows from the mesh and the
supports; what resists such a motion, contact and springs, is no small difference of large entries.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Ids
from umform.mesh.numbers import unique
from umform.model.equations.assembled import Assembled
from umform.model.terms import forces
from umform.solvers import Pattern

Floats = NDArray[np.float64]

#: Length over thickness of a thin sheet: bending resists more than 100 times the round-off of a thicker one. eq. (5.80)
_THIN = 2000.0
#: Nodes that cells of one part share: those of a face, since an edge of a hexahedron has two or three.
_FACE = 4
#: Most parts, and the singular value below which supports and joints leave a motion free.
_PARTS, _FREE = 10, 1e-8
#: Resistance to a rigid motion that is round-off.
_ROUND_OFF = 1e-14


def mechanism(model: Assembled, values: Floats, motion: Floats) -> Floats | None:
    """What can move although a tangent looks singular; None for a very thin sheet whose parts cannot move rigidly.

    Parameters
    ----------
    model : Model
        The model.
    values : ndarray
        Entries of the tangent, those of `model.pattern`.
    motion : ndarray, shape (n,)
        Displacement of the unknowns that the tangent hardly resists; returned if the sheet is not very thin.
    """
    if model.ranks.size > 1 or model.extent < _THIN * model.thickness:
        return motion
    part = _parts(model.mesh.connectivity, len(model.mesh.points))
    if part.max() >= _PARTS:  # their motions would take much memory
        return motion
    motions, sizes = _motions_of_parts(model, part)
    if len(motions) == 0:
        return None
    resistance, weakest = _least_resistance(model.pattern, values, motions, sizes)
    return None if resistance > _ROUND_OFF else weakest


def _parts(cells: Ids, nodes: int) -> NDArray[np.int32]:
    """Part of each cell: cells that share a face belong to one."""
    from scipy import sparse  # imported for very thin sheets only: slow
    from scipy.sparse.csgraph import connected_components

    count, width = cells.shape
    ones = np.ones(cells.size, dtype=np.int32)
    of_cell = sparse.csr_matrix((ones, cells.ravel(), np.arange(0, cells.size + 1, width)), shape=(count, nodes))
    shared = (of_cell @ of_cell.T).tocsr()
    shared.data = (shared.data >= _FACE).astype(np.int32)
    shared.eliminate_zeros()
    label: NDArray[np.int32] = connected_components(shared, directed=False)[1]
    return label


def _motions_of_parts(model: Assembled, part: NDArray[np.int32]) -> tuple[Floats, Floats]:
    """Rigid motions of the parts that joints and supports leave free, (k, n), and the sizes of all, (n,). eq. (5.99)"""
    cells, now = model.mesh.connectivity, model.mesh.displaced(model.u)
    modes = forces.rigid_body_modes(now).reshape(6, -1, 3)
    owner = np.full(len(now), -1)
    moved = np.zeros((part.max() + 1, 6, *now.shape))
    joints = [np.zeros((0, 6 * len(moved)))]
    for k in range(len(moved)):
        its = unique(cells[part == k])
        shared = its[owner[its] >= 0]
        jump = np.zeros((len(moved), 6, len(shared), 3))
        jump[k] = modes[:, shared]
        jump[owner[shared], :, np.arange(len(shared))] -= modes[:, shared].transpose(1, 0, 2)
        joints.append(jump.reshape(6 * len(moved), -1).T)
        own = its[owner[its] < 0]
        owner[own] = k
        moved[k][:, own] = modes[:, own]
    flat = moved.reshape(6 * len(moved), -1)
    unknowns = np.array([model.coefficients(one) for one in flat])
    scalars = np.zeros(len(model.unknowns))
    kept = [model.extend(np.concatenate([q, scalars]))[: model.u.size] for q in unknowns]
    against = (flat - np.array(kept)).T  # what supports prevent
    rows = np.concatenate([*joints, against[np.abs(against).max(axis=1) > 0.0]])
    _, sizes, directions = np.linalg.svd(np.concatenate([rows, np.zeros((len(flat), len(flat)))]), full_matrices=False)
    free = directions[sizes <= _FREE * max(1.0, sizes[0])]
    return free @ unknowns, np.abs(unknowns).sum(axis=0)


def _least_resistance(pattern: Pattern, values: Floats, motions: Floats, sizes: Floats) -> tuple[float, Floats]:
    """Resistance to the motion that is resisted least, relative to the sizes of its terms; and it. eq. (5.100)"""
    from scipy import sparse

    matrix = sparse.csr_matrix((values, pattern.indices, pattern.indptr), shape=(pattern.n, pattern.n))
    if pattern.symmetric:
        matrix = matrix + sparse.triu(matrix, 1).T
    part = (matrix @ motions.T) / np.maximum(abs(matrix) @ sizes, np.finfo(np.float64).tiny)[:, None]
    weakest = np.linalg.svd(part, full_matrices=False)[2][-1]
    return float(np.abs(part @ weakest).max()), weakest @ motions
