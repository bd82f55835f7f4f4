"""Outline of the sheet before and after, and how far its edge was drawn in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.mesh import Mesh, Selector
from umform.mesh.neighbours import connected
from umform.results.shape import outer_quads

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

#: Cosine of half the angle between two sides from which they meet in a corner.
_CORNER = np.cos(np.radians(30.0))


@dataclass(frozen=True)
class Outline:
    """An edge of the sheet, seen along z.

    Attributes
    ----------
    before, after : ndarray, shape (n, 2)
        Places of the nodes (x, y), mean through the thickness, piece by piece, with the sheet on the left.
    draw_in : ndarray, shape (n,)
        Way of each node towards the inside, normal to the edge before; negative outwards.
    piece : ndarray of int, shape (n,)
        The connected piece of the edge to which each node belongs, from 0.
    closed : ndarray of bool, shape (pieces,)
        Whether a piece goes around the sheet or a hole.
    """

    before: Floats
    after: Floats
    draw_in: Floats
    piece: Numbers
    closed: NDArray[np.bool_]

    @property
    def is_closed(self) -> bool:
        """Whether all pieces are closed."""
        return bool(self.closed.all())

    @property
    def pieces(self) -> list[Numbers]:
        """Nodes of each piece."""
        return [np.flatnonzero(self.piece == k) for k in range(len(self.closed))]

    @property
    def lengths(self) -> Floats:
        """Length of the edge before that belongs to each node: half of both sides beside it."""
        own = np.zeros(len(self.before))
        for nodes, closed in zip(self.pieces, self.closed, strict=True):
            ends = np.append(nodes, nodes[0]) if closed else nodes
            half = 0.5 * np.linalg.norm(np.diff(self.before[ends], axis=0), axis=1)
            np.add.at(own, ends[:-1], half)
            np.add.at(own, ends[1:], half)
        return own

    def mean(self, piece: Numbers | slice = slice(None)) -> float:
        """Mean draw-in along the edge, or along one of its pieces."""
        return float(np.average(self.draw_in[piece], weights=self.lengths[piece]))

    def columns(self) -> dict[str, Floats]:
        """Columns of a table."""
        names = ("x_before", "y_before", "x", "y", "draw_in")
        return dict(zip(names, [*self.before.T, *self.after.T, self.draw_in], strict=True))


def draw_in(mesh: Mesh, u: Floats, edge: Selector = "rim") -> Outline:
    """How far an edge of the sheet was drawn in. eq. (5.66)

    Parameters
    ----------
    mesh : Mesh
        Undeformed blank, flat in x and y.
    u : ndarray, shape (n, 3) or (3 n,)
        Displacement of the nodes.
    edge : str, callable or array_like
        Nodes of the edge; of one piece or several.

    Returns
    -------
    Outline

    Raises
    ------
    InvalidValue
        If a node is inside of the sheet, or no other one of the edge is beside it.
    """
    half = mesh.connectivity.shape[1] // 2
    cells = mesh.connectivity.astype(np.int64)
    fibre = connected(len(mesh.points), np.stack([cells[:, :half].ravel(), cells[:, half:].ravel()], axis=1))
    levels = np.bincount(fibre)
    before, after = (
        np.stack([np.bincount(fibre, y[:, k]) / levels for k in (0, 1)], axis=1)
        for y in (mesh.points, mesh.displaced(u))
    )
    chosen = np.zeros(len(levels), dtype=bool)
    chosen[fibre[mesh.nodes(edge)]] = True
    sides = _sides(mesh, cells, fibre, before)
    sides = sides[chosen[sides].all(axis=1)]
    lost = np.setdiff1d(np.flatnonzero(chosen), sides)
    if len(lost):
        x, y = before[lost[0]]
        raise InvalidValue(
            "nodes are no edge of the sheet",
            where="edge",
            value=f"{len(lost)} of {int(chosen.sum())} places, the first at ({x:.4g}, {y:.4g})",
            cause="a selection with nodes inside of the sheet, or a single node",
            remedy="a set of the edge, such as rim or x1, or a box around nodes of the edge",
        )
    order, piece, closed = _chains(sides)
    along = before[sides[:, 1]] - before[sides[:, 0]]
    inwards = np.zeros_like(before)
    for end in (0, 1):
        np.add.at(inwards, sides[:, end], np.stack([-along[:, 1], along[:, 0]], axis=1))
    inwards = inwards[order] / np.linalg.norm(inwards[order], axis=1, keepdims=True)
    for k in np.flatnonzero(~closed):
        nodes = np.flatnonzero(piece == k)
        for last, beside in (nodes[[0, 1]], nodes[[-1, -2]]):
            _bend_on(inwards, last, beside)
    way = ((after - before)[order] * inwards).sum(axis=1)
    return Outline(before[order], after[order], way, piece, closed)


def _bend_on(inwards: Floats, last: int, beside: int) -> None:
    """Turn the normal of the last node of an edge, which is that of one side, as far as the edge bends there."""
    side, next_to = inwards[last], inwards[beside]
    if (same := float(side @ next_to)) > _CORNER:
        inwards[last] = 2.0 * same * side - next_to


def _sides(mesh: Mesh, cells: Numbers, fibre: Numbers, places: Floats) -> Numbers:
    """Sides of the sheet as pairs of fibres, shape (n, 2), with the sheet on the left."""
    quads = outer_quads(cells)[0]
    fibres = np.sort(fibre[quads], axis=1)
    lateral = (fibres[:, 0] == fibres[:, 1]) & (fibres[:, 2] == fibres[:, 3])
    quads, ends = quads[lateral], fibres[lateral][:, [0, 2]]
    corners = mesh.points[quads]
    outwards = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    along = places[ends[:, 1]] - places[ends[:, 0]]
    back = along[:, 1] * outwards[:, 0] < along[:, 0] * outwards[:, 1]
    ends[back] = ends[back][:, ::-1]
    sides: Numbers = np.unique(ends, axis=0)  # one for all layers
    return sides


def _chains(sides: Numbers) -> tuple[Numbers, Numbers, NDArray[np.bool_]]:
    """Fibres of the sides in their order, the pieces to which they belong, and which pieces are closed."""
    following = dict(sides.tolist())
    starts = np.concatenate([np.setdiff1d(sides[:, 0], sides[:, 1]), np.sort(sides[:, 0])]).tolist()
    chains: list[list[int]] = []
    seen: set[int] = set()
    for start in starts:  # ends of open pieces first
        chain, at = [], start
        while at is not None and at not in seen:
            chain.append(at)
            seen.add(at)
            at = following.get(at)
        chains += [chain] if chain else []
    closed = np.array([following.get(chain[-1]) == chain[0] for chain in chains])
    return np.concatenate(chains), np.repeat(np.arange(len(chains)), [len(chain) for chain in chains]), closed
