"""Group the corners of faces for a renderer: bends look smooth, edges sharp."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.mesh.neighbours import connected

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Faces that meet at a larger angle have an edge between them, in degrees.
CREASE = 35.0


def smooth_groups(points: Floats, faces: Ids, normals: Floats | None = None) -> Ids:
    """Groups of the corners of faces that share a normal.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Positions.
    faces : ndarray of int, shape (m, k)
        Triangles or quadrilaterals, counter-clockwise from outside.
    normals : ndarray, shape (m, k, 3), optional
        Unit normals of curved faces at their corners; otherwise faces are flat.

    Returns
    -------
    ndarray of int, shape (m, k)
        Number of the group of each corner, from 0. Corners at one point are in one group if their faces are neighbours
        over an edge that bends by less than the crease angle, directly or through others.
    """
    m, k = faces.shape
    corner = np.arange(m * k).reshape(m, k)
    following = np.roll(np.arange(k), -1)
    ends = np.stack([faces, faces[:, following]], axis=-1).reshape(-1, 2)
    ids = np.stack([corner, corner[:, following]], axis=-1).reshape(-1, 2)
    turned = ends[:, 0] > ends[:, 1]
    ends[turned], ids[turned] = ends[turned, ::-1], ids[turned, ::-1]
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    one, other = order[:-1], order[1:]
    met = (ends[one] == ends[other]).all(axis=1)
    one, other = one[met], other[met]
    links = np.stack([ids[one], ids[other]], axis=-1).reshape(-1, 2)
    own = (np.repeat(unit_normals(points, faces), k, axis=0) if normals is None else normals.reshape(-1, 3))[links]
    flat = np.einsum("ei,ei->e", own[:, 0], own[:, 1]) > np.cos(np.radians(CREASE))
    links = links[flat]
    return connected(m * k, links).reshape(m, k)


def unit_normals(points: Floats, faces: Ids) -> Floats:
    """Unit normals of faces, shape (m, 3); zero for a face without area."""
    x = points[faces]
    area = np.cross(x[:, 2] - x[:, 0], x[:, -1] - x[:, 1])
    size = np.linalg.norm(area, axis=1, keepdims=True)
    normals: Floats = np.divide(area, size, out=np.zeros_like(area), where=size > 0)
    return normals
