"""Positions of the points of integration of a body."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.mesh import FACE_NODES
from umform.model import Body

Floats = NDArray[np.float64]


def positions(body: Body, heights: Floats, u: Floats, deformed: bool) -> Floats:
    """Positions of the points of a body, undeformed or at a displacement, shape (cells, points, 3). eq. (1.2)"""
    along_r, along_s = (np.polynomial.legendre.leggauss(count)[0] for count in body.element.surface_rule)
    s, r = (grid.ravel() for grid in np.meshgrid(along_s, along_r, indexing="ij"))
    half = body.connectivity.shape[1] // 2
    N = _face_shapes(np.stack([r, s], axis=1), FACE_NODES[:half])
    nodes = body.mesh.points + (u.reshape(-1, 3) if deformed else 0.0)
    lower, upper = (N @ nodes[ids] for ids in np.split(body.connectivity, 2, axis=1))  # (cells, columns, 3)
    t = heights.T[:, :, None]
    places = 0.5 * (1.0 - t) * lower[:, None] + 0.5 * (1.0 + t) * upper[:, None]
    whole: Floats = places.reshape(len(places), -1, 3)
    return whole


def _face_shapes(at: Floats, nodes: Floats) -> Floats:
    """Shape functions (points, nodes) of a face of 4 or 9 nodes at natural coordinates (points, 2)."""
    z, z_a = at[:, None, :], nodes[None]
    if len(nodes) == 4:
        each: Floats = 0.5 * (1.0 + z * z_a)
    else:
        each = np.where(z_a == 0.0, 1.0 - z * z, 0.5 * z * (z + z_a))
    shapes: Floats = np.prod(each, axis=2)
    return shapes
