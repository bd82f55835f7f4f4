"""The skin of a formed part for renderers: its outer faces, subdivided by the shape functions of the elements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.report.facets import smooth_groups
from umform.report.symmetry import Mirror

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Distance of nodes from a plane of symmetry that counts as zero, as a part of the size of the sheet.
_HAIR = 1e-7
#: Largest number of parts of a face along a side, and about how many parts all faces have.
_FINE, _PARTS = 6, 300_000
#: Nodes of the lower face by rows along the second natural direction, and of its edges, outside on the right.
_LOWER = {8: np.array([[0, 1], [3, 2]]), 18: np.array([[0, 4, 1], [7, 8, 5], [3, 6, 2]])}
_EDGES = {
    8: np.array([[0, 1], [1, 2], [2, 3], [3, 0]]),
    18: np.array([[0, 4, 1], [1, 5, 2], [2, 6, 3], [3, 7, 0]]),
}
#: Nodes of the lower face after a reflection of the first natural direction.
_REFLECTED = {8: np.array([1, 0, 3, 2]), 18: np.array([1, 0, 3, 2, 4, 7, 6, 5, 8])}


@dataclass(frozen=True)
class Part:
    """A sheet in one frame.

    Attributes
    ----------
    reference, points : ndarray, shape (n, 3)
        Positions of the nodes before and after.
    cells : ndarray of int, shape (m, 8) or (m, 18)
        Nodes of the elements.
    nodal, cellwise : dict of str to ndarray
        Fields at the nodes and of the cells: scalars, and vectors with three components.
    tensors : tuple of str
        Fields that are left out.
    """

    reference: Floats
    points: Floats
    cells: Ids
    nodal: dict[str, Floats]
    cellwise: dict[str, Floats]
    tensors: tuple[str, ...] = ()

    @classmethod
    def deformed(cls, X: Floats, cells: Ids, nodal: Mapping[str, Floats], cellwise: Mapping[str, Floats]) -> Part:
        """A mesh with the fields of a frame; tensors are left out, vectors at the nodes become their lengths."""
        scalars = {}
        for name, values in nodal.items():
            if values.ndim == 1:
                scalars[name] = np.asarray(values, dtype=float)
            elif values.shape[1] == 3:
                scalars[name] = np.linalg.norm(values, axis=1)
        kept = {name: np.asarray(a, float) for name, a in cellwise.items() if a.ndim == 1 or a.shape[1] == 3}
        x = X + nodal["displacement"] if "displacement" in nodal else X
        left_out = tuple(name for name in (*nodal, *cellwise) if name not in scalars and name not in kept)
        return cls(X, np.asarray(x, dtype=float), np.asarray(cells, dtype=np.int64), scalars, kept, left_out)

    def whole(self, planes: Sequence[Mirror]) -> Part:
        """The part together with its mirror images: nodes in a plane are shared, and no face is left there."""
        part = self
        for plane in planes:
            part = part._with_image(plane)
        return part

    def _with_image(self, plane: Mirror) -> Part:
        """The part and its image at a plane."""
        n, k = len(self.reference), plane.axis
        off = np.abs(self.reference[:, k] - plane.at) > _HAIR * np.ptp(self.reference, axis=0).max()
        image = np.where(off, n + np.cumsum(off) - 1, np.arange(n))
        lower = _REFLECTED[self.cells.shape[1]]
        order = np.concatenate([lower, lower + len(lower)])
        x = self.points.copy()
        x[~off, k] = plane.at
        sign = np.where(np.arange(3) == k, -1.0, 1.0)
        return Part(
            np.concatenate([self.reference, plane.image(self.reference)[off]]),
            np.concatenate([x, plane.image(x)[off]]),
            np.concatenate([self.cells, image[self.cells[:, order]]]),
            {name: np.concatenate([values, values[off]]) for name, values in self.nodal.items()},
            {name: np.concatenate([a, a * sign if a.ndim > 1 else a]) for name, a in self.cellwise.items()},
            self.tensors,
        )

    def stretched(self, axis: int, width: float) -> Part:
        """The part with another width along an axis: sheet in plane strain, which is the same in each section."""
        low, size = self.reference[:, axis].min(), np.ptp(self.reference[:, axis])
        scaled = [self.reference.copy(), self.points.copy()]
        for x in scaled:
            x[:, axis] = (x[:, axis] - low) * width / size - 0.5 * width
        return replace(self, reference=scaled[0], points=scaled[1])

    def at_corners(self, name: str) -> Floats:
        """A field at the nodes; at corners of elements the mean of a field of the cells, NaN at other nodes."""
        if name in self.nodal:
            return self.nodal[name]
        values = self.cellwise[name]
        corners = np.concatenate([self.cells[:, :4], self.cells[:, self.cells.shape[1] // 2 :][:, :4]], axis=1)
        known = np.isfinite(values)
        count = np.bincount(corners[known].ravel(), minlength=len(self.points))
        total = np.bincount(corners[known].ravel(), np.repeat(values[known], 8), minlength=len(self.points))
        means: Floats = np.divide(total, count, out=np.full(len(self.points), np.nan), where=count > 0)
        return means


@dataclass(frozen=True)
class Skin:
    """Subdivided outer faces of a part; each face has its own points, those of neighbours coincide.

    Attributes
    ----------
    points, normals : ndarray, shape (p, 3)
        Points on the faces, and unit normals, smooth between faces but not over edges of the sheet.
    quads : ndarray of int, shape (q, 4)
        Parts of the faces, counter-clockwise from outside.
    values : ndarray, shape (p,) or None
        A field at the points.
    lines : list of ndarray, shape (l, s, 3)
        Edges of the elements, each once, as points along them; straight edges apart from curved ones.
    middles, directions, areas : ndarray
        Of each face: middle, unit normal, and area by one Gauss point.
    owners : ndarray of int
        Element of each face.
    """

    points: Floats
    normals: Floats
    quads: Ids
    values: Floats | None
    lines: list[Floats]
    middles: Floats
    directions: Floats
    areas: Floats
    owners: Ids


def skin_of(part: Part, field: str | None = None, parts: int | None = None) -> Skin:
    """Subdivide the outer faces of a part.

    Parameters
    ----------
    part : Part
        The sheet.
    field : str, optional
        Scalar field: nodal values are interpolated by the shape functions, means of cells at corners bilinearly.
    parts : int, optional
        Parts of a face along its sides; default: up to 6, fewer for many faces.
    """
    faces, owners = _outer_faces(part.cells)
    count = sum(map(len, faces))
    k = parts or int(np.clip(np.sqrt(_PARTS / max(count, 1)), 1, _FINE))
    at = None if field is None else part.at_corners(field)
    smooth = field is not None and field not in part.nodal
    patches = [_patch(part.points, nodes, k, at, bilinear=smooth) for nodes in faces if len(nodes)]
    _smooth(part.points, [nodes for nodes in faces if len(nodes)], patches)
    points, normals, quads, values, middles, directions, areas, begun = [], [], [], [], [], [], [], 0
    for patch in patches:
        m, a, b, _ = patch.x.shape
        ids = begun + np.arange(m * a * b).reshape(m, a, b)
        begun += m * a * b
        parts_of = [ids[:, :-1, :-1], ids[:, :-1, 1:], ids[:, 1:, 1:], ids[:, 1:, :-1]]
        quads.append(np.stack(parts_of, axis=-1).reshape(-1, 4))
        points.append(patch.x.reshape(-1, 3))
        normals.append(_unit(patch.normals).reshape(-1, 3))
        middles.append(patch.middle[0])
        size = np.linalg.norm(patch.middle[1], axis=1)
        areas.append(4.0 * size)
        directions.append(_unit(patch.middle[1]))
        if patch.values is not None:
            values.append(patch.values.ravel())
    return Skin(
        np.concatenate(points),
        np.concatenate(normals),
        np.concatenate(quads),
        np.concatenate(values) if values else None,
        _lines(part.points, faces, k),
        np.concatenate(middles),
        np.concatenate(directions),
        np.concatenate(areas),
        np.concatenate([one for one in owners if len(one)]),
    )


@dataclass
class _Patch:
    """Subdivided faces of one kind."""

    x: Floats  # (m, a, b, 3)
    normals: Floats  # (m, a, b, 3), not of unit length
    values: Floats | None  # (m, a, b)
    middle: tuple[Floats, Floats]  # position and normal times a quarter of the area


def _outer_faces(cells: Ids) -> tuple[list[Ids], list[Ids]]:
    """Faces of one element only, as rows of nodes whose rows turn left into columns, and their elements.

    First the faces of the sheet (m, n, n), then those across its thickness (m, 2, n).
    """
    half = cells.shape[1] // 2
    lower, edges = _LOWER[2 * half], _EDGES[2 * half]
    flat = cells[:, np.stack([lower.T, lower + half])].reshape(-1, *lower.shape)
    across = cells[:, np.stack([edges, edges + half], axis=1)].reshape(-1, 2, edges.shape[1])
    kinds = [flat, across]
    corners = np.concatenate([np.sort(_corners(nodes), axis=1) for nodes in kinds])
    _, where, times = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    outer = np.split(times[where.reshape(-1)] == 1, [len(flat)])
    owners = [np.repeat(np.arange(len(cells)), 2), np.repeat(np.arange(len(cells)), 4)]
    return [nodes[o] for nodes, o in zip(kinds, outer, strict=True)], [
        of[o] for of, o in zip(owners, outer, strict=True)
    ]


def _corners(nodes: Ids) -> Ids:
    """Corners (m, 4) of faces, around."""
    return np.stack([nodes[:, 0, 0], nodes[:, 0, -1], nodes[:, -1, -1], nodes[:, -1, 0]], axis=1)


def _lagrange(count: int, at: Floats) -> tuple[Floats, Floats]:
    """Lagrange polynomials through two or three equal nodes in -1 ... 1, and their slopes, shape (points, nodes)."""
    one = np.ones_like(at)
    if count == 2:
        return np.stack([0.5 * (1 - at), 0.5 * (1 + at)], axis=1), np.stack([-0.5 * one, 0.5 * one], axis=1)
    values = np.stack([0.5 * at * (at - 1), 1 - at**2, 0.5 * at * (at + 1)], axis=1)
    return values, np.stack([at - 0.5, -2 * at, at + 0.5], axis=1)


def _patch(x: Floats, nodes: Ids, k: int, field: Floats | None, *, bilinear: bool) -> _Patch:
    """Faces subdivided in k parts along each side; those across the thickness of quadratic elements only along it."""
    rows, columns = nodes.shape[1:]
    along = np.linspace(-1.0, 1.0, k + 1)
    ends = along if rows == columns else np.array([-1.0, 1.0])
    A, dA = _lagrange(rows, ends)
    B, dB = _lagrange(columns, along)
    corners = x[nodes]
    normals = np.cross(_in(corners, A, dB), _in(corners, dA, B))
    (a, da), (b, db) = _lagrange(rows, np.zeros(1)), _lagrange(columns, np.zeros(1))
    middle = np.cross(_in(corners, a, db), _in(corners, da, b))[:, 0, 0]
    values = None
    if field is not None and bilinear:
        square = _corners(nodes)[:, [0, 1, 3, 2]].reshape(-1, 2, 2)
        values = _in(field[square][..., None], _lagrange(2, ends)[0], _lagrange(2, along)[0])[..., 0]
    elif field is not None:
        values = _in(field[nodes][..., None], A, B)[..., 0]
    return _Patch(_in(corners, A, B), normals, values, (_in(corners, a, b)[:, 0, 0], middle))


def _in(values: Floats, A: Floats, B: Floats) -> Floats:
    """Tensor products: values (m, rows, columns, c) at points (m, a, b, c)."""
    product: Floats = np.einsum("ai,bj,mijc->mabc", A, B, values, optimize=True)
    return product


def _unit(vectors: Floats) -> Floats:
    """Vectors of unit length; zero remains zero."""
    size = np.linalg.norm(vectors, axis=-1, keepdims=True)
    unit: Floats = np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0)
    return unit


def _smooth(x: Floats, faces: list[Ids], patches: list[_Patch]) -> None:
    """Let neighbours have one normal at a common corner, and spread the correction over the face bilinearly."""
    corners = np.concatenate([_corners(nodes) for nodes in faces])
    own = np.concatenate([patch.normals[:, [0, 0, -1, -1], [0, -1, -1, 0]] for patch in patches])
    groups = smooth_groups(x, corners, _unit(own)).ravel()
    total: Floats = np.stack([np.bincount(groups, own[:, :, c].ravel()) for c in range(3)], axis=1)
    change = _unit(total[groups].reshape(own.shape)) - _unit(own)
    begun = 0
    for patch in patches:
        m, a, b, _ = patch.x.shape
        square = change[begun : begun + m][:, [0, 1, 3, 2]].reshape(m, 2, 2, 3)
        A, B = _lagrange(2, np.linspace(-1, 1, a))[0], _lagrange(2, np.linspace(-1, 1, b))[0]
        patch.normals = _unit(patch.normals) + _in(square, A, B)
        begun += m


def _lines(x: Floats, faces: list[Ids], k: int) -> list[Floats]:
    """Edges of the outer faces, each once, as points along them."""
    flat, across = faces
    chains = [np.concatenate([flat[:, 0], flat[:, -1], flat[:, :, 0], flat[:, :, -1], across[:, 0], across[:, 1]])]
    chains.append(np.concatenate([across[:, :, 0], across[:, :, -1]]))
    lines = []
    for chain in chains:
        _, first = np.unique(np.sort(chain[:, [0, -1]], axis=1), axis=0, return_index=True)
        at = np.linspace(-1.0, 1.0, k + 1 if chain.shape[1] == 3 else 2)
        lines.append(np.einsum("si,lic->lsc", _lagrange(chain.shape[1], at)[0], x[chain[first]]))
    return lines
