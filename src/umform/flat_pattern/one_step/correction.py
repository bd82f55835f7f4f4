"""A blank corrected by an incremental run: the wanted outline mapped back through the deformation of the run."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.flat_pattern.one_step.reading import mid_surface
from umform.mesh import Mesh

Floats = NDArray[np.float64]

#: Triangles around a point that are tried.
_NEAR = 16
#: Distance of the wanted outline from the formed sheet over the size of the part beyond which nothing is extrapolated.
_FAR = 0.15


def corrected_blank(mesh: Mesh, u: Floats, wanted: ArrayLike) -> Floats:
    """Outline of the blank whose edge is formed to a wanted outline, from a run with another blank. eq. (6.16)

    Each wanted point lies on a triangle of the formed mid-surface, or beside the nearest one, whose deformation is
    extrapolated; its material is the point of the blank. Removed or added metal changes the draw-in, so the corrected
    blank is run again; see docs/blank.md for what is left.

    Parameters
    ----------
    mesh : Mesh
        Undeformed blank of the run, flat in x and y, one layer of cells.
    u : ndarray, shape (n, 3) or (3 n,)
        Displacement of its nodes at the end of the stroke.
    wanted : array_like, shape (k, 3) or (k, 2)
        Points of the wanted outline of the formed part; without z the part is seen along z, as a flange is.

    Returns
    -------
    ndarray, shape (k, 2)
        The points in the blank.

    Raises
    ------
    InvalidValue
        If a wanted point is far from the formed sheet.

    Examples
    --------
    >>> import numpy as np
    >>> import umform as uf
    >>> sheet = uf.mesh.strip(40.0, 10.0, 1.0, (8, 2))
    >>> stretched = 0.1 * sheet.points * [1.0, 0.0, 0.0]
    >>> uf.corrected_blank(sheet, stretched, [[33.0, 5.0], [46.2, 5.0]]).round(3).tolist()
    [[30.0, 5.0], [42.0, 5.0]]
    """
    from scipy.spatial import cKDTree  # slow to import

    points = np.asarray(wanted, dtype=float)
    axes = points.shape[1]
    formed, flat = mid_surface(mesh, u), mid_surface(mesh, np.zeros_like(mesh.points)).points[:, :2]
    x = formed.points[:, :axes]
    corners = x[formed.triangles]
    near = cKDTree(corners.mean(axis=1)).query(points, k=min(_NEAR, len(corners)))[1].reshape(len(points), -1)
    a, b, c = np.moveaxis(corners[near], 2, 0)
    e, f, d = b - a, c - a, points[:, None] - a
    ee, ef, ff = ((p * q).sum(axis=2) for p, q in ((e, e), (e, f), (f, f)))
    de, df = (d * e).sum(axis=2), (d * f).sum(axis=2)
    det = np.maximum(ee * ff - ef * ef, 1e-300)
    s, t = (ff * de - ef * df) / det, (ee * df - ef * de) / det
    outside = np.maximum(np.maximum(-s, -t), s + t - 1.0)
    size = np.sqrt(np.maximum(ee, ff))
    off = np.linalg.norm(d - s[..., None] * e - t[..., None] * f, axis=2)
    far = np.hypot(np.maximum(outside, 0.0) * size, off)
    best = far.argmin(axis=1)
    row = np.arange(len(points))
    largest = float(far[row, best].max())
    if largest > _FAR * float(np.ptp(x, axis=0).max()):
        worst = int(far[row, best].argmax())
        raise InvalidValue(
            "the wanted outline is far from the formed sheet",
            where=f"point {worst} of the outline",
            value=f"{largest:.4g} away",
            cause="another position or unit, or a blank that is much too small",
            remedy="the outline in the coordinates and the unit of the run; begin with the blank of uf.blank",
        )
    chosen = flat[formed.triangles[near[row, best]]]
    s, t = s[row, best, None], t[row, best, None]
    return np.asarray(chosen[:, 0] + s * (chosen[:, 1] - chosen[:, 0]) + t * (chosen[:, 2] - chosen[:, 0]))


def distance_to_outline(points: ArrayLike, outline: ArrayLike) -> Floats:
    """Distance of points from a polyline, both of shape (n, 2) or (n, 3)."""
    x, line = np.asarray(points, dtype=float), np.asarray(outline, dtype=float)
    a, e = line[:-1], np.diff(line, axis=0)
    t = np.clip(((x[:, None] - a) * e).sum(axis=2) / np.maximum((e * e).sum(axis=1), 1e-300), 0.0, 1.0)
    return np.asarray(np.linalg.norm(x[:, None] - a - t[..., None] * e, axis=2).min(axis=1))
