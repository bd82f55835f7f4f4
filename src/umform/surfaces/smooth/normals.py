"""Normals at the corners of triangles, and the edges across which they jump."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import TurnedNormals
from umform.surfaces.joined import groups
from umform.surfaces.smooth.edges import Edges
from umform.surfaces.triangles import Floats, Ids, Triangles

#: Triangles with closer unit normals belong to one face; a face below this part of another's size is small.
_LEVEL, _SMALL = 1e-3, 0.25
#: Least cosine between a triangle and a normal at its corners: beyond 72 degrees a patch folds.
_LEAST_COSINE = 0.3


Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class Normals:
    """Normals of a surface at the corners of its triangles.

    Attributes
    ----------
    corner : ndarray, shape (m, 3, 3)
        Unit normal at each corner of each triangle.
    same : ndarray of bool, shape (3 m, 2)
        Whether both triangles at an edge have the same normal at its start and at its end.
    """

    corner: Floats
    same: Bools


def from_facets(surface: Triangles, edges: Edges, sharp: float, where: str) -> Normals:
    """Normals from the triangles around a point, without those beyond an edge. eq. (4.171)

    Parameters
    ----------
    surface : Triangles
        Points and triangles.
    edges : Edges
        How they hang together.
    sharp : float
        Angle between two triangles, in degrees, from which their edge is sharp.
    where : str
        For messages.
    """
    corners = surface.corners
    ahead, behind = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    weighted = np.cross(ahead, behind)
    weighted /= ((ahead**2).sum(axis=2) * (behind**2).sum(axis=2))[:, :, None]
    n = _unit(surface.area_vectors)
    joined = edges.mate >= 0
    triangle = np.arange(len(edges.mate)) // 3
    one, other = n[triangle[joined]], n[triangle[edges.mate[joined]]]
    level = joined.copy()
    level[joined] = np.linalg.norm(one - other, axis=1) < _LEVEL
    joined[joined] = np.einsum("ei,ei->e", one, other) > np.cos(np.radians(sharp))
    label = _groups(edges, joined)
    weighted[_small(surface, edges, level, label)] = 0.0
    return _averaged(surface, edges, weighted.reshape(-1, 3), label, where)


def _small(surface: Triangles, edges: Edges, level: Bools, label: Ids) -> Bools:
    """Corners, shape (m, 3), of faces that are much smaller than another one at the same point.

    Where a flange joins a fillet, or a long cylinder a small torus, the normal is that of the larger face: where the
    curvature is continuous, a tessellation makes triangles of one size.
    """
    triangle = np.flatnonzero(level) // 3
    count, face = groups(triangle, edges.mate[level] // 3, len(label) // 3)
    area = np.bincount(face, np.linalg.norm(surface.area_vectors, axis=1), count)[face].repeat(3)
    largest = np.zeros(int(label.max()) + 1)
    np.maximum.at(largest, label, area)
    return np.asarray(area < _SMALL * largest[label]).reshape(-1, 3)


def from_drawing(surface: Triangles, edges: Edges, corner: Floats, sharp: float, where: str) -> Normals:
    """Given normals at the corners of triangles; those that differ by less than ``sharp`` are merged."""
    n = corner.reshape(-1, 3)
    number = np.arange(len(n))
    end = np.where(number % 3 == 2, number - 2, number + 1)
    mate = edges.mate
    least = np.cos(np.radians(sharp))
    joined = mate >= 0
    j, m = number[joined], mate[joined]
    joined[joined] = (np.einsum("ei,ei->e", n[j], n[end[m]]) > least) & (np.einsum("ei,ei->e", n[end[j]], n[m]) > least)
    return _averaged(surface, edges, n, _groups(edges, joined), where)


def _groups(edges: Edges, joined: Bools) -> Ids:
    """Group of each corner around a point, connected by smooth edges, shape (3 m,)."""
    number = np.arange(len(edges.mate))
    end = np.where(number % 3 == 2, number - 2, number + 1)
    j, mate = number[joined], edges.mate[joined]
    one, other = np.concatenate([j, end[j]]), np.concatenate([end[mate], mate])
    return groups(one, other, len(number))[1]


def _averaged(surface: Triangles, edges: Edges, weighted: Floats, label: Ids, where: str) -> Normals:
    """One normal for all corners of a group."""
    number = np.arange(len(edges.mate))
    end = np.where(number % 3 == 2, number - 2, number + 1)
    count = int(label.max()) + 1
    sums = np.stack([np.bincount(label, weighted[:, k], count) for k in range(3)], axis=1)
    corner = _unit(sums.astype(float))[label].reshape(-1, 3, 3)
    _refuse_folds(surface, corner, where)
    return Normals(corner, _same(label, edges, end))


def _same(label: Ids, edges: Edges, end: Ids) -> Bools:
    """Whether the corners at both ends of an edge are connected around the point."""
    inner = edges.mate >= 0
    same = np.ones((len(label), 2), dtype=bool)
    same[inner, 0] = label[inner] == label[end[edges.mate[inner]]]
    same[inner, 1] = label[end[inner]] == label[edges.mate[inner]]
    return same


def _refuse_folds(surface: Triangles, corner: Floats, where: str) -> None:
    """Reject normals that point away from their triangles."""
    cosine = np.einsum("tci,ti->tc", corner, _unit(surface.area_vectors))
    if not (cosine > _LEAST_COSINE).all():
        t, c = np.argwhere(~(cosine > _LEAST_COSINE))[0]
        x = surface.corners[t, c]
        raise TurnedNormals(
            "a normal looks away from its triangle",
            where=where,
            value=f"{np.degrees(np.arccos(np.clip(cosine[t, c], -1, 1))):.3g} degrees at "
            f"({x[0]:.6g}, {x[1]:.6g}, {x[2]:.6g})",
            cause="triangles too coarse for their radius, folds, or a sharp edge that is taken for a smooth one",
            remedy="a finer tessellation, or a smaller angle from which edges are sharp",
        )


def _unit(v: Floats) -> Floats:
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(v / np.linalg.norm(v, axis=-1, keepdims=True))
