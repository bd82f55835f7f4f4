"""A section in pure plastic bending: straight director of free length, and any interpolation of the thickness strain.

It is an element of no length with many points through the thickness, which tests only how E_33 depends on t.
Unknowns are the stretch of the mid-line l0,
that of the director d, and the parameters a of the thickness strain; with z = h t / 2

    l_1 = l0 + k d z,   E_11 = (l_1^2 - 1) / 2,   E_22 = 0,   E_33 = E_33(d, a, t).

They make the virtual work of S_11 and S_33 vanish, and so there is no axial force; M = int S_11 l_1 d z dz.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import legvander
from numpy.typing import NDArray
from scipy.linalg import null_space

from umform.elements import thickness_rule
from umform.errors import SolveError
from umform_book.sharp_bends.bending import Bending
from umform_book.sharp_bends.candidates import KAPPA, MU, YIELD_STRESS, steel

Floats = NDArray[np.float64]

_TOLERANCE = 1e-9
_ITERATIONS = 30
#: Sections of the rule: each has 15 Gauss points, so that the neutral line is never far from a point.
_PARTS = 4


@dataclass(frozen=True)
class ThicknessStrain:
    """How E_33 depends on t.

    Attributes
    ----------
    label : str
        Name in tables.
    order : int or None
        E_33 = (d^2 - 1) / 2 + sum of a_j P_j(t), j = 1 ... order; None: free at every point, its mean that of the
        director. Then S_33 is constant over the thickness: its linear part vanishes with the mode t.
    logarithmic : bool
        The same sum added to the logarithm of the stretch: 1 + 2 E_33 = d^2 exp(2 sum of a_j P_j).
    volume : int or None
        Highest polynomial of the logarithm of the volume change, whose pointwise value is replaced by its projection.
    stabilisation : float
        Factor c of the energy c mu a_j^2 P_j^2 / 2 per volume that is added for j > 1.
    """

    label: str
    order: int | None
    logarithmic: bool = False
    volume: int | None = None
    stabilisation: float = 0.0

    def basis(self, t: Floats, w: Floats) -> Floats:
        """Polynomials at the points, shape (points, parameters)."""
        if self.order is None:
            return np.asarray(null_space(w[None, :]))
        return np.asarray(legvander(t, self.order)[:, 1:], dtype=np.float64)


class BentSection(Bending):
    """A section bent from the flat state.

    Parameters
    ----------
    strain : ThicknessStrain
        Interpolation through the thickness.
    hardening : float
        Hardening modulus of the steel of this chapter.
    rule : (ndarray, ndarray), optional
        Abscissae and weights of the points; default: 60.
    """

    def __init__(
        self, strain: ThicknessStrain, hardening: float = 0.0, rule: tuple[Floats, Floats] | None = None
    ) -> None:
        super().__init__(thickness=1.0)
        self.strain = strain
        self.law = steel(hardening).law()
        t, w = wide_rule() if rule is None else rule
        self.z, self.w = 0.5 * t, 0.5 * w
        self.P = strain.basis(t, w)
        #: Projection of the logarithm of the volume change: (points, points)
        self.project = np.eye(len(t)) if strain.volume is None else _projection(t, w, strain.volume)
        self.stabilisation = strain.stabilisation * MU * np.diag(self.w @ self.P**2)
        if strain.order is not None:
            self.stabilisation[:1] = 0.0
        self.history: Floats = np.tile(self.law.initial(), (len(t), 1))
        self.unknowns: Floats = np.concatenate([[1.0, 1.0], np.zeros(self.P.shape[1])])
        self.rate: Floats = np.zeros(self.unknowns.size)

    def _increment(self, curvature: float) -> None:
        unknowns = self.unknowns + self.rate * (curvature - self.curvature)
        for iteration in range(_ITERATIONS):
            stretch, E33 = self._stretch(curvature, unknowns), self._thickness_strain(unknowns)
            if min(stretch.min(), 1.0 + 2.0 * E33.min()) <= 0.0:
                break
            r, K, history, moment = self._equations(curvature, unknowns, stretch, E33)
            if iteration > 0 and np.linalg.norm(r) < _TOLERANCE * YIELD_STRESS:
                self.rate = (unknowns - self.unknowns) / (curvature - self.curvature)
                self.unknowns, self.history, self.curvature, self.moment = unknowns, history, curvature, moment
                return
            # Without hardening the neutral line may lie anywhere between two points: the shortest step then.
            unknowns = unknowns - np.linalg.lstsq(K, r, rcond=1e-12)[0]
        raise SolveError("no equilibrium of the bent section", where=f"curvature {curvature:.4g}")

    def _stretch(self, curvature: float, unknowns: Floats) -> Floats:
        return np.asarray(unknowns[0] + curvature * unknowns[1] * self.z)

    def _thickness_strain(self, unknowns: Floats) -> Floats:
        d, added = unknowns[1], self.P @ unknowns[2:]
        if self.strain.logarithmic:
            return np.asarray(0.5 * (d**2 * np.exp(2.0 * added) - 1.0))
        return np.asarray(0.5 * (d**2 - 1.0) + added)

    def _equations(
        self, curvature: float, unknowns: Floats, stretch: Floats, E33: Floats
    ) -> tuple[Floats, Floats, Floats, float]:
        """Residual, tangent, new history and moment."""
        E = np.zeros((len(self.z), 6))
        E[:, 0], E[:, 2] = 0.5 * (stretch**2 - 1.0), E33
        S, CC, history = self.law.respond(E, self.history)
        S, CC = S[:, [0, 2]], CC[:, [0, 2]][:, :, [0, 2]]
        if not np.isfinite(S).all():
            raise SolveError("a point is outside of the domain of the law", where=f"curvature {curvature:.4g}")
        B, H33 = self._derivatives(curvature, unknowns, stretch)
        C = 1.0 + 2.0 * E[:, [0, 2]]
        S, K = self._volume(C, S, B)
        slope = B[0] / stretch[:, None]
        K += np.einsum("q,iqa,qij,jqb->ab", self.w, B, CC, B)
        K += slope.T @ ((self.w * S[:, 0])[:, None] * slope) + np.einsum("q,qab->ab", self.w * S[:, 1], H33)
        r = np.einsum("q,qi,iqa->a", self.w, S, B)
        r[2:] += self.stabilisation @ unknowns[2:]
        K[2:, 2:] += self.stabilisation
        return r, K, history, float(self.w @ (S[:, 0] * stretch * unknowns[1] * self.z))

    def _derivatives(self, curvature: float, unknowns: Floats, stretch: Floats) -> tuple[Floats, Floats]:
        """Derivatives of E_11 and E_33 by the unknowns, (2, points, m), and the second ones of E_33."""
        d, points, m = unknowns[1], len(self.z), unknowns.size
        B, H33 = np.zeros((2, points, m)), np.zeros((points, m, m))
        B[0, :, 0], B[0, :, 1] = stretch, stretch * curvature * self.z
        if not self.strain.logarithmic:
            B[1, :, 1], B[1, :, 2:] = d, self.P
            H33[:, 1, 1] = 1.0
            return B, H33
        factor = np.exp(2.0 * self.P @ unknowns[2:])
        B[1, :, 1], B[1, :, 2:] = d * factor, (d**2 * factor)[:, None] * self.P
        H33[:, 1, 1] = factor
        H33[:, 1, 2:] = H33[:, 2:, 1] = 2.0 * d * factor[:, None] * self.P
        H33[:, 2:, 2:] = 2.0 * (d**2 * factor)[:, None, None] * self.P[:, :, None] * self.P[:, None, :]
        return B, H33

    def _volume(self, C: Floats, S: Floats, B: Floats) -> tuple[Floats, Floats]:
        """Stresses with the projected volume change ln J = ln(C_11 C_33) / 2, and its part of the tangent."""
        if self.strain.volume is None:
            return S, np.zeros((B.shape[2], B.shape[2]))
        theta = 0.5 * np.log(C.prod(axis=1))
        pressure = KAPPA * (self.project @ theta - theta)
        G = np.einsum("iqa,qi->qa", B, 1.0 / C)
        mean = self.project @ G
        K = KAPPA * (mean.T @ (self.w[:, None] * mean) - G.T @ (self.w[:, None] * G))
        K -= 2.0 * np.einsum("q,iqa,qi,iqb->ab", self.w * pressure, B, C**-2, B)
        return S + pressure[:, None] / C, K


def wide_rule() -> tuple[Floats, Floats]:
    """Gauss points in equal sections of [-1, 1]."""
    x, w = thickness_rule(15)
    middles = (2.0 * np.arange(_PARTS) + 1.0) / _PARTS - 1.0
    t = (middles[:, None] + x / _PARTS).ravel()
    return t, np.tile(w / _PARTS, _PARTS)


def _projection(t: Floats, w: Floats, order: int) -> Floats:
    """Orthogonal projection on the polynomials up to an order, under the weights."""
    P = legvander(t, order)
    return np.asarray(P @ np.linalg.solve(P.T @ (w[:, None] * P), P.T * w))
