"""Distance of points from a free-form face, from known places nearby."""

from __future__ import annotations

import numpy as np

from umform.surfaces.cad.opencascade import Face
from umform.surfaces.triangles import Floats

_STEPS = 5


def distances(face: Face, x: Floats, uv: Floats) -> Floats:
    """Distances of points to the surface of a face, from initial parameters of their feet.

    Parameters
    ----------
    face : Face
        The face.
    x : ndarray, shape (n, 3)
        Points near it.
    uv : ndarray, shape (n, 2)
        Parameters of places near to the points.

    Returns
    -------
    ndarray, shape (n,)
        Shortest of the distances at which Gauss-Newton and Newton iterations arrive.
    """
    best = np.full(len(x), np.inf)
    low, high = face.uv.min(axis=0), face.uv.max(axis=0)
    for _ in range(_STEPS):
        S, du, dv = face.derivatives(uv)
        d = x - S
        best = np.minimum(best, np.linalg.norm(d, axis=1))
        a, b, c = ((p * q).sum(axis=1) for p, q in ((du, du), (du, dv), (dv, dv)))
        e, f = (d * du).sum(axis=1), (d * dv).sum(axis=1)
        det = a * c - b * b
        regular = det > 1e-12 * a * c
        with np.errstate(invalid="ignore", divide="ignore"):
            step = np.stack([(c * e - b * f) / det, (a * f - b * e) / det], axis=1)
        uv = np.clip(uv + np.where(regular[:, None], step, 0.0), low, high)
    return best
