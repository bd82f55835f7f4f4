"""A section in pure bending whose fibres move against each other: the director of one layer bent through its length.

The fibre at z = h t / 2 of the flat sheet lies at the distance x(t) from the mid-line,

    x = sum of a_j Q_j(t),   Q_j' = h P_(j-1) / 2,   j = 1 ... p,

    l_1 = l0 + k x,   E_11 = (l_1^2 - 1) / 2,   E_33 = ((2 x'/h)^2 - 1) / 2 + e,

with e free at each point but for its moments with P_0 ... P_(p-1): S_33 is then a polynomial of degree p - 1, which
x keeps in equilibrium with S_11. p = 1 is the straight director with the complete order. eq. (2.50)
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.linalg import null_space

from umform.errors import SolveError
from umform_book.sharp_bends.bending import Bending
from umform_book.sharp_bends.candidates import YIELD_STRESS, steel
from umform_book.sharp_bends.section import wide_rule

Floats = NDArray[np.float64]

_TOLERANCE = 1e-8
_ITERATIONS = 40


class FibreSection(Bending):
    """A section of 60 points, bent from the flat state.

    Parameters
    ----------
    degree : int
        Degree p of the place of the fibres in t.
    hardening : float
        Hardening modulus of the steel of this chapter.
    """

    def __init__(self, degree: int, hardening: float = 0.0) -> None:
        super().__init__(thickness=1.0)
        self.law = steel(hardening).law()
        t, w = wide_rule()
        self.w = 0.5 * w
        unit = np.eye(degree)
        self.slopes = np.asarray(legendre.legvander(t, degree - 1), dtype=np.float64)
        places = [legendre.legval(t, legendre.legint(row, lbnd=-1.0 if j else 0.0)) for j, row in enumerate(unit)]
        self.places: Floats = 0.5 * np.array(places, dtype=np.float64).T
        self.free = np.asarray(null_space((self.slopes * w[:, None]).T), dtype=np.float64)
        self.history: Floats = np.tile(self.law.initial(), (len(t), 1))
        self.unknowns: Floats = np.concatenate([[1.0, 1.0], np.zeros(degree - 1 + self.free.shape[1])])
        self.rate: Floats = np.zeros(self.unknowns.size)

    def _increment(self, curvature: float) -> None:
        unknowns, p = self.unknowns + self.rate * (curvature - self.curvature), self.places.shape[1]
        for iteration in range(_ITERATIONS):
            x, slope = self.places @ unknowns[1 : p + 1], self.slopes @ unknowns[1 : p + 1]
            stretch = unknowns[0] + curvature * x
            E33 = 0.5 * (slope**2 - 1.0) + self.free @ unknowns[p + 1 :]
            if min(stretch.min(), 1.0 + 2.0 * E33.min()) <= 0.0:
                break
            r, K, history, moment = self._equations(curvature, stretch, slope, E33, x)
            if iteration > 0 and np.linalg.norm(r) < _TOLERANCE * YIELD_STRESS:
                self.rate = (unknowns - self.unknowns) / (curvature - self.curvature)
                self.unknowns, self.history, self.curvature, self.moment = unknowns, history, curvature, moment
                return
            unknowns = unknowns - np.linalg.lstsq(K, r, rcond=1e-12)[0]
        raise SolveError("no equilibrium of the bent section", where=f"curvature {curvature:.4g}")

    def _equations(
        self, curvature: float, stretch: Floats, slope: Floats, E33: Floats, x: Floats
    ) -> tuple[Floats, Floats, Floats, float]:
        """Residual, tangent, new history and moment."""
        E = np.zeros((len(x), 6))
        E[:, 0], E[:, 2] = 0.5 * (stretch**2 - 1.0), E33
        S, CC, history = self.law.respond(E, self.history)
        S, CC = S[:, [0, 2]], CC[:, [0, 2]][:, :, [0, 2]]
        if not np.isfinite(S).all():
            raise SolveError("a point is outside of the domain of the law", where=f"curvature {curvature:.4g}")
        rest = np.zeros((len(x), self.free.shape[1]))
        along = np.hstack([np.ones((len(x), 1)), curvature * self.places, rest])
        across = np.hstack([np.zeros((len(x), 1)), self.slopes, rest])
        B = np.stack([stretch[:, None] * along, slope[:, None] * across])
        B[1, :, self.places.shape[1] + 1 :] = self.free
        K = np.einsum("q,iqa,qij,jqb->ab", self.w, B, CC, B)
        K += along.T @ ((self.w * S[:, 0])[:, None] * along) + across.T @ ((self.w * S[:, 1])[:, None] * across)
        return np.einsum("q,qi,iqa->a", self.w, S, B), K, history, float(self.w @ (S[:, 0] * stretch * x))
