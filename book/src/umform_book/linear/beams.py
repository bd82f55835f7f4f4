"""Models of the beams of MacNeal & Harder (1985): one end held, unit loads at the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform.materials import SVK
from umform.mesh import Mesh
from umform.model import Model
from umform.model.terms.forces import edge_forces, traction_forces
from umform_book.linear_algebra import linear_solution
from umform_book.variants import Variant

Floats = NDArray[np.float64]


class Beam:
    """A beam from the face x0 of its mesh, at x = 0, to the face x1.

    The section at x0 stays plane (no u_x) but may contract and warp in itself: only two corners hold u_z, one of
    them u_y. So the answers are those of beam theory; a section held in all directions costs a first-order error.
    """

    def __init__(self, mesh: Mesh, variant: Variant, material: SVK) -> None:
        self.mesh = mesh
        self.model = Model(mesh, variant.element, material=material)
        self.model.fix("x0", "x")
        corners = [np.intersect1d(mesh.nodes("x0_lower"), mesh.nodes(side)) for side in ("y0", "y1")]
        self.model.fix(corners[0], "y")
        self.model.fix(np.concatenate(corners), "z")
        self.end = mesh.nodes("x1")

    def under_force(self, direction: Sequence[float]) -> Floats:
        """Displacements (n, 3) under a force of size and direction, spread evenly over the end."""
        area = float(traction_forces(self.mesh, "x1", (1, 0, 0)).sum())
        return linear_solution(self.model, traction_forces(self.mesh, "x1", np.asarray(direction) / area))

    def tip(self, direction: Sequence[float]) -> float:
        """Mean displacement of the end along a force of size 1."""
        return float((self.under_force(direction)[self.end] @ np.asarray(direction)).mean())

    def twist(self, width: float, thickness: float) -> float:
        """Rotation of the end under a couple of 1 about x, of shear along its lower and upper edge."""
        q = 1.0 / (width * thickness)
        loads = edge_forces(self.mesh, "x1", "lower", (0, q, 0)) - edge_forces(self.mesh, "x1", "upper", (0, q, 0))
        u = linear_solution(self.model, loads)
        left, right = (np.intersect1d(self.end, self.mesh.nodes(side)) for side in ("y0", "y1"))
        return float(u[right, 2].mean() - u[left, 2].mean()) / width
