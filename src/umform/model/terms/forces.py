"""Consistent nodal forces of dead loads, and the rigid-body modes of points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.errors import InvalidValue, NotFinite
from umform.mesh import FACES, Mesh, Selector
from umform.spec import InDeck

Floats = NDArray[np.float64]
Ids = NDArray[np.int32]

#: Three numbers.
Vector = Annotated[ArrayLike, InDeck(tuple[float, float, float])]

DIRECTIONS = {"x": 0, "y": 1, "z": 2}


def vector3(values: Vector, where: str) -> Floats:
    """Three finite numbers."""
    try:
        vector = np.asarray(values, dtype=float)
    except (TypeError, ValueError):  # a letter, for instance
        vector = np.empty(0)
    if vector.shape != (3,):
        raise InvalidValue(
            "a vector needs three components",
            where=where,
            value=values,
            cause="one number, a letter, or a vector of a plane",
            remedy="(0.0, 0.0, -1.0)",
        )
    if not np.isfinite(vector).all():
        raise NotFinite(
            "a vector must be finite",
            where=where,
            value=values,
            cause="a missing value, or a division by zero",
            remedy="(0.0, 0.0, -1.0)",
        )
    return vector


def _natural_grid(fixed: dict[int, float], nodes: int) -> tuple[Floats, Floats]:
    """Gauss points of a cell, face or edge: natural coordinates and weights; `fixed` prescribes some of r, s, t."""
    x, w = _core.gauss(2 if nodes == 8 else 3)
    one = np.ones(1)
    axes = [(np.array([fixed[i]]), one) if i in fixed else (x, w) for i in range(3)]
    grids = np.meshgrid(*[a[0] for a in axes], indexing="ij")
    weights = np.einsum("i,j,k->ijk", *[a[1] for a in axes])
    return np.stack(grids, axis=-1).reshape(-1, 3), weights.ravel()


def _integrate(mesh: Mesh, cells: Ids, fixed: dict[int, float]) -> tuple[Floats, Ids]:
    """Integrals of the shape functions over a volume, face or edge of the given cells: (cells, nodes), node ids."""
    ids = mesh.connectivity[cells]
    points, weights = _natural_grid(fixed, ids.shape[1])
    N, dN = _core.shell_functions(ids.shape[1], points)
    G = np.einsum("qia,eak->eqik", dN, mesh.points[ids])
    free = [i for i in range(3) if i not in fixed]
    if len(free) == 3:
        measure = np.abs(np.linalg.det(G))
    elif len(free) == 2:
        measure = np.linalg.norm(np.cross(G[:, :, free[0]], G[:, :, free[1]]), axis=-1)
    else:
        measure = np.linalg.norm(G[:, :, free[0]], axis=-1)
    return np.einsum("q,eq,qa->ea", weights, measure, N), ids


_FACE_COORDINATE = {0: (2, -1.0), 1: (2, 1.0), 2: (0, -1.0), 3: (0, 1.0), 4: (1, -1.0), 5: (1, 1.0)}


def _assemble(mesh: Mesh, parts: Sequence[tuple[Floats, Ids]], vector: Floats) -> Floats:
    force = np.zeros((len(mesh.points), 3))
    for share, ids in parts:
        np.add.at(force, ids.ravel(), share.ravel()[:, None] * vector)
    return force.ravel()


def traction_forces(mesh: Mesh, faces: Selector, traction: ArrayLike) -> Floats:
    """Nodal forces of a dead traction (force per reference area) on any faces of the cells. eq. (5.2)"""
    rows, vector = mesh.face_set(faces), vector3(traction, "traction")
    parts = []
    for number in np.unique(rows[:, 1]):
        axis, value = _FACE_COORDINATE[int(number)]
        parts.append(_integrate(mesh, rows[rows[:, 1] == number, 0], {axis: value}))
    return _assemble(mesh, parts, vector)


def edge_forces(mesh: Mesh, faces: Selector, side: str, line_load: ArrayLike) -> Floats:
    """Nodal forces of a dead line load (force per reference length) on the lower or upper edge of lateral faces.

    Of a stack of faces it is the lowest or the uppermost edge.
    """
    rows, vector = mesh.face_set(faces), vector3(line_load, "line load")
    if side not in ("lower", "upper"):
        raise InvalidValue(
            "an edge lies on the lower or on the upper face",
            where="line load, side",
            value=side,
            cause="the name of a set, or the load in its place",
            remedy='line_load("x1", "upper", (0.0, 0.0, -1.0))',
        )
    if (rows[:, 1] < 2).any():
        raise InvalidValue(
            "an edge belongs to a lateral face",
            where="line load, faces",
            value=FACES[int(rows[:, 1].min())],
            cause="lower or upper faces",
            remedy="choose faces like x0, x1, y0, y1",
        )
    edges = np.sort(mesh.corners_of(rows).reshape(-1, 2, 2), axis=2).astype(np.int64)
    lower, upper = (edges @ (len(mesh.points), 1)).T  # a number for each edge; layers share those between them
    rows = rows[~(np.isin(lower, upper) if side == "lower" else np.isin(upper, lower))]
    parts = []
    for number in np.unique(rows[:, 1]):
        axis, value = _FACE_COORDINATE[int(number)]
        fixed = {axis: value, 2: -1.0 if side == "lower" else 1.0}
        parts.append(_integrate(mesh, rows[rows[:, 1] == number, 0], fixed))
    return _assemble(mesh, parts, vector)


def body_forces(mesh: Mesh, force: ArrayLike) -> Floats:
    """Nodal forces of a dead body force (force per reference volume)."""
    everything = np.arange(len(mesh.connectivity), dtype=np.int32)
    return _assemble(mesh, [_integrate(mesh, everything, {})], vector3(force, "body force"))


def nodal_forces(mesh: Mesh, nodes: Selector, force: ArrayLike) -> Floats:
    """The same force on each node of a set."""
    vector = np.zeros((len(mesh.points), 3))
    vector[mesh.nodes(nodes)] = vector3(force, "nodal force")
    return vector.ravel()


def rigid_body_modes(points: Floats, centre: Floats | None = None, size: float | None = None) -> Floats:
    """Three translations and three rotations about a centre, 1 at the distance ``size`` from it; shape (6, 3 n).

    The centre and size default to the mean of the points and the largest distance from it.
    """
    centred = points - (points.mean(axis=0) if centre is None else centre)
    size = max(float(np.abs(centred).max()), 1e-300) if size is None else size
    modes = np.zeros((6, len(points), 3))
    for k in range(3):
        modes[k, :, k] = 1.0
        modes[3 + k] = np.cross(np.eye(3)[k], centred) / size
    return modes.reshape(6, -1)
