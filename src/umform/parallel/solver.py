"""PETSc as a sparse solver: MUMPS by default, on the ranks that share a model.

A matrix is assembled from the parts of all ranks. Symmetric ones are stored in full: MUMPS uses one triangle, and
iterative solvers and multigrid need both. Options of PETSc with the prefix ``-umform_`` override the defaults.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from umform.errors import InvalidValue, NotFinite, SolveError
from umform.parallel.coo import preallocate, set_values
from umform.parallel.numbering import SharedPattern
from umform.parallel.petsc import PREFIX, petsc
from umform.solvers.protocol import Factorisation, FloatArray, Pattern, check_accuracy, not_factored, singular

#: ICNTL(13) = 1: no ScaLAPACK at the root, so that the count of negative pivots is exact; ICNTL(14): part of the work
#: space beyond the estimate, in per cent; ICNTL(24) = 1, CNTL(3): a pivot below this part of the matrix, which MUMPS
#: has scaled, is nothing but rounding error, as for SuperLU. KSP: what an iterative solver is asked for.
_DEFAULTS = {
    "mat_mumps_icntl_13": 1,
    "mat_mumps_icntl_14": 40,
    "mat_mumps_icntl_24": 1,
    "mat_mumps_cntl_3": 1e-13,
    "ksp_rtol": 1e-10,
    "ksp_max_it": 2000,
}
#: INFOG(1) of MUMPS: estimated work space too small; all other errors are final.
_TOO_SMALL = (-8, -9, -14, -15, -17, -20)
_NUMERICALLY_SINGULAR, _RETRIES = -10, 4
#: Backward error above which a step of iterative refinement is made.
_POOR_RESIDUAL = 1e-14


class Petsc:
    """A KSP of PETSc; by default MUMPS with LDL^T, or LU where the matrix is not symmetric."""

    name = "petsc"

    def analyse(self, pattern: Pattern) -> None:
        """Create the matrix and the solver; PETSc orders and plans at the first factorisation.

        Raises
        ------
        InvalidValue
            If the pattern is not that of a model that ranks share.
        """
        if not isinstance(pattern, SharedPattern):
            raise InvalidValue(
                "the solver 'petsc' takes the matrices of a model that ranks share",
                remedy="solve(..., solver='petsc') shares a model; else choose another solver",
            )
        PETSc = petsc()
        self._pattern, self._ready = pattern, False
        comm, size = pattern.ranks.petsc_comm, ((pattern.own, None), (pattern.own, None))
        numbers = pattern.numbers.astype(PETSc.IntType)
        i, j = numbers[pattern.rows], numbers[pattern.indices]
        self._mirrored = np.flatnonzero(i != j) if pattern.symmetric else np.empty(0, dtype=np.int64)
        self._matrix = PETSc.Mat().create(comm)
        self._matrix.setSizes(size)
        self._matrix.setOptionsPrefix(PREFIX)
        self._matrix.setType("aij")
        self._matrix.setFromOptions()
        preallocate(self._matrix, np.concatenate([i, j[self._mirrored]]), np.concatenate([j, i[self._mirrored]]))
        self._matrix.setOption(PETSc.Mat.Option.SYMMETRIC, pattern.symmetric)
        self._right, self._left = self._matrix.createVecs()
        self._ksp = self._solver(pattern)

    def _solver(self, pattern: SharedPattern) -> Any:
        PETSc = petsc()
        options = PETSc.Options(PREFIX)
        for name, value in _DEFAULTS.items():
            if not options.hasName(name):
                options[name] = value
        ksp = PETSc.KSP().create(pattern.ranks.petsc_comm)
        ksp.setOptionsPrefix(PREFIX)
        ksp.setType("preonly")
        ksp.pc.setType("cholesky" if pattern.symmetric else "lu")
        ksp.pc.setFactorSolverType("mumps")
        ksp.setOperators(self._matrix)
        ksp.setFromOptions()
        self._factors = ksp.pc.getType() in ("cholesky", "lu")
        self._mumps = self._factors and ksp.pc.getFactorSolverType() == "mumps"
        self._direct = ksp.getType() == "preonly" and self._factors
        if not self._factors:
            self._matrix.setNearNullSpace(self._rigid_body_modes(pattern))
        return ksp

    def _rigid_body_modes(self, pattern: SharedPattern) -> Any:
        """The rigid-body modes at the unknowns as orthonormal vectors, for algebraic multigrid."""
        PETSc = petsc()
        modes, ranks = pattern.modes(), pattern.ranks
        values, directions = np.linalg.eigh(ranks.sum(modes @ modes.T))
        kept = values > 1e-12 * values.max()
        basis = (directions[:, kept] / np.sqrt(values[kept])).T @ modes
        vectors = [PETSc.Vec().createWithArray(np.ascontiguousarray(row), comm=ranks.petsc_comm) for row in basis]
        return PETSc.NullSpace().create(vectors=[vector.copy() for vector in vectors], comm=ranks.petsc_comm)

    def factor(self, values: FloatArray) -> Factorisation:
        """Assemble the matrix and factorise it, or set the preconditioner up."""
        self._ready, ranks = False, self._pattern.ranks
        if ranks.any(not np.isfinite(values).all()):
            raise NotFinite(
                "The matrix holds a value that is not finite",
                cause="an element or a contact point has left the range of its formulas",
                remedy="take a smaller step",
            )
        set_values(self._matrix, np.concatenate([values, values[self._mirrored]]))
        self._ksp.setOperators(self._matrix)
        self._ksp.setUp()
        found = self._mumps_found() if self._mumps else Factorisation(None, 0)
        self._ready, self._size = True, float(self._matrix.norm(petsc().NormType.NORM_INFINITY))
        return found

    def _mumps_found(self) -> Factorisation:
        """Information from MUMPS; if its estimate of the work space was too small, it gets more."""
        for _ in range(_RETRIES):
            factors = self._ksp.pc.getFactorMatrix()
            status = factors.getMumpsInfog(1)
            if status not in _TOO_SMALL:
                break
            factors.setMumpsIcntl(14, 2 * factors.getMumpsIcntl(14) + 20)
            self._matrix.stateIncrease()
            self._ksp.setOperators(self._matrix)
            self._ksp.setUp()
        if status == _NUMERICALLY_SINGULAR or (status >= 0 and factors.getMumpsInfog(28) > 0):
            raise singular(self.name, None)
        if status < 0:
            raise SolveError(
                "MUMPS has failed",
                value=f"INFOG(1) = {status}, INFOG(2) = {factors.getMumpsInfog(2)}",
                cause="too little memory: see INFOG(1) in its manual",
                remedy="more ranks on more machines, or less memory by -umform_mat_mumps_icntl_22 1 (out of core)",
            )
        negative = factors.getMumpsInfog(12) if self._pattern.symmetric else None
        fill = factors.getMumpsInfog(29)
        return Factorisation(negative, fill if fill >= 0 else -1_000_000 * fill)

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solve for the unknowns of all ranks, each with its part of the right-hand side.

        Raises
        ------
        SolveError
            If an iterative solver does not converge, or the solution is not accurate.
        """
        if not self._ready:
            raise not_factored()
        if rhs.ndim == 2:
            return np.stack([self.solve(column) for column in rhs.T], axis=1)
        b, x = self._left, self._right
        b.array[:] = rhs
        self._ksp.solve(b, x)
        reason = self._ksp.getConvergedReason()
        if reason < 0:
            raise SolveError(
                "the linear solver of PETSc did not converge",
                value=f"reason {reason} after {self._ksp.getIterationNumber()} iterations",
                cause="multigrid and other preconditioners are weak for thin sheets",
                remedy="leave out -umform_ksp_type and -umform_pc_type: MUMPS; or -umform_ksp_max_it",
            )
        if self._direct:
            self._refine(b, x)
        return np.array(x.array)

    def _refine(self, b: Any, x: Any) -> None:
        """One step of iterative refinement if the residual is large, and a check of the rest."""
        residual = b.duplicate()
        if self._backward_error(b, x, residual) > _POOR_RESIDUAL:
            change = x.duplicate()
            self._ksp.solve(residual, change)
            x.axpy(1.0, change)
            check_accuracy(self.name, self._backward_error(b, x, residual))

    def _backward_error(self, b: Any, x: Any, residual: Any) -> float:
        """Residual b - K x, and its norm relative to |K| |x| + |b|."""
        largest = petsc().NormType.NORM_INFINITY
        self._matrix.mult(x, residual)
        residual.aypx(-1.0, b)
        whole = self._size * x.norm(largest) + b.norm(largest)
        return float(residual.norm(largest)) / whole if whole > 0.0 else 0.0
