"""Ties of a lower and an upper node: the mean of their displacements is held, their difference is free.

A sheet of solid-shells has no node on its mid-surface. A hinge holds the mean of the two nodes of a fibre, which may
rotate about it. docs/theory, 5.10
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.mesh import Ids, Mesh, Selector
from umform.model.supports.constraints import Rows
from umform.model.terms.control import OnDofs

Floats = NDArray[np.float64]


@dataclass(eq=False, repr=False)
class MidLine(OnDofs):
    """Displacement of the mid-line of an edge in one direction; its force is the sum of the reactions on the sheet."""


@dataclass(frozen=True)
class Tie:
    """Pairs of degrees of freedom (lower, upper), shape (k, 2), whose mean is held or the value of a control.

    With offsets, shape (k,), the mean has these values instead of zero.
    """

    dofs: Ids
    control: MidLine | None
    offsets: Floats | None = None

    def without_held(self, held: NDArray[np.bool_]) -> Tie:
        """A hinge without the pairs whose nodes are both held: their mean is prescribed already."""
        if self.control is not None:
            return self
        left = ~held[self.dofs].all(axis=1)
        return Tie(self.dofs[left], None, None if self.offsets is None else self.offsets[left])


def split_ties(ties: Sequence[Tie], rows: Sequence[Rows], constrained: NDArray[np.bool_]) -> tuple[Ids, list[Rows]]:
    """Isolated pairs, and the rows together with those pairs that share a degree of freedom with one of them.

    Parameters
    ----------
    ties : sequence of Tie
        All ties.
    rows : sequence of Rows
        Constraints in local axes.
    constrained : ndarray of bool, shape (3 n,)
        Degrees of freedom that are held or prescribed individually.
    """
    local = np.zeros(len(constrained), dtype=bool)
    for part in rows:
        local[part.dofs[part.weights != 0.0]] = True
    local &= ~constrained
    pairs, joined = [np.empty((0, 2), dtype=np.int32)], list(rows)
    for tie in ties:
        touched = local[tie.dofs].any(axis=1)
        pairs.append(tie.dofs[~touched])
        if touched.any():
            by = "hinge" if tie.control is None else tie.control.name
            offsets = None if tie.offsets is None else tie.offsets[touched]
            joined.append(Rows(tie.dofs[touched], np.full((int(touched.sum()), 2), 0.5), tie.control, by, offsets))
    return np.concatenate(pairs), joined


def node_pairs(mesh: Mesh, nodes: Selector) -> Ids:
    """Outermost lower and upper nodes of the fibres through the sheet in a set.

    Parameters
    ----------
    mesh : Mesh
        Points and cells; lower node a of a cell of n nodes and its node a + n/2 belong to one fibre.
    nodes : str, callable or array_like
        Name of a set, predicate of x, y, z, node ids or a mask, see :meth:`umform.Mesh.nodes`.

    Returns
    -------
    ndarray of int32, shape (k, 2)

    Raises
    ------
    InvalidValue
        If the set contains a node of a fibre but not both of its outermost nodes.
    """
    half = mesh.connectivity.shape[1] // 2
    links = np.unique(
        np.stack([mesh.connectivity[:, :half].ravel(), mesh.connectivity[:, half:].ravel()], axis=1), axis=0
    )
    if any(len(np.unique(side)) < len(links) for side in links.T):
        raise InvalidValue(
            "lower and upper nodes do not pair up",
            where="mesh",
            cause="neighbouring cells do not agree on the direction through the thickness",
            remedy="order the nodes of all cells from the same face of the sheet",
        )
    above = np.arange(len(mesh.points))
    above[links[:, 0]] = links[:, 1]
    bottoms = np.setdiff1d(links[:, 0], links[:, 1])
    tops = above[bottoms]
    fibre = np.full(len(mesh.points), -1)  # index of the fibre of each node
    fibre[bottoms] = fibre[tops] = np.arange(len(bottoms))
    while not np.array_equal(above[tops], tops):  # one layer of the stack at a time
        tops = above[tops]
        fibre[tops] = np.arange(len(bottoms))
    ids = mesh.nodes(nodes)
    touched = np.unique(fibre[ids])
    alone = touched[(touched < 0) | ~(np.isin(bottoms[touched], ids) & np.isin(tops[touched], ids))]
    if len(alone):
        raise InvalidValue(
            "a node has no partner on the other face of the sheet",
            where=f"node {ids[fibre[ids] == alone[0]][0]}",
            value=nodes if isinstance(nodes, str) else "predicate or list",
            cause="the set holds the nodes of one face only",
            remedy="take the set of the whole edge, x0 instead of x0_lower",
        )
    return np.stack([bottoms[touched], tops[touched]], axis=1).astype(np.int32)
