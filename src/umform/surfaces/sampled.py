"""Triangles of a tool that is known by its distance only: marching tetrahedra on samples.

Cubes that the surface may cross are halved until the curvature allows triangles of their size. Each is split into six
tetrahedra around one diagonal; the surface crosses a tetrahedron in one or two triangles. Edges and corners of a tool
are cut off by about the size of a cube.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import permutations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.surfaces.triangles import Floats, Ids, Triangles

#: x (n, 3) -> distance (n,), normal, Hessian of the distance (n, 3, 3).
Gap = Callable[[Floats], tuple[ArrayLike, ArrayLike, ArrayLike]]

#: Number of cubes along the box: initial and largest.
_COARSE, _FINE = 8, 64
#: Tolerated factor of the distance of a user's function, up and down.
_SLACK = 2.0
_STEPS = 4

_CORNERS = np.array([(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)])
#: Corners of the six tetrahedra of a cube: from its lowest corner to its highest one along three edges.
_TETRAHEDRA = np.array([[0, a, a + b, 7] for a, b, _ in permutations((4, 2, 1))])


def sampled(gap: Gap, centre: Floats, reach: float, chord: float) -> Triangles:
    """Triangles of the zero level of a distance.

    Parameters
    ----------
    gap : callable
        Distance, normal and Hessian of the distance at some points; where it is not finite there is no surface.
    centre : ndarray, shape (3,)
        Middle of a cube.
    reach : float
        Half of its side.
    chord : float
        Deviation from the surface to aim at; at most 64 small cubes along a side.

    Raises
    ------
    InvalidValue
        If the function fails.
    """
    count = _COARSE
    cubes = np.stack(np.meshgrid(*[np.arange(count)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    while True:
        size = 2.0 * reach / count
        g, H = _asked(gap, centre - reach + (cubes + 0.5) * size)
        near = np.abs(g) <= _SLACK * 0.5 * np.sqrt(3.0) * size
        cubes = cubes[near]
        if count >= _FINE or not len(cubes) or 3.0 * size**2 * _curvature(H[near]) <= 8.0 * chord:
            break
        cubes, count = (2 * cubes[:, None] + _CORNERS).reshape(-1, 3), 2 * count
    return _marched(gap, cubes, lambda corners: centre - reach + corners * size)


def _curvature(H: Floats) -> float:
    """Largest curvature of the level surfaces at some points; points with a non-finite Hessian are ignored."""
    known = H[np.isfinite(H).all(axis=(1, 2))]
    return float(np.abs(np.linalg.eigvalsh(known)).max()) if len(known) else 0.0


def _asked(gap: Gap, x: Floats) -> tuple[Floats, Floats]:
    """Distance (infinite where it is not defined) and its Hessian."""
    try:
        g, _, H = gap(x)
        g, H = np.asarray(g, dtype=float).reshape(len(x)), np.asarray(H, dtype=float).reshape(len(x), 3, 3)
    except Exception as error:  # of the user
        raise InvalidValue(
            "this tool cannot be drawn: its function fails around the tool",
            where="facets",
            cause=f"{type(error).__name__}: {' '.join(str(error).split())}",
            remedy="let it give g, n, H of shapes (n,), (n, 3), (n, 3, 3) anywhere; NaN where there is no surface",
        ) from error
    return np.where(np.isfinite(g), g, np.inf), H


def _marched(gap: Gap, cubes: Ids, place: Callable[[Floats], Floats]) -> Triangles:
    """Triangles in cubes of one size, given by the indices of their lowest corners."""
    lattice, ids = np.unique((cubes[:, None] + _CORNERS).reshape(-1, 3), axis=0, return_inverse=True)
    g, _ = _asked(gap, place(lattice.astype(float))) if len(lattice) else (np.empty(0), None)
    corners = ids.reshape(-1, 8)[:, _TETRAHEDRA].reshape(-1, 4)
    inside = g[corners] <= 0.0
    order = np.argsort(~inside, axis=1, kind="stable")  # inner corners first
    corners = np.take_along_axis(corners, order, axis=1)
    known = np.isfinite(g[corners]).all(axis=1)
    kinds = (
        (1, [[(0, 1), (0, 2), (0, 3)]]),
        (3, [[(0, 3), (1, 3), (2, 3)]]),
        (2, [[(0, 2), (0, 3), (1, 3)], [(0, 2), (1, 3), (1, 2)]]),
    )
    edges, outward = [], []
    for count, triangles in kinds:
        chosen = corners[known & (inside.sum(axis=1) == count)]
        rise = lattice[chosen[:, count:]].mean(axis=1) - lattice[chosen[:, :count]].mean(axis=1)
        for triangle in triangles:
            edges.append(chosen[:, triangle])
            outward.append(rise)
    return _joined(gap, np.concatenate(edges), np.concatenate(outward), place(lattice.astype(float)), g)


def _joined(gap: Gap, edges: Ids, outward: Floats, x: Floats, g: Floats) -> Triangles:
    """Triangles from the edges on which their corners lie, inner end first."""
    ends, ids = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
    triangles = ids.reshape(-1, 3).astype(np.int64)
    points = _crossings(gap, x[ends[:, 0]], x[ends[:, 1]], g[ends[:, 0]], g[ends[:, 1]])
    turned = np.einsum("ti,ti->t", Triangles(points, triangles).area_vectors, outward) < 0.0
    triangles[turned] = triangles[turned][:, ::-1]
    return Triangles(points, triangles)


def _crossings(gap: Gap, low: Floats, high: Floats, g_low: Floats, g_high: Floats) -> Floats:
    """Intersections of edges with the surface, by regula falsi."""
    for _ in range(_STEPS if len(low) else 0):
        x = low + (g_low / (g_low - g_high))[:, None] * (high - low)
        g, _ = _asked(gap, x)
        inner: NDArray[np.bool_] = g <= 0.0
        low, g_low = np.where(inner[:, None], x, low), np.where(inner, g, g_low)
        high, g_high = np.where(inner[:, None], high, x), np.where(inner, g_high, g)
    with np.errstate(invalid="ignore"):
        part = np.where(np.isfinite(g_high), g_low / (g_low - g_high), 0.0)
    return np.asarray(low + part[:, None] * (high - low))
