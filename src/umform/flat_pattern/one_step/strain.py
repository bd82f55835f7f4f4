"""Logarithmic strain and energy of triangles over the places of their corners in the flat, with two derivatives.

All triangles at once. With H = D G^-1 and B = H D^T, where the columns of D are two sides in the flat and G is the
metric of the same sides of the formed triangle, B is the inverse of the right Cauchy-Green tensor of the forming, and
the logarithmic strain is -ln(B) / 2. eqs. (6.1), (6.2)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.flat_pattern.one_step.law import PathLaw

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Ratio of the squares of deviator and mean of B below which series replace closed forms, and their terms.
_NEAR, _TERMS = 0.05, 14
#: From two sides to three corners.
SIDES = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])


@dataclass(frozen=True, eq=False)
class Formed:
    """The formed triangles.

    Attributes
    ----------
    sides : ndarray, shape (m, 3, 2)
        Two sides of each triangle in space, as columns.
    inverse : ndarray, shape (m, 2, 2)
        Inverse of their metric.
    area : ndarray, shape (m,)
        Areas.
    """

    sides: Floats
    inverse: Floats
    area: Floats

    @classmethod
    def of(cls, points: Floats, triangles: Ids) -> Formed:
        """The triangles of a surface."""
        sides = np.einsum("ka,mai->mik", SIDES, points[triangles])
        metric = np.einsum("mik,mil->mkl", sides, sides)
        return cls(sides, np.linalg.inv(metric), 0.5 * np.sqrt(np.linalg.det(metric)))


def flat_sides(X: Floats, triangles: Ids) -> Floats:
    """Two sides of each triangle in the flat as columns, shape (m, 2, 2)."""
    x = X[triangles]
    return np.stack([x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]], axis=2)


def areas(D: Floats) -> Floats:
    """Signed areas in the flat."""
    return np.asarray(0.5 * (D[:, 0, 0] * D[:, 1, 1] - D[:, 0, 1] * D[:, 1, 0]))


def mean_and_deviator(D: Floats, inverse: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """H, shape (m, 2, 2), and the parts of B: mean, half difference, shear."""
    H = D @ inverse
    B00, B11 = (H[:, i, 0] * D[:, i, 0] + H[:, i, 1] * D[:, i, 1] for i in (0, 1))
    return H, 0.5 * (B00 + B11), 0.5 * (B00 - B11), H[:, 0, 0] * D[:, 1, 0] + H[:, 0, 1] * D[:, 1, 1]


def _over_deviator(m: Floats, q: Floats, det: Floats) -> tuple[Floats, Floats, Floats]:
    """The factor g = artanh(sqrt(q) / m) / sqrt(q) and two derivatives by q; det = m^2 - q without its cancellation."""
    x = q / m**2
    near = x < _NEAR
    far, D = np.where(near, 0.5 * m**2, q), np.where(near, 0.5 * m**2, det)
    root = np.sqrt(far)
    g = (np.log(m + root) - 0.5 * np.log(D)) / root
    g1 = (m / D - g) / (2.0 * far)
    g2 = (m / D**2 - 3.0 * g1) / (2.0 * far)
    s, s1, s2 = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    for k in range(_TERMS, -1, -1):
        s2 = s2 * x + (k + 2) * (k + 1) / (2 * k + 5)
        s1 = s1 * x + (k + 1) / (2 * k + 3)
        s = s * x + 1.0 / (2 * k + 1)
    return np.where(near, s / m, g), np.where(near, s1 / m**3, g1), np.where(near, s2 / m**5, g2)


def log_strains(X: Floats, triangles: Ids, formed: Formed) -> Floats:
    """Logarithmic strains (e11, e22, e12) of triangles in the axes of the flat, shape (m, 3)."""
    D = flat_sides(X, triangles)
    _, m, b, c = mean_and_deviator(D, formed.inverse)
    det = (areas(D) / formed.area) ** 2
    g = _over_deviator(m, b * b + c * c, det)[0]
    a = -0.25 * np.log(det)
    return np.stack([a - 0.5 * g * b, a + 0.5 * g * b, -0.5 * g * c], axis=1)


@dataclass(frozen=True, eq=False)
class Work:
    """Energy of each triangle per volume with its derivatives by the two sides, (D00, D01, D10, D11).

    Attributes
    ----------
    value : ndarray, shape (m,)
        Energy.
    gradient : ndarray, shape (m, 4)
        First derivatives.
    hessian : ndarray, shape (m, 4, 4)
        Second derivatives.
    """

    value: Floats
    gradient: Floats
    hessian: Floats


def work(D: Floats, inverse: Floats, law: PathLaw, *, second: bool = True) -> Work:
    """Energy per volume of triangles.

    Parameters
    ----------
    D : ndarray, shape (m, 2, 2)
        Sides in the flat, of positive area.
    inverse : ndarray, shape (m, 2, 2)
        Of the metric of the formed sides.
    law : PathLaw
        Law of the sheet.
    second : bool
        Whether the second derivatives are wanted; zeros otherwise.
    """
    H, m, b, c = mean_and_deviator(D, inverse)
    v = np.stack([b, c], axis=1)
    q = b * b + c * c
    det = 8.0 * areas(D) ** 2 * areas(inverse)
    g, g1, g2 = _over_deviator(m, q, det)
    u = np.stack([-0.25 * np.log(det), g * b, g * c], axis=1)
    M = law.metric
    Mu = u @ M
    size = np.sqrt(np.maximum(np.einsum("mi,mi->m", u, Mu), 1e-300))
    value, stress, slope = law.energy(size)
    secant = stress / size
    p = secant[:, None] * Mu
    pressed = law.ironed(2.0 * u[:, 0])
    value = value + pressed[0]
    p[:, 0] += 2.0 * pressed[1]

    U = np.zeros((len(m), 3, 3))  # derivatives of u by (m, b, c)
    U[:, 0, 0] = -0.5 * m / det
    U[:, 0, 1:] = 0.5 * v / det[:, None]
    U[:, 1:, 0] = -v / det[:, None]
    U[:, 1:, 1:] = g[:, None, None] * np.eye(2) + 2.0 * g1[:, None, None] * v[:, :, None] * v[:, None, :]
    by_part = np.einsum("mi,mij->mj", p, U)

    J = np.empty((len(m), 3, 4))  # derivatives of (m, b, c) by the sides
    J[:, 0, :2], J[:, 0, 2:] = H[:, 0], H[:, 1]
    J[:, 1, :2], J[:, 1, 2:] = H[:, 0], -H[:, 1]
    J[:, 2, :2], J[:, 2, 2:] = H[:, 1], H[:, 0]
    gradient = np.einsum("mi,mij->mj", by_part, J)
    if not second:
        return Work(value, gradient, np.zeros((len(m), 4, 4)))

    bend = (slope - secant) / size**2
    by_u = secant[:, None, None] * M + bend[:, None, None] * Mu[:, :, None] * Mu[:, None, :]
    by_u[:, 0, 0] += 4.0 * pressed[2]
    parts = np.swapaxes(U, 1, 2) @ by_u @ U + _curvature(m, v, det, g1, g2, p)
    hessian = np.swapaxes(J, 1, 2) @ parts @ J
    w_m, w_b, w_c = (by_part[:, k, None, None] * inverse for k in range(3))
    hessian[:, :2, :2] += w_m + w_b
    hessian[:, 2:, 2:] += w_m - w_b
    hessian[:, :2, 2:] += w_c
    hessian[:, 2:, :2] += w_c
    return Work(value, gradient, hessian)


def _curvature(m: Floats, v: Floats, det: Floats, g1: Floats, g2: Floats, p: Floats) -> Floats:
    """Second derivatives of u by (m, b, c), weighted with p, shape (n, 3, 3)."""
    C = np.empty((len(m), 3, 3))
    square = (p[:, 0] / det**2)[:, None]
    pv = np.einsum("mi,mi->m", p[:, 1:], v)
    C[:, 0, 0] = p[:, 0] * (m * m / det**2 - 0.5 / det) + pv * 2.0 * m / det**2
    mixed = -square * m[:, None] * v - p[:, 1:] / det[:, None] - 2.0 * (pv / det**2)[:, None] * v
    C[:, 0, 1:] = C[:, 1:, 0] = mixed
    outer = v[:, :, None] * v[:, None, :]
    one, twice = np.eye(2), p[:, 1:, None] * v[:, None, :]
    C[:, 1:, 1:] = (
        square[:, :, None] * outer
        + (0.5 * p[:, 0] / det)[:, None, None] * one
        + 2.0 * g1[:, None, None] * (twice + np.swapaxes(twice, 1, 2) + pv[:, None, None] * one)
        + 4.0 * (g2 * pv)[:, None, None] * outer
    )
    return C
