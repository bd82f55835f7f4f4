"""Projection of values at contact points onto the shape functions of the face. docs/theory, 4.16

With more points than nodes, multipliers at the points have more modes than the face, and oscillate.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

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
