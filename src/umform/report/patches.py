"""Outer faces of elements, subdivided by their shape functions: the surface that PyVista and the browser draw.

A surface is matrices and numbers of nodes, made once for a mesh. Points, normals and colours of a frame are products of
these matrices and nodal values: `Surface.at` here, `Patches` of ``assets/surfaces.js`` in the browser.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.report.facets import CREASE, smooth_groups
from umform.report.part import HAIR
from umform.report.symmetry import Mirror

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Nodes of the lower face by rows along the second natural direction, and of its edges, outside on the right.
_LOWER = {8: np.array([[0, 1], [3, 2]]), 18: np.array([[0, 4, 1], [7, 8, 5], [3, 6, 2]])}
_EDGES = {
    8: np.array([[0, 1], [1, 2], [2, 3], [3, 0]]),
    18: np.array([[0, 4, 1], [1, 5, 2], [2, 6, 3], [3, 7, 0]]),
}


@dataclass(frozen=True)
class Patches:
    """Faces of one kind: nodes in rows and columns, points in the same order.

    Attributes
    ----------
    nodes : ndarray of int, shape (m, r, c)
        Nodes of the faces.
    owners : ndarray of int, shape (m,)
        Their elements.
    size : tuple of int
        Points along the sides, a and b.
    position, rows, columns : ndarray, shape (a b, r c)
        Shape functions at the points, and their slopes along both sides.
    middle : ndarray, shape (3, r c)
        The same in the middle of the face.
    corners : ndarray, shape (a b, 4)
        Bilinear weights of the corners, around.
    groups : ndarray of int, shape (m, 4)
        Corners with the same number have the same normal.
    inner : int
        The last of the faces that lie in planes of symmetry, inside the whole part.
    """

    nodes: Ids
    owners: Ids
    size: tuple[int, int]
    position: Floats
    rows: Floats
    columns: Floats
    middle: Floats
    corners: Floats
    groups: Ids
    inner: int = 0

    @classmethod
    def of(cls, nodes: Ids, owners: Ids, k: int) -> Patches:
        """Faces in k parts along each side; those across the thickness of quadratic elements only along it."""
        r, c = nodes.shape[1:]
        along = np.linspace(-1.0, 1.0, k + 1)
        ends = along if r == c else np.array([-1.0, 1.0])
        (A, dA), (B, dB) = _lagrange(r, ends), _lagrange(c, along)
        (a, da), (b, db) = _lagrange(r, np.zeros(1)), _lagrange(c, np.zeros(1))
        square = _kron(_lagrange(2, ends)[0], _lagrange(2, along)[0])[:, [0, 1, 3, 2]]
        middle = np.concatenate([_kron(a, b), _kron(da, b), _kron(a, db)])
        position = _kron(A, B)
        rows = _kron(dA, B)
        columns = _kron(A, dB)
        groups = np.zeros((len(nodes), 4), np.int64)  # until all faces are known
        return cls(nodes, owners, (len(ends), k + 1), position, rows, columns, middle, square, groups)

    @property
    def corner_nodes(self) -> Ids:
        """Corners (m, 4) of the faces, around."""
        n = self.nodes
        return np.stack([n[:, 0, 0], n[:, 0, -1], n[:, -1, -1], n[:, -1, 0]], axis=1)

    @property
    def corner_points(self) -> Ids:
        """The points of a face that are its corners, around."""
        a, b = self.size
        return np.array([0, b - 1, a * b - 1, a * b - b])

    def interpolated(self, weights: Floats, values: Floats) -> Floats:
        """Nodal values (n, c) by some of the matrices, shape (m, points, c)."""
        flat = self.nodes.reshape(len(self.nodes), -1)
        product: Floats = np.einsum("pn,mnc->mpc", weights, values[flat], optimize=True)
        return product

    def crosses(self, x: Floats) -> Floats:
        """Normals of the shape functions at the points (m, points, 3), as long as the area per natural area."""
        return np.cross(self.interpolated(self.columns, x), self.interpolated(self.rows, x))


@dataclass(frozen=True)
class Surface:
    """All outer faces: of the sheet first, then those across its thickness.

    Attributes
    ----------
    patches : tuple of Patches
        The kinds of faces.
    lines : tuple of ndarray of int, shape (l, s)
        Edges of the elements, each once, as points along them; those through the thickness are the last.
    seams : tuple of ndarray of int
        For each plane of symmetry the groups whose normal lies in it, since the mirror image goes on there.
    """

    patches: tuple[Patches, ...]
    lines: tuple[Ids, ...]
    seams: tuple[Ids, ...] = ()

    @classmethod
    def of(cls, reference: Floats, cells: Ids, k: int, planes: Sequence[Mirror] = ()) -> Surface:
        """The outer faces of a mesh in k parts along each side; what is smooth and what an edge follows from it."""
        kinds = [Patches.of(nodes, owners, k) for nodes, owners in _outer_faces(cells)]
        if planes:
            hair = HAIR * float(np.ptp(reference, axis=0).max())
            kinds[1] = _inner_last(kinds[1], reference, planes, hair)
        kinds = [kind for kind in kinds if len(kind.nodes)]
        own = np.concatenate([unit(kind.crosses(reference))[:, kind.corner_points] for kind in kinds])
        groups = smooth_groups(reference, np.concatenate([kind.corner_nodes for kind in kinds]), own)
        ends = np.cumsum([len(kind.nodes) for kind in kinds])[:-1]
        kinds = [replace(kind, groups=part) for kind, part in zip(kinds, np.split(groups, ends), strict=True)]
        surface = cls(tuple(kinds), _lines(kinds))
        return replace(surface, seams=tuple(surface._seam(reference, plane, hair) for plane in planes))

    @cached_property
    def starts(self) -> list[int]:
        """Number of the first point of each kind of faces, and that of all points."""
        return [0, *np.cumsum([len(kind.nodes) * len(kind.position) for kind in self.patches]).tolist()]

    @cached_property
    def quads(self) -> Ids:
        """Parts of the faces by their points, counter-clockwise from outside; shape (q, 4)."""
        found = []
        for start, kind in zip(self.starts, self.patches, strict=False):
            a, b = kind.size
            ids = start + np.arange(len(kind.nodes) * a * b).reshape(-1, a, b)
            sides = [ids[:, :-1, :-1], ids[:, :-1, 1:], ids[:, 1:, 1:], ids[:, 1:, :-1]]
            found.append(np.stack(sides, axis=-1).reshape(-1, 4))
        return np.concatenate(found)

    def at(self, x: Floats) -> tuple[Floats, Floats]:
        """Points and unit normals for positions (n, 3) of the nodes, each shape (p, 3).

        Neighbours have one normal at a common corner; the correction is spread over the face bilinearly.
        """
        crosses = [kind.crosses(x) for kind in self.patches]
        corners = [cross[:, kind.corner_points] for kind, cross in zip(self.patches, crosses, strict=True)]
        own, groups = np.concatenate(corners), np.concatenate([kind.groups for kind in self.patches]).ravel()
        total: Floats = np.stack([np.bincount(groups, own[:, :, c].ravel()) for c in range(3)], axis=1)
        change = unit(total)[groups].reshape(own.shape) - unit(own)
        points, normals, begun = [], [], 0
        for kind, cross in zip(self.patches, crosses, strict=True):
            part = change[begun : begun + len(cross)]
            begun += len(cross)
            points.append(kind.interpolated(kind.position, x).reshape(-1, 3))
            normals.append(unit(unit(cross) + np.einsum("pk,mkc->mpc", kind.corners, part)).reshape(-1, 3))
        return np.concatenate(points), np.concatenate(normals)

    def values(self, nodal: Floats, *, bilinear: bool) -> Floats:
        """A field at the points: by the shape functions, or bilinear between the corners of the faces; shape (p,)."""
        found = []
        for kind in self.patches:
            if bilinear:
                found.append((nodal[kind.corner_nodes] @ kind.corners.T).ravel())
            else:
                found.append(kind.interpolated(kind.position, nodal[:, None]).ravel())
        return np.concatenate(found)

    def middles(self, x: Floats) -> tuple[Floats, Floats]:
        """Middle of each face, and its normal times a quarter of the area; each shape (faces, 3)."""
        found = [kind.interpolated(kind.middle, x) for kind in self.patches]
        at = np.concatenate(found)
        return at[:, 0], np.cross(at[:, 2], at[:, 1])

    @property
    def owners(self) -> Ids:
        """Element of each face."""
        return np.concatenate([kind.owners for kind in self.patches])

    def _seam(self, reference: Floats, plane: Mirror, hair: float) -> Ids:
        found = []
        for kind in self.patches:
            on = np.abs(reference[kind.corner_nodes][..., plane.axis] - plane.at) <= hair
            across = unit(kind.crosses(reference))[:, kind.corner_points, plane.axis]
            found.append(kind.groups[on & (np.abs(across) < np.sin(np.radians(0.5 * CREASE)))])
        return np.unique(np.concatenate(found))


def _outer_faces(cells: Ids) -> list[tuple[Ids, Ids]]:
    """Faces of one element only, as rows of nodes whose rows turn left into columns, and their elements.

    First the faces of the sheet (m, n, n), then those across its thickness (m, 2, n).
    """
    half = cells.shape[1] // 2
    lower, edges = _LOWER[2 * half], _EDGES[2 * half]
    flat = cells[:, np.stack([lower.T, lower + half])].reshape(-1, *lower.shape)
    across = cells[:, np.stack([edges, edges + half], axis=1)].reshape(-1, 2, edges.shape[1])
    kinds = [flat, across]
    corners = np.concatenate([np.sort(nodes[:, [0, 0, -1, -1], [0, -1, -1, 0]], axis=1) for nodes in kinds])
    _, where, times = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    outer = np.split(times[where.reshape(-1)] == 1, [len(flat)])
    owners = [np.repeat(np.arange(len(cells)), 2), np.repeat(np.arange(len(cells)), 4)]
    return [(nodes[o], of[o]) for nodes, of, o in zip(kinds, owners, outer, strict=True)]


def _inner_last(kind: Patches, reference: Floats, planes: Sequence[Mirror], hair: float) -> Patches:
    """Faces across the thickness, those in planes of symmetry behind the others."""
    x = reference[kind.corner_nodes]
    inside = np.any([(np.abs(x[:, :, plane.axis] - plane.at) <= hair).all(axis=1) for plane in planes], axis=0)
    order = np.argsort(inside, kind="stable")
    return replace(kind, nodes=kind.nodes[order], owners=kind.owners[order], inner=int(inside.sum()))


def _lines(kinds: Sequence[Patches]) -> tuple[Ids, ...]:
    """Edges of the faces, each once: those along the sheet, then those through the thickness."""
    along: list[tuple[Ids, Ids]] = []
    through: list[tuple[Ids, Ids]] = []
    start = 0
    for kind in kinds:
        m, (a, b) = len(kind.nodes), kind.size
        r, c = kind.nodes.shape[1:]
        ids = start + np.arange(m * a * b).reshape(m, a, b)
        start += m * a * b
        of_sheet = kind is kinds[0]
        for end in (0, -1):
            along.append((kind.nodes[:, end], _ends_of_straight(ids[:, end], c)))
            (along if of_sheet else through).append((kind.nodes[:, :, end], _ends_of_straight(ids[:, :, end], r)))
    return tuple(_once(sides) for sides in (along, through) if sides)


def _ends_of_straight(points: Ids, nodes: int) -> Ids:
    """Points along sides; of a side of two nodes its ends."""
    return points[:, [0, -1]] if nodes == 2 else points


def _once(sides: Sequence[tuple[Ids, Ids]]) -> Ids:
    """Points along the sides of faces, one side of those with the same ends."""
    ends = np.sort(np.concatenate([nodes[:, [0, -1]] for nodes, _ in sides]), axis=1)
    _, first = np.unique(ends, axis=0, return_index=True)
    return np.concatenate([points for _, points in sides])[first]


def _kron(a: Floats, b: Floats) -> Floats:
    """Products of the rows of two matrices."""
    return np.asarray(np.kron(a, b), dtype=np.float64)


def _lagrange(count: int, at: Floats) -> tuple[Floats, Floats]:
    """Lagrange polynomials through two or three equal nodes in -1 ... 1, and their slopes, shape (points, nodes)."""
    one = np.ones_like(at)
    if count == 2:
        return np.stack([0.5 * (1 - at), 0.5 * (1 + at)], axis=1), np.stack([-0.5 * one, 0.5 * one], axis=1)
    values = np.stack([0.5 * at * (at - 1), 1 - at**2, 0.5 * at * (at + 1)], axis=1)
    return values, np.stack([at - 0.5, -2 * at, at + 0.5], axis=1)


def unit(vectors: Floats) -> Floats:
    """Vectors of unit length; zero remains zero."""
    size = np.linalg.norm(vectors, axis=-1, keepdims=True)
    found: Floats = np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0)
    return found
