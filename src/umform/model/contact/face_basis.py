"""Values at contact points: projected onto the shape functions of the face (docs/theory, 4.16), and means at nodes.

With more points than nodes, multipliers at the points have more modes than the face, and oscillate.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from umform.mesh import FACE_NODES, Ids

Floats = NDArray[np.float64]


def in_face_basis(values: Floats, held: NDArray[np.bool_], area: Floats, N: Floats) -> Floats:
    """Least-squares fit of values by the shape functions of each face, over the held points.

    Parameters
    ----------
    values : ndarray, shape (faces * points,) or (faces * points, k)
        Values at the contact points.
    held : ndarray of bool, shape (faces * points,)
        Points in the fit.
    area : ndarray, shape (faces * points,)
        Their weights.
    N : ndarray, shape (1 or faces, points, nodes)
        Shape functions at the points of all faces, or of each.

    Returns
    -------
    ndarray, as values
        The fit at the held points, zero elsewhere; the values themselves if there are at most as many points as nodes.
    """
    points, nodes = N.shape[1:]
    flat = np.where(held[:, None], values.reshape(len(values), -1), 0.0)
    if points > nodes:
        faces = held.reshape(-1, points)
        some = faces.any(axis=1)
        root = np.sqrt(np.where(faces, area.reshape(-1, points), 0.0))[some]
        N = N if len(N) == 1 else N[some]
        weighted = root[:, :, None] * N
        wanted = root[:, :, None] * flat.reshape(-1, points, flat.shape[1])[some]
        fit = np.zeros((len(faces), points, flat.shape[1]))
        fit[some] = N @ (np.linalg.pinv(weighted) @ wanted)
        flat = np.where(held[:, None], fit.reshape(flat.shape), 0.0)
    answer: Floats = flat.reshape(values.shape)
    return answer


def mean_at_nodes(
    values: Floats, area: Floats, N: Floats, facets: Ids, count: int, add: Callable[[Floats], Floats]
) -> Floats:
    """Averages at nodes, weighted by areas and hat functions, which are not negative and have the sum one. eq. (4.38)

    Parameters
    ----------
    values : ndarray, shape (faces * points, k)
        Values at the contact points.
    area : ndarray, shape (faces * points,)
        Areas of the points.
    N : ndarray, shape (1 or faces, points, nodes)
        Shape functions at the points of all faces, or of each.
    facets : ndarray of int, shape (faces, nodes)
        Nodes of the faces.
    count : int
        Number of nodes of the mesh.
    add : callable
        Sums values at nodes, shape (count, k), over all that share the mesh.

    Returns
    -------
    ndarray, shape (count, k)
        Zero outside the faces.
    """
    places = len(facets), N.shape[1]
    weight = hat_functions(N) * area.reshape(*places, 1)  # [face][point][node]
    shares = np.zeros((count, values.shape[1] + 1))
    for column, part in enumerate([*values.T, np.ones(len(values))]):
        share = np.einsum("eqa,eq->ea", weight, part.reshape(places))
        shares[:, column] = np.bincount(facets.ravel(), share.ravel(), count)
    total = add(shares)
    whole = total[:, -1:]
    mean: Floats = np.divide(total[:, :-1], whole, out=np.zeros_like(total[:, :-1]), where=whole > 0)
    return mean


def hat_functions(N: Floats) -> Floats:
    """Piecewise bilinear functions between the nodes of a face, evaluated at the points of N.

    Parameters
    ----------
    N : ndarray, shape (..., nodes)
        Shape functions of a face of 4 or 9 nodes.

    Returns
    -------
    ndarray, shape (..., nodes)
        N itself on 4-node faces; on 9-node faces the hats (1 - |r - r_a|)(1 - |s - s_a|) of their four quarters.
    """
    if N.shape[-1] == 4:
        return N
    distance = np.abs((N @ FACE_NODES)[..., None, :] - FACE_NODES)
    hats: Floats = np.maximum(1.0 - distance, 0.0).prod(axis=-1)
    return hats
