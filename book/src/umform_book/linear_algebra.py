"""Linear problems: one solution with the tangent at u = 0."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from umform.errors import SolveError
from umform.model import Evaluation, Model
from umform.solvers import make_solver

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix

Floats = NDArray[np.float64]


def stiffness(model: Model, evaluation: Evaluation) -> csr_matrix:
    """Tangent over the unknowns of the pattern, both triangles."""
    from scipy.sparse import csr_matrix, triu  # a solution needs none of it

    pattern = model.system.pattern
    K = csr_matrix((evaluation.values, pattern.indices, pattern.indptr), shape=(pattern.n, pattern.n))
    return K + triu(K, 1).T if pattern.symmetric else K


def linear_solution(
    model: Model, loads: Floats | float = 0.0, prescribed: Floats | float = 0.0, solver: str = "auto"
) -> Floats:
    """Small displacements K u = loads.

    Parameters
    ----------
    model : Model
        The model; its loads are not looked at, only the supports.
    loads : ndarray, shape (3 n,)
        Nodal forces.
    prescribed : ndarray, shape (n, 3)
        Displacements of the held degrees of freedom; those of the free ones are not looked at.
    solver : str
        Sparse solver, see :mod:`umform.solvers`.

    Returns
    -------
    ndarray, shape (n, 3)
    """
    u = np.where(model.supports.constrained(), np.broadcast_to(prescribed, (model.u.size // 3, 3)).ravel(), 0.0)
    evaluation = model.evaluate(np.zeros(u.size), u)
    if evaluation.failed >= 0:
        raise SolveError(f"an element {evaluation.failure}", where=f"cell {evaluation.failed}")
    linear = make_solver(model.system.pattern, solver)
    linear.factor(evaluation.values)
    rhs = np.broadcast_to(loads, u.shape) - evaluation.predictor
    u += model.system.extend(linear.solve(model.system.restrict(rhs)))
    return u.reshape(-1, 3)
