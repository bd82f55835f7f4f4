"""The places in the flat: the minimum of an energy, then equilibrium of the formed sheet by Newton's method."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import NoConvergence, SingularMatrix
from umform.flat_pattern.one_step.equations import Equations, at_corners, between_corners
from umform.flat_pattern.one_step.forces import Friction, Restraint
from umform.flat_pattern.one_step.law import PathLaw
from umform.flat_pattern.one_step.part import Sheet
from umform.flat_pattern.one_step.strain import Formed, Work, areas, flat_sides, work
from umform.solvers import SparseSolver, make_solver

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
Mask = NDArray[np.bool_]

#: Second derivatives of the area by the sides (D00, D01, D10, D11).
_AREA = 0.5 * np.fliplr(np.diag([1.0, -1.0, -1.0, 1.0]))
#: Part of the way to the first triangle without area that a step may take.
_SAFE = 0.9
#: Largest displacement in the last step over the size of the part, and that of places that are only a start.
CONVERGED, ROUGH = 1e-9, 1e-3
_ITERATIONS, _NEWTON, _HALVINGS = 200, 40, 8
#: Smallest over largest eigenvalue of the matrix of a triangle, where the sum over all is not positive definite.
_LEAST_STIFFNESS = 1e-3


@dataclass(eq=False)
class FlatProblem:
    """Places in the flat of a formed sheet.

    Attributes
    ----------
    sheet, formed : Sheet, Formed
        The part.
    law : PathLaw
        Law of the sheet.
    held : ndarray of bool, shape (n,)
        Points whose places in the flat are given.
    forces : sequence of Friction or Restraint
        What holds the sheet back.
    iterations : int
        Iterations so far.
    """

    sheet: Sheet
    formed: Formed
    law: PathLaw
    held: Mask
    forces: Sequence[Friction | Restraint] = ()
    iterations: int = 0

    @property
    def size(self) -> float:
        """Square root of the area of the part."""
        return float(np.sqrt(self.formed.area.sum()))

    def energy(self, X: Floats, law: PathLaw, *, of_flat: bool = False) -> float:
        """Energy over the area of the formed part, eq. (6.8), or over that of the flat."""
        D = flat_sides(X, self.sheet.triangles)
        over = areas(D) if of_flat else self.formed.area
        return float(over @ work(D, self.formed.inverse, law, second=False).value)

    def minimum(self, X: Floats, law: PathLaw, *, of_flat: bool = False) -> Floats:
        """Places of nearly least energy, a start of `Balance`, by Newton's method with projected matrices.

        Parameters
        ----------
        X : ndarray, shape (n, 2)
            First places.
        law : PathLaw
            Law of the sheet; without directions unless points are held.
        of_flat : bool
            The energy is that of the material: its minimum with all edges held is the equilibrium. Otherwise that over
            the area of the formed part, whose minimum always exists.

        Raises
        ------
        NoConvergence
            If no minimum is found.
        """
        equations = Equations(len(X), self.sheet.triangles, self._supported(X), symmetric=True)
        solver, free = make_solver(equations.pattern), equations.free
        for _ in range(_ITERATIONS):
            self.iterations += 1
            D = flat_sides(X, self.sheet.triangles)
            w = work(D, self.formed.inverse, law)
            first, second = _of_material(D, w) if of_flat else _of_part(self.formed.area, w)
            gradient = equations.vector(at_corners(first))[free]
            if not _positive(solver, equations.matrix(between_corners(second))):
                try:
                    solver.factor(equations.matrix(between_corners(_projected(second))))
                except SingularMatrix:  # triangles that are nearly lost
                    break
            change = np.zeros(2 * len(X))
            change[free] = -solver.solve(gradient)
            step = change.reshape(-1, 2)
            slope, before = float(gradient @ change[free]), self.energy(X, law, of_flat=of_flat)
            length = first_fold(X, step, self.sheet.triangles)
            if abs(step).max() < ROUGH * self.size:
                return X + min(length, 1.0) * step
            length = min(1.0, _SAFE * length)
            for _ in range(4 * _HALVINGS):
                if self.energy(X + length * step, law, of_flat=of_flat) <= before + 1e-4 * length * slope:
                    break
                length *= 0.5
            else:
                return X  # round-off
            X = X + length * step
        raise _not_found("the energy of the flat has no minimum that is found", self.iterations)

    def _supported(self, X: Floats) -> Mask:
        """Unknowns that keep their values: three of a free sheet, against rigid motions."""
        held = np.repeat(self.held, 2)
        if not held.any():
            a = int(((X - X.mean(axis=0)) ** 2).sum(axis=1).argmin())
            b = int(((X - X[a]) ** 2).sum(axis=1).argmax())
            across = 1 if abs(X[b, 0] - X[a, 0]) > abs(X[b, 1] - X[a, 1]) else 0
            held[[2 * a, 2 * a + 1, 2 * b + across]] = True
        return held

    def residual(self, X: Floats) -> tuple[Floats, Floats]:
        """Material forces at the corners of the triangles, shape (m, 6), and their derivatives, (m, 6, 6).

        eqs. (6.9), (6.10)
        """
        D = flat_sides(X, self.sheet.triangles)
        w = work(D, self.formed.inverse, self.law)
        first, second = _of_material(D, w)
        r, K = at_corners(first), between_corners(second)
        self._free_edge(X, w.value, at_corners(w.gradient), r, K)
        for force in self.forces:
            force.add(X, D, self.sheet, self.formed, r, K)
        return r, K

    def _free_edge(self, X: Floats, W: Floats, dW: Floats, r: Floats, K: Floats) -> None:
        """Take the energy off that the material forces of an edge have: it carries no force. eq. (6.10)"""
        sides, owner = self.sheet.boundary, self.sheet.boundary_triangles
        along = X[sides[:, 1]] - X[sides[:, 0]]
        normal = 0.5 * np.stack([along[:, 1], -along[:, 0]], axis=1)
        corners = (self.sheet.triangles[owner][:, None, :] == sides[:, :, None]).argmax(axis=2)
        turn = 0.5 * np.array([[0.0, 1.0], [-1.0, 0.0]])
        for here in corners.T:
            for i in (0, 1):
                row = (owner, 2 * here + i)
                np.add.at(r, row, -W[owner] * normal[:, i])
                np.add.at(K, row, -normal[:, i, None] * dW[owner])
                for there, sign in zip(corners.T, (-1.0, 1.0), strict=True):
                    for j in (0, 1):
                        np.add.at(K, (*row, 2 * there + j), -W[owner] * sign * turn[i, j])


class Balance:
    """Newton's method for material forces; a uniform force and moment keep a free sheet in its place."""

    def __init__(self, problem: FlatProblem, X: Floats) -> None:
        self.problem, self.X0 = problem, X
        held = problem._supported(X)
        self.equations = Equations(len(X), problem.sheet.triangles, held, symmetric=False)
        self.solver = make_solver(self.equations.pattern)
        self.given = np.repeat(problem.held, 2)
        self.pinned = np.flatnonzero(held & ~self.given)
        share = np.bincount(problem.sheet.triangles.ravel(), np.repeat(problem.formed.area / 3.0, 3), len(X)).astype(
            float
        )
        share = share / problem.formed.area.sum()
        arm = X - share @ X
        self.motions = np.zeros((2 * len(X), 3 if len(self.pinned) else 0))
        if len(self.pinned):
            self.motions[0::2, 0] = self.motions[1::2, 1] = 1.0
            self.motions[0::2, 2], self.motions[1::2, 2] = -arm[:, 1], arm[:, 0]
        self.uniform = np.repeat(share, 2)[:, None] * self.motions

    def solve(self, X: Floats, within: float = CONVERGED) -> Floats:
        """Places of zero material forces.

        The last step is shorter than `within` times the size of the part.

        The length of a step is chosen by the step that the same matrix gives behind it, which must be shorter,
        eq. (6.14): norms of forces are those of the stiffest triangles. If that step is short enough, it is the last.

        Raises
        ------
        NoConvergence
            If no such length is found.
        """
        problem, equations = self.problem, self.equations
        r, K = problem.residual(X)
        length = 1.0
        for _ in range(_NEWTON):
            problem.iterations += 1
            self._factor(K)
            step = self._step(X, equations.vector(r))
            size = float(np.linalg.norm(step))
            reach = first_fold(X, step, problem.sheet.triangles)
            if abs(step).max() < within * problem.size:
                return X + min(reach, 1.0) * step
            length = min(1.0, 4.0 * length, _SAFE * reach)
            for _ in range(_HALVINGS):
                other = X + length * step
                r, K = problem.residual(other)
                behind = self._step(other, equations.vector(r))
                if float(np.linalg.norm(behind)) <= (1.0 - 0.25 * length) * size:
                    break
                length *= 0.5
            else:
                break
            X = other
            if abs(behind).max() < within * problem.size:
                return X + min(first_fold(X, behind, problem.sheet.triangles), 1.0) * behind
        raise _not_found("no equilibrium of the formed sheet is found", problem.iterations)

    def _factor(self, K6: Floats) -> None:
        equations, pinned = self.equations, self.pinned
        self.solver.factor(equations.matrix(K6))
        if len(pinned):
            self.border = np.concatenate([equations.columns(K6, pinned), self.uniform], axis=1)
            self.rows = np.concatenate([equations.rows(K6, pinned), self.uniform.T])
            self.others = self.solver.solve(self.border[equations.free])

    def _step(self, X: Floats, r: Floats) -> Floats:
        """Step of all points with the present factors, shape (n, 2)."""
        equations, pinned, free = self.equations, self.pinned, self.equations.free
        step = np.zeros(2 * equations.count)
        first = self.solver.solve(-r[free])
        if len(pinned):
            # Rows of the pinned unknowns, and no rigid motion from the first places.
            corner = np.zeros((6, 6))
            corner[:3] = self.border[pinned]
            corner[3:, :3] = self.uniform[pinned].T
            moved = self.uniform.T @ (X - self.X0).ravel()
            rhs = np.concatenate([-r[pinned], -moved]) - self.rows[:, free] @ first
            small = np.linalg.solve(corner - self.rows[:, free] @ self.others, rhs)
            first = first - self.others @ small
            step[pinned] = small[:3]
        step[free] = first
        return step.reshape(-1, 2)


