"""Pure plastic bending in plane strain: one element, or a stack, between two sections of a circular arc.

The nodes of a layer lie on a circle. Either the radius of each layer is found by equilibrium (the thickness is free),
or only that of the mid-line, while the directors keep their length. In both there is no axial force, and the moment is
that of virtual work, M = sum f . dx/d(angle).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.errors import SolveError
from umform.model import Evaluation
from umform_book.linear_algebra import stiffness
from umform_book.sharp_bends.bending import Bending
from umform_book.sharp_bends.candidates import Candidate

Floats = NDArray[np.float64]

#: Residual over the forces of the elements at which an increment has converged.
_TOLERANCE = 1e-8
_ITERATIONS = 30


class ArcBending(Bending):
    """An element bent from the flat state.

    Parameters
    ----------
    candidate : Candidate
        Element, points, layers.
    hardening : float
        Hardening modulus.
    length, thickness : float
        Of the element along the arc, of the sheet; the width is 1.
    held : bool
        Whether the directors keep their length.
    """

    def __init__(
        self,
        candidate: Candidate,
        hardening: float = 0.0,
        *,
        length: float = 0.1,
        thickness: float = 1.0,
        held: bool = False,
    ) -> None:
        super().__init__(thickness)
        ends = np.array([0.0, length])
        self.model = candidate.strip(ends, np.array([0.0, 1.0]), thickness, hardening)
        self.X = self.model.mesh.points
        self.length = length
        layer = np.rint((self.X[:, 2] / thickness + 0.5) * candidate.layers).astype(int)
        #: Radius of each node = 1/k + z + shape w, with the unknowns w.
        self.shape: Floats = np.ones((len(self.X), 1)) if held else np.eye(candidate.layers + 1)[layer]
        self.w: Floats = np.zeros(self.shape.shape[1])
        self.rate: Floats = np.zeros(self.shape.shape[1])

    @property
    def thickness_now(self) -> float:
        """Distance of the outer circles over the thickness."""
        moved = self.shape @ self.w
        upper, lower = moved[self.X[:, 2].argmax()], moved[self.X[:, 2].argmin()]
        return float(1.0 + (upper - lower) / self.thickness)

    def _increment(self, curvature: float) -> None:
        model = self.model
        w = self.w + self.rate * (curvature - self.curvature)
        model.system.revert()
        model.evaluate(model.u)
        model.system.recover(self._displacement(curvature, w) - model.u)
        directions = self._directions(curvature)
        for iteration in range(_ITERATIONS):
            u = self._displacement(curvature, w)
            evaluation = model.evaluate(u)
            if evaluation.failed >= 0:
                break
            residual = directions.T @ evaluation.residual
            if iteration > 0 and np.linalg.norm(residual) < _TOLERANCE * evaluation.force_scale:
                self._accept(curvature, w, evaluation)
                return
            K = directions.T @ (stiffness(model, evaluation) @ directions)
            # Without hardening the neutral line may lie anywhere between two points: the shortest step then.
            dw = -np.linalg.lstsq(K, residual, rcond=1e-9)[0]
            model.system.recover(directions @ dw)
            w = w + dw
            if np.abs(w).max() > 10.0 * self.thickness:  # far from any sheet
                break
        raise SolveError("no equilibrium of the bent element", where=f"curvature {curvature:.4g}")

    def _accept(self, curvature: float, w: Floats, evaluation: Evaluation) -> None:
        self.model.system.commit(evaluation)
        self.rate = (w - self.w) / (curvature - self.curvature)
        self.w, self.curvature = w, curvature
        along = self.X[:, 0]
        radius, angle = 1.0 / curvature + self.X[:, 2] + self.shape @ w, curvature * along
        arm = radius * along / self.length
        f = evaluation.residual.reshape(-1, 3)
        self.moment = float(arm @ (f[:, 0] * np.cos(angle) - f[:, 2] * np.sin(angle)))

    def _directions(self, curvature: float) -> Floats:
        """Displacements of all nodes, shape (3 n, m), for a unit of each unknown."""
        angle = curvature * self.X[:, 0]
        radial = np.column_stack([np.sin(angle), np.zeros(len(angle)), np.cos(angle)])
        return np.asarray((radial[:, :, None] * self.shape[:, None, :]).reshape(-1, self.shape.shape[1]))

    def _displacement(self, curvature: float, w: Floats) -> Floats:
        """Displacement of all nodes, shape (3 n,); the centre of the circles lies at (0, -1/k)."""
        angle, z = curvature * self.X[:, 0], self.X[:, 2] + self.shape @ w
        # written without the difference of two radii, which would be large
        x = np.sin(angle) / curvature + z * np.sin(angle)
        fall = 2.0 * np.sin(0.5 * angle) ** 2 / curvature
        return (np.column_stack([x, self.X[:, 1], z * np.cos(angle) - fall]) - self.X).ravel()
