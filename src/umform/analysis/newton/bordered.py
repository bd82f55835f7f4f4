"""Bordered linear systems: scalar unknowns beside those at the nodes, solved with the factors of the tangent.

[K B; C D] [q; z] = [r; s]: K is factorised, and a small dense system of the scalar unknowns remains. eq. (5.48)
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.system import Border, Evaluation, System
from umform.analysis.newton.timed_solver import TimedSolver
from umform.errors import SingularMatrix
from umform.solvers import Factorisation

Floats = NDArray[np.float64]


class Bordered:
    """A sparse solver with the rows and columns of scalar unknowns; without any, the plain solver.

    Parameters
    ----------
    system : System
        Restricts rows and columns to the unknowns, and sums them over the ranks.
    solver : TimedSolver
        Solver that has analysed the pattern at the nodes.

    Attributes
    ----------
    weak : ndarray, shape (n,), optional
        The displacement that the tangent of a very thin sheet hardly resists, once it has been met.
    """

    def __init__(self, system: System, solver: TimedSolver) -> None:
        self.system, self.solver = system, solver
        self._border: Border | None = None
        self._eliminated = False
        self.weak: Floats | None = None

    def factor(self, evaluation: Evaluation, values: Floats | None = None) -> Factorisation:
        """Factorise the tangent of an evaluation, or other values.

        Raises
        ------
        SingularMatrix
            If the tangent is singular, unless it is that of a very thin sheet without a mechanism. eq. (5.99)
        """
        values = evaluation.values if values is None else values
        try:
            found = self.solver.factor(values)
        except SingularMatrix as refusal:
            found, self.weak = self._accepted(refusal, values), refusal.motion
        self._border, self._eliminated = evaluation.border if evaluation.border.unknowns else None, False
        return found

    def _accepted(self, refusal: SingularMatrix, values: Floats) -> Factorisation:
        """Factors of the tangent of a very thin sheet; or raise the error, which then names the mechanism."""
        if refusal.motion is None:
            raise refusal
        motion = self.system.mechanism(values, refusal.motion)
        accepted = self.solver.accept() if motion is None else None
        if accepted is None:
            refusal.motion = refusal.motion if motion is None else motion
            raise refusal
        return accepted

    def _eliminate(self, border: Border, at_nodes: Floats) -> Floats:
        """Eliminate the nodal unknowns from the border, together with a first right-hand side; return its solution."""
        system, ranks = self.system, self.system.ranks
        columns = [system.restrict(column) for column in border.columns]
        solved = self.solver.solve(np.stack([at_nodes, *columns], axis=1))
        self._rows, self._columns = np.stack([system.restrict(row) for row in border.rows]), solved[:, 1:]
        supports = np.stack([system.displacement_of_supports(unknown.rates) for unknown in border.unknowns])
        corner = border.corner + ranks.sum(border.rows @ supports.T)
        self._schur = corner - ranks.sum(self._rows @ self._columns)
        self._check([unknown.what for unknown in border.unknowns], corner)
        self._eliminated = True
        return solved[:, 0]

    def _check(self, what: list[str], corner: Floats) -> None:
        """Reject undetermined scalar unknowns, by name."""
        scale = np.abs(corner).max(initial=0.0)
        finite = bool(np.isfinite(self._schur).all())
        _, sizes, directions = np.linalg.svd(self._schur if finite else np.zeros_like(self._schur))
        if not sizes[-1] > 1e-13 * max(scale, sizes[0]):
            loose = what[int(np.abs(directions[-1]).argmax())]
            raise SingularMatrix(
                f"{loose} is not determined: the sheet does not answer to it any more",
                cause="nothing holds a tool: it does not touch the sheet, or the sheet itself is not held",
                remedy="Close the tool, which takes it to the sheet first; or hold it by a spring",
            )

    def solve(self, rhs: Floats) -> Floats:
        """Solve for the nodal unknowns followed by the scalar ones; shape (n + k,) or (n + k, m).

        Raises
        ------
        SingularMatrix
            If the scalar unknowns are not determined: nothing supports a tool.
        """
        if self._border is None:
            return self.solver.solve(rhs)
        if rhs.ndim == 2:
            return np.stack([self.solve(column) for column in rhs.T], axis=1)
        ranks, first, count = self.system.ranks, self.system.ranks.rank == 0, len(self._border.unknowns)
        at_nodes = np.ascontiguousarray(rhs[:-count] if first else rhs)
        below = ranks.sum(rhs[-count:].copy() if first else np.zeros(count))
        q = self.solver.solve(at_nodes) if self._eliminated else self._eliminate(self._border, at_nodes)
        z = np.linalg.solve(self._schur, below - ranks.sum(self._rows @ q))
        q = q - self._columns @ z
        return np.concatenate([q, z]) if first else q
