"""Outline of the sheet before and after, and how far its edge was drawn in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Mesh, Selector

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Outline:
    """An edge of the sheet, seen along z.

    Attributes
    ----------
    before, after : ndarray, shape (n, 2)
        Places of the nodes (x, y), mean through the thickness, in the order of the angle before.
    draw_in : ndarray, shape (n,)
        Way of each node towards the inside, normal to the edge before; negative outwards.
    """

    before: Floats
    after: Floats
    draw_in: Floats

    @property
    def is_closed(self) -> bool:
        """Whether the edge goes around the sheet: its ends are as near to each other as its nodes."""
        steps = np.linalg.norm(np.diff(self.before, axis=0), axis=1)
        return bool(len(steps) > 2 and np.linalg.norm(self.before[0] - self.before[-1]) < 1.5 * steps.max())

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
        Nodes of the edge.

    Returns
    -------
    Outline
    """
    ids = mesh.nodes(edge)
    X, x = mesh.points[ids, :2], (mesh.points + u.reshape(-1, 3))[ids, :2]
    scale = np.ptp(mesh.points, axis=0).max()
    _, fibre = np.unique(np.round(X / (1e-6 * scale)), axis=0, return_inverse=True)
    fibre = fibre.ravel()
    count = np.bincount(fibre)
    before, after = (np.stack([np.bincount(fibre, y[:, k]) / count for k in (0, 1)], axis=1) for y in (X, x))
    order = _along(before, mesh.points[:, :2].mean(axis=0))
    before, after = before[order], after[order]
    ahead = np.gradient(before, axis=0) if len(before) > 1 else np.array([[0.0, 1.0]])
    inwards = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    inwards /= np.maximum(np.linalg.norm(inwards, axis=1, keepdims=True), 1e-300)
    inside = mesh.points[:, :2].mean(axis=0) - before
    inwards *= np.sign((inwards * inside).sum(axis=1, keepdims=True))
    return Outline(before, after, ((after - before) * inwards).sum(axis=1))


def _along(points: Floats, centre: Floats) -> NDArray[np.int64]:
    """Order of points of an edge: by the angle about the middle of the blank."""
    angle = np.arctan2(*(points - centre).T[::-1])
    order = np.argsort(angle)
    gaps = np.diff(angle[order], append=angle[order[0]] + 2.0 * np.pi)
    return np.roll(order, -(int(np.argmax(gaps)) + 1))
