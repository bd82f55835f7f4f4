"""Deviation of a released part from the shape that it should have, along the normal of that shape."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Mesh, Selector
from umform.report.symmetry import Mirror, with_images
from umform.results.forming import lay_by_best_fit

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Sides of an element are divided into so many parts for the distance from it.
_PARTS = 8
#: Corners of the parts of a face with 9 nodes.
_NINE = np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]])
#: Distance from a plane of symmetry that counts as zero, relative to the size of the sheet.
_HAIR = 1e-6
#: Corrections of the place of a part in which the deviations are least; rigid motions that they do not determine.
_CORRECTIONS, _UNKNOWN = 3, 1e-6

#: Positions (n, 3) -> distances along the outward normal of the face (n,), normals (n, 3).
Gap = Callable[[Floats], tuple[Floats, Floats]]


@dataclass(frozen=True)
class SmoothFace:
    """Lower or upper faces of a sheet in some state as a smooth surface.

    Between the nodes it is curved such that circles are met to third order. eq. (5.173)

    Attributes
    ----------
    nodes : ndarray of int, shape (n,)
        Nodes of the faces.
    points, normals : ndarray, shape (n, 3)
        Their places and the outward normals there.
    samples, directions : ndarray, shape (m, 3)
        Places of the surface and its normals there.
    """

    nodes: Ids
    points: Floats
    normals: Floats
    samples: Floats
    directions: Floats

    @classmethod
    def of(cls, mesh: Mesh, faces: Selector, places: Floats, planes: Sequence[Mirror] = ()) -> SmoothFace:
        """The faces of a set.

        Parameters
        ----------
        mesh : Mesh
            The mesh.
        faces : str, callable or array_like
            Lower or upper faces, as for a contact.
        places : ndarray, shape (n, 3)
            Places of all its nodes.
        planes : sequence of Mirror
            Planes of symmetry.
        """
        facets = mesh.facets(faces).astype(np.int64)
        quads = facets if facets.shape[1] == 4 else facets[:, _NINE].reshape(-1, 4)
        nodes, ids = np.unique(quads, return_inverse=True)
        quads, points = ids.reshape(-1, 4), places[nodes]
        normals = _normals(points, quads)
        for plane in planes:
            at = np.abs(points[:, plane.axis] - plane.at) < _HAIR * np.ptp(points, axis=0).max()
            normals[at, plane.axis] = 0.0
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        a = (np.arange(_PARTS + 1)) / _PARTS
        r, s = (one.ravel() for one in np.meshgrid(a, a))
        N = np.stack([(1 - r) * (1 - s), r * (1 - s), r * s, (1 - r) * s], axis=1)
        corners, n = points[quads], normals[quads]  # (k, 4, 3)
        flat, direction = np.einsum("qa,kai->kqi", N, corners), np.einsum("qa,kai->kqi", N, n)
        # half of the mean of the projections onto the tangent planes of the corners
        height = np.einsum("kqai,kai->kqa", flat[:, :, None] - corners[:, None], n)
        curved = flat - 0.5 * np.einsum("qa,kqa,kai->kqi", N, height, n)
        direction /= np.linalg.norm(direction, axis=2)[:, :, None]
        return cls(nodes, points, normals, curved.reshape(-1, 3), direction.reshape(-1, 3))

    def gap(self, x: Floats) -> tuple[Floats, Floats]:
        """Distances of some places (n, 3) along the normal, and the normals (n, 3)."""
        from scipy.spatial import cKDTree

        _, near = cKDTree(self.samples).query(x)
        n = self.directions[near]
        return np.einsum("ni,ni->n", x - self.samples[near], n), n


def deviations(x: Floats, wanted: Floats, gap: Gap, planes: Sequence[Mirror] = ()) -> Floats:
    """Deviations of the nodes of a face, which is laid as a rigid body such that the sum of their squares is least.

    Parameters
    ----------
    x : ndarray, shape (n, 3)
        Places of the nodes.
    wanted : ndarray, shape (n, 3)
        Where they should be, to begin with.
    gap : callable
        Distance from the wanted shape and its normal.
    planes : sequence of Mirror
        Planes of symmetry of the part, which is laid as a whole.

    Returns
    -------
    ndarray, shape (n,)
        Along the normal of the wanted shape. eq. (5.174)
    """
    count = len(x)
    folds = [np.ones((1, 3))]
    for plane in planes:
        sign = np.ones(3)
        sign[plane.axis] = -1.0
        folds.append(np.concatenate(folds) * sign)
    signs = np.repeat(np.concatenate(folds), count, axis=0)
    whole = lay_by_best_fit(with_images(x, planes), with_images(wanted, planes)).points
    centre = whole.mean(axis=0)
    size = np.linalg.norm(whole - centre, axis=1).max()
    for correction in range(_CORRECTIONS + 1):
        d, n = gap(whole[:count])
        d, n = np.tile(d, len(signs) // count), np.tile(n, (len(signs) // count, 1)) * signs
        if correction == _CORRECTIONS:
            break
        motions = np.concatenate([n, np.cross((whole - centre) / size, n)], axis=1)
        step = np.linalg.lstsq(motions, -d, rcond=_UNKNOWN)[0]
        whole = whole + step[:3] + np.cross(step[3:] / size, whole - centre)
    return d[:count]


def _normals(points: Floats, quads: Ids) -> Floats:
    """Unit normals at the nodes: means of those of the faces, at an edge that of the circle from the node within."""
    a, b, c, d = np.moveaxis(points[quads], 1, 0)
    area = np.cross(c - a, d - b)
    normals = np.zeros_like(points)
    for corner in quads.T:
        np.add.at(normals, corner, area)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    count = np.bincount(quads.ravel())
    ends = np.concatenate([quads[:, [k, (k + way) % 4]] for k in range(4) for way in (1, 3)])
    outer, inner = ends[count[ends[:, 0]] < count[ends[:, 1]]].T
    for level in sorted(set(count[outer].tolist()), reverse=True):
        at, to = outer[count[outer] == level], inner[count[outer] == level]
        chord = points[at] - points[to]
        chord /= np.linalg.norm(chord, axis=1)[:, None]
        mirrored = normals[to] - 2.0 * np.einsum("ni,ni->n", normals[to], chord)[:, None] * chord
        normals[at] = 0.0
        np.add.at(normals, at, mirrored)
        normals[at] /= np.linalg.norm(normals[at], axis=1)[:, None]
    return normals
