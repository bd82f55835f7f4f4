"""Control points of curved patches over triangles, with common tangent planes along their edges.

Each triangle is cut into three at its middle, and each third is a Bezier patch of degree 4 (Shirman and Séquin).
"""

from __future__ import annotations

import numpy as np

from umform.surfaces.smooth.edges import Edges
from umform.surfaces.smooth.normals import Normals
from umform.surfaces.triangles import Floats, Triangles

#: Least cosine between a sharp edge and the line in which both tangent planes meet.
_ALONG = 0.5
#: Least sine of the angle between two planes that meet in a line.
_MEET = 1e-4


def control_points(surface: Triangles, edges: Edges, normals: Normals) -> Floats:
    """Points of the three patches of each triangle. eq. (4.164)

    Returns
    -------
    ndarray, shape (3 m, 15, 3)
        The third over edge 3 t + e; rows of 5, 4, 3, 2 and 1 points from its edge to the middle of the triangle.
    """
    V = surface.corners
    t0, t1 = (t.reshape(-1, 3, 3) for t in _tangents(surface.points, edges, normals))
    Vj = np.roll(V, -1, axis=1)
    b1, b2 = V + t0 / 3.0, Vj - t1 / 3.0  # the cubic edge
    P = np.stack([V, (V + 3.0 * b1) / 4.0, (b1 + b2) / 2.0, (3.0 * b2 + Vj) / 4.0, Vj])
    inner = (V + P[1] + _before(P[3])) / 3.0
    Q = _second_row(P, inner, (t0, 3.0 * (b2 - b1), t1), normals.corner)
    R = (inner + Q[1] + _before(Q[2])) / 3.0
    middle = _of_cubic(V, b1, b2)
    S = (R + middle + _before(middle)) / 3.0
    C = np.broadcast_to(S.mean(axis=1, keepdims=True), S.shape)
    rows = [*P, *Q, R, middle, _after(R), S, _after(S), C]
    return np.ascontiguousarray(np.stack(rows, axis=2).reshape(-1, 15, 3))


def _before(values: Floats) -> Floats:
    """Values of edge e - 1 at the place of edge e."""
    return np.roll(values, 1, axis=1)


def _after(values: Floats) -> Floats:
    return np.roll(values, -1, axis=1)


def _tangents(points: Floats, edges: Edges, normals: Normals) -> tuple[Floats, Floats]:
    """Derivatives of the edges at their starts and ends; the mate sees them reversed. eqs. (4.160), (4.161)"""
    chord = points[edges.end] - points[edges.start]
    corner = normals.corner
    n0, n1 = corner.reshape(-1, 3), _after(corner).reshape(-1, 3)
    inner = edges.mate >= 0
    mate = np.where(inner, edges.mate, np.arange(len(inner)))
    t0 = _tangent(chord, n0, n1[mate], ~normals.same[:, 0])
    t1 = _tangent(chord, n1, n0[mate], ~normals.same[:, 1])
    turned = inner & (edges.mate < np.arange(len(inner)))
    t0[turned], t1[turned] = -t1[edges.mate[turned]], -t0[edges.mate[turned]]
    return t0, t1


def _tangent(chord: Floats, n: Floats, other: Floats, sharp: np.ndarray) -> Floats:
    """In the tangent plane, or in both; its length makes the cubic approximate a circular arc."""
    length = np.linalg.norm(chord, axis=1)
    t = chord - np.einsum("ei,ei->e", chord, n)[:, None] * n
    line = np.cross(n, other)
    sine = np.linalg.norm(line, axis=1)
    meet = sharp & (sine > _MEET)
    along = np.einsum("ei,ei->e", chord[meet], line[meet]) / sine[meet] ** 2
    t[meet] = along[:, None] * line[meet]
    cosine = np.linalg.norm(t, axis=1) / length
    stray = sharp & (cosine < _ALONG)
    t[stray], cosine[stray] = chord[stray], 1.0
    return np.asarray(t * (2.0 / (cosine * (1.0 + cosine)))[:, None])


def _second_row(P: Floats, inner: Floats, hodograph: tuple[Floats, Floats, Floats], n: Floats) -> Floats:
    """Points beside the edge; the tangent planes along it depend on its ends only. eqs. (4.162), (4.163)"""
    q0, q1, q2 = hodograph
    inner_j, n_j = _after(inner), _after(n)
    A0, A1 = (np.cross(m, q / np.linalg.norm(q, axis=2, keepdims=True)) for m, q in ((n, q0), (n_j, q2)))
    D0, D1 = 4.0 * inner - 2.0 * (P[0] + P[1]), 4.0 * inner_j - 2.0 * (P[3] + P[4])
    k0, k1 = _dot(D0, A0), _dot(D1, A1)
    h0, h1 = _dot(D0, q0) / _dot(q0, q0), _dot(D1, q2) / _dot(q2, q2)
    m0, m1, m2 = k0 * A0, 0.5 * (k0 * A1 + k1 * A0), k1 * A1
    first = (m0 + 2.0 * m1 + h1 * q0 + 2.0 * h0 * q1) / 3.0
    second = (2.0 * m1 + m2 + 2.0 * h1 * q1 + h0 * q2) / 3.0
    Q1, Q2 = first / 4.0 + (P[1] + P[2]) / 2.0, second / 4.0 + (P[2] + P[3]) / 2.0
    return np.stack([inner, Q1, Q2, inner_j])


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray((a * b).sum(axis=2, keepdims=True))


def _of_cubic(V: Floats, b1: Floats, b2: Floats) -> Floats:
    """The free point of each third, from the cubic patch with the same edges, split at its middle. eq. (4.165)"""
    E, M = 0.5 * (b1 + b2).mean(axis=1, keepdims=True), V.mean(axis=1, keepdims=True)
    centre = 1.5 * E - 0.5 * M
    toward_i = (V + b2 + _before(b1) + 2.0 * b1 + 2.0 * _before(b2) + 2.0 * centre) / 9.0  # at corner, middle, middle
    both = (b1 + b2 + centre) / 3.0
    return np.asarray((toward_i + _after(toward_i) + 2.0 * both) / 4.0)
