"""Friction of punch and die where they bend the tensioned sheet: the pressure of membrane equilibrium. eq. (6.17)"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.flat_pattern.one_step.equations import Equations, between_corners
from umform.flat_pattern.one_step.forces import Restraint
from umform.flat_pattern.one_step.law import PathLaw
from umform.flat_pattern.one_step.part import Sheet
from umform.flat_pattern.one_step.strain import SIDES, Formed, areas, flat_sides, work
from umform.solvers import make_solver

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ToolFriction:
    """Friction of the tools on a formed sheet that is curved.

    Attributes
    ----------
    sheet, formed : Sheet, Formed
        The part.
    coefficient : float
        Of friction.
    bending : ndarray, shape (m, 2, 2)
        Second fundamental form of each triangle, in its two sides.
    outward : ndarray, shape (m, 3)
        Unit vectors in the surface away from where it is not drawn.
    """

    sheet: Sheet
    formed: Formed
    coefficient: float
    bending: Floats
    outward: Floats

    @classmethod
    def of(cls, sheet: Sheet, formed: Formed, coefficient: float) -> ToolFriction:
        """The friction of a part drawn along z."""
        return cls(sheet, formed, coefficient, _second_form(sheet, formed), _outward(sheet, formed))

    def pressure(self, D: Floats, law: PathLaw) -> Floats:
        """Pressure of the tools times the thickness of the blank over that of the sheet, shape (m,).

        Positive from below; sides in the flat have the shape (m, 2, 2).
        """
        W = work(D, self.formed.inverse, replace(law, thickest=math.inf), second=False)
        stress = -self.formed.inverse @ np.swapaxes(D, 1, 2) @ W.gradient.reshape(-1, 2, 2)
        return np.asarray(np.einsum("mij,mji->m", stress, self.bending) * areas(D) / self.formed.area)

    def at(self, X: Floats, law: PathLaw) -> Restraint:
        """Forces for places in the flat: outwards on the side of the die, inwards on that of the punch."""
        D = flat_sides(X, self.sheet.triangles)
        size = self.coefficient * self.formed.area * self.pressure(D, law)
        force = (_side_of_die(self.sheet, self.formed) * size)[:, None] * self.outward
        corners = np.tile(np.arange(3), (len(size), 1))
        return Restraint(np.arange(len(size)), corners, np.einsum("mik,mi->mk", self.formed.sides, force))


def _side_of_die(sheet: Sheet, formed: Formed) -> float:
    """1 if the part lies below its outer edge, so that the die is below, otherwise -1."""
    middle = float(formed.area @ sheet.points[sheet.triangles, 2].mean(axis=1) / formed.area.sum())
    return 1.0 if middle <= float(sheet.points[sheet.loops[0], 2].mean()) else -1.0


def _second_form(sheet: Sheet, formed: Formed) -> Floats:
    normals = np.zeros_like(sheet.points)
    for corner in sheet.triangles.T:
        np.add.at(normals, corner, sheet.normals * formed.area[:, None])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    form = np.swapaxes(formed.sides, 1, 2) @ np.einsum("ka,mai->mik", SIDES, normals[sheet.triangles])
    return np.asarray(0.5 * (form + np.swapaxes(form, 1, 2)))


def _outward(sheet: Sheet, formed: Formed) -> Floats:
    """Directions of the gradient of the function whose Laplacian is one, zero at the outer edge."""
    held = np.zeros((len(sheet.points), 2), dtype=bool)
    held[sheet.loops[0]] = True
    equations = Equations(len(sheet.points), sheet.triangles, held.ravel(), symmetric=True)
    hessian = np.zeros((len(sheet.triangles), 4, 4))
    hessian[:, :2, :2] = hessian[:, 2:, 2:] = formed.area[:, None, None] * formed.inverse
    solver = make_solver(equations.pattern)
    solver.factor(equations.matrix(between_corners(hessian)))
    values = np.zeros(2 * len(sheet.points))
    source = equations.vector(np.repeat(formed.area[:, None] / 3.0, 6, axis=1))
    values[equations.free] = -solver.solve(source[equations.free])
    slopes = np.einsum("ka,ma->mk", SIDES, values[0::2][sheet.triangles])
    gradient = np.einsum("mik,mkl,ml->mi", formed.sides, formed.inverse, slopes)
    return np.asarray(gradient / np.maximum(np.linalg.norm(gradient, axis=1, keepdims=True), 1e-300))