def _of_part(area: Floats, w: Work) -> tuple[Floats, Floats]:
    """Derivatives of the energy over the formed area by the sides, (m, 4) and (m, 4, 4)."""
    return area[:, None] * w.gradient, area[:, None, None] * w.hessian


def _of_material(D: Floats, w: Work) -> tuple[Floats, Floats]:
    """Derivatives of the energy of the material by the sides, (m, 4) and (m, 4, 4)."""
    A, cofactor = areas(D), 0.5 * np.stack([D[:, 1, 1], -D[:, 1, 0], -D[:, 0, 1], D[:, 0, 0]], axis=1)
    mixed = cofactor[:, :, None] * w.gradient[:, None, :]
    hessian = A[:, None, None] * w.hessian + w.value[:, None, None] * _AREA + mixed + np.swapaxes(mixed, 1, 2)
    return A[:, None] * w.gradient + w.value[:, None] * cofactor, hessian


def first_fold(X: Floats, step: Floats, triangles: Ids) -> float:
    """Length of the step at which the first triangle has no area; infinite if none loses it."""
    D, d = flat_sides(X, triangles), flat_sides(step, triangles)
    c, a = areas(D), areas(d)
    b = 0.5 * (D[:, 0, 0] * d[:, 1, 1] + d[:, 0, 0] * D[:, 1, 1] - D[:, 0, 1] * d[:, 1, 0] - d[:, 0, 1] * D[:, 1, 0])
    inside = b * b - 4.0 * a * c
    with np.errstate(divide="ignore", invalid="ignore"):
        root = 2.0 * c / (-b + np.sqrt(np.maximum(inside, 0.0)))
    root = np.where((inside >= 0.0) & (root > 0.0), root, np.inf)
    return float(root.min())


def _positive(solver: SparseSolver, values: Floats) -> bool:
    """Factorise a matrix; whether it is positive definite."""
    try:
        return not solver.factor(values).negative_pivots
    except SingularMatrix:
        return False


def _projected(hessian: Floats) -> Floats:
    """Matrices whose small and negative eigenvalues are replaced by a small positive one."""
    values, vectors = np.linalg.eigh(hessian)
    least = _LEAST_STIFFNESS * values[:, -1:]
    return np.asarray((vectors * np.maximum(values, least)[:, None, :]) @ np.swapaxes(vectors, 1, 2))


def _not_found(what: str, iterations: int) -> NoConvergence:
    return NoConvergence(
        what,
        where="flat pattern",
        value=f"{iterations} iterations",
        cause="strains far beyond what the metal bears, or a clamped edge, or forces of binder and beads, that tear it",
        remedy="smaller forces, a finer mesh in its radii, or without forces and not clamped to see the strains",
    )
