"""Curved patches over triangles, in the form of the kernels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from umform import _core
from umform.surfaces.smooth.edges import Edges
from umform.surfaces.smooth.net import control_points
from umform.surfaces.smooth.normals import Normals
from umform.surfaces.triangles import Floats, Ids, Triangles

_SMOOTH, _SHARP, _RIM = 0, 1, 2
#: Exponents of the weights (a, b, c) of the 15 points of a patch.
_POWERS = np.array([(4 - row - i, i, row) for row in range(5) for i in range(5 - row)])
_FACTORIAL = np.array([1, 1, 2, 6, 24])
_COEFFICIENTS = 24 / _FACTORIAL[_POWERS].prod(axis=1)


@dataclass(frozen=True)
class Patches:
    """Smooth surface of thirds of triangles.

    Attributes
    ----------
    control : ndarray, shape (3 m, 15, 3)
        Points of the patches.
    across : ndarray of int, shape (3 m,)
        Across the edge of a third the surface is smooth (0), has an edge (1), or ends (2).
    neighbour : ndarray of int, shape (3 m,)
        Third on the other side, -1 at a rim.
    ends : ndarray of int, shape (3 m, 2)
        End points of the edge.
    normals : ndarray, shape (n, 3)
        Sum of the normals of the triangles around a point, by their angles there.
    corner : ndarray of int, shape (n,)
        The largest ``across`` of the edges that meet in a point.
    """

    control: Floats
    across: Ids
    neighbour: Ids
    ends: Ids
    normals: Floats
    corner: Ids

    def kernel(self, faces: Sequence[_core.Surface] = (), face: Ids | None = None, trust: float = 0.0) -> _core.Surface:
        """The surface as the kernels take it.

        Parameters
        ----------
        faces : sequence of Surface, optional
            Exact surfaces.
        face : ndarray of int, shape (3 m,), optional
            Exact surface of each third, -1 for none.
        trust : float
            Largest difference between the distances to a third and to its exact surface for which the exact one is
            used.
        """
        face = np.full(len(self.across), -1) if face is None else face
        across, neighbour, ends, of, corner = (
            np.ascontiguousarray(ids, dtype=np.int32)
            for ids in (self.across, self.neighbour, self.ends, face, self.corner)
        )
        return _core.triangulated(
            self.control, across, neighbour, ends, of, self.normals, corner, list(faces), float(trust)
        )

    def at(self, weights: Floats) -> Floats:
        """Points of all patches, shape (3 m, k, 3), at some weights of their corners, shape (k, 3)."""
        basis = (_COEFFICIENTS * (weights[:, None, :] ** _POWERS).prod(axis=2)) @ np.eye(15)
        return np.asarray(np.einsum("kc,pci->pki", basis, self.control))

    def at_triangles(self, weights: Floats) -> Floats:
        """Points on all triangles, shape (m, k, 3), at some weights of their corners, shape (k, 3)."""
        edge = (weights.argmin(axis=1) + 1) % 3  # the third opposite the corner of the least weight
        least = weights.min(axis=1)
        a, b = (np.take_along_axis(weights, ((edge + k) % 3)[:, None], axis=1)[:, 0] - least for k in (0, 1))
        points = self.at(np.stack([a, b, 3.0 * least], axis=1)).reshape(-1, 3, len(weights), 3)
        return points[:, edge, np.arange(len(weights))]

    def bulge(self) -> Floats:
        """Bound of the distances of the patches from the flat triangles of their corners, shape (3 m,)."""
        flat = np.einsum("cw,pwi->pci", _POWERS / 4.0, self.control[:, [0, 4, 14]])
        return np.asarray(np.linalg.norm(self.control - flat, axis=2).max(axis=1))

    def facets(self, parts: int) -> Triangles:
        """Flat triangles, each edge of a third divided into equal parts."""
        rows = [[(parts - j - i, i, j) for i in range(parts + 1 - j)] for j in range(parts + 1)]
        first = np.cumsum([0] + [len(row) for row in rows])
        triangles = []
        for j in range(parts):
            for i in range(parts - j):
                a, b, c = first[j] + i, first[j] + i + 1, first[j + 1] + i
                triangles.append((a, b, c))
                if i < parts - j - 1:
                    triangles.append((b, c + 1, c))
        points = self.at(np.array([w for row in rows for w in row]) / parts)
        ids = np.array(triangles) + points.shape[1] * np.arange(len(points))[:, None, None]
        return Triangles(points.reshape(-1, 3), ids.reshape(-1, 3))


def patches(surface: Triangles, edges: Edges, normals: Normals) -> Patches:
    """Curved patches through the points of triangles with the normals there."""
    rim = edges.mate < 0
    across = np.where(rim, _RIM, np.where(normals.same.all(axis=1), _SMOOTH, _SHARP))
    corner = np.zeros(len(surface.points), dtype=np.int64)
    np.maximum.at(corner, edges.start, across)
    np.maximum.at(corner, edges.end, across)
    return Patches(
        control_points(surface, edges, normals),
        across,
        edges.mate,
        np.stack([edges.start, edges.end], axis=1),
        _by_angle(surface),
        corner,
    )


def _by_angle(surface: Triangles) -> Floats:
    """Sum of unit normals around each point, times the angles of the triangles there (Baerentzen and Aanaes)."""
    corners = surface.corners
    ahead, behind = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    sine = np.linalg.norm(np.cross(ahead, behind), axis=2)
    angle = np.arctan2(sine, (ahead * behind).sum(axis=2))
    n = surface.area_vectors
    n = n / np.linalg.norm(n, axis=1, keepdims=True)
    weighted = (angle[:, :, None] * n[:, None, :]).reshape(-1, 3)
    ids = surface.triangles.ravel()
    return np.stack([np.bincount(ids, weighted[:, k], len(surface.points)) for k in range(3)], axis=1)
