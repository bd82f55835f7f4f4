"""The tangent as a sparse matrix of SciPy, and enhanced parameters in equilibrium at a displacement."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, ModelError, NoConvergence
from umform.model.contact.encounter import sheet_thickness
from umform.model.equations.evaluation import Evaluation

if TYPE_CHECKING:
    from scipy import sparse

    from umform.model.equations.evaluated import Evaluated
    from umform.model.terms.state import State

Floats = NDArray[np.float64]

log = logging.getLogger("umform.model")

#: Most recoveries at one displacement, and the change at which they end, relative to their size.
_MOST, _AT_REST = 40, 1e-12
#: Pending change of the enhanced parameters that is reported: relative to them, and to the square of the thickness.
_PENDING, _SMALL = 1e-8, 1e-12


def sparse_tangent(system: Evaluated, evaluation: Evaluation) -> sparse.csr_matrix:
    """Derivative of the restricted residual with respect to the unknowns, shape (n + k, n + k). eqs. (5.18), (5.48)

    Raises
    ------
    InvalidValue
        If the evaluation is of forces only.
    ModelError
        If ranks share the model.
    """
    from scipy import sparse  # the import is slow

    if system.ranks.size > 1:
        raise ModelError(
            "the tangent of a model that ranks share is in no single process",
            cause="a run with the solver petsc",
            remedy="the same model in one process",
        )
    pattern, values = system.pattern, evaluation.values
    if values.shape != (pattern.nnz,):
        raise InvalidValue(
            "this evaluation has no tangent of the present unknowns",
            where="tangent",
            value=f"{values.size} entries, {pattern.nnz} in the pattern",
            cause="an evaluation with tangent=False, or one from before a change of the supports",
            remedy="model.evaluate(state), without tangent=False",
        )
    stored = sparse.csr_matrix((values, pattern.indices, pattern.indptr), shape=(pattern.n, pattern.n))
    K = stored if not pattern.symmetric else (stored + sparse.triu(stored, 1).T).tocsr()
    border = evaluation.border
    if not border.unknowns:
        return K
    n = system.u.size
    supports = np.stack([system.displacement_of_supports(unknown.rates) for unknown in border.unknowns])
    columns = np.stack([system.restrict(column[:n]) for column in border.columns], axis=1)
    rows = np.stack([system.restrict(row[:n]) for row in border.rows])
    whole: sparse.csr_matrix = sparse.bmat([[K, columns], [rows, border.corner + border.rows @ supports.T]]).tocsr()
    return whole


def enhanced_change(evaluation: Evaluation) -> float:
    """Largest change of an enhanced parameter that a recovery without a displacement makes; 0 in equilibrium."""
    return max((getattr(one, "enhanced_change", 0.0) for one in evaluation.found.values()), default=0.0)


def _size(system: Evaluated) -> float:
    """Largest converged enhanced parameter."""
    return max((float(np.abs(body.block.alpha).max(initial=0.0)) for body in system.bodies), default=0.0)


def settled(system: Evaluated, state: State) -> Evaluation:
    """Evaluate with the enhanced parameters in equilibrium at the displacement of a state. eq. (2.19)

    Raises
    ------
    NoConvergence
        If they do not come to rest, or a cell fails.
    """
    evaluation, rest, total = system.evaluate(state), np.zeros(system.u.size), _size(system)
    for _ in range(_MOST):
        change = enhanced_change(evaluation)
        total += change
        if evaluation.failed < 0 and change <= _AT_REST * total:
            return evaluation
        if evaluation.failed >= 0:
            break
        system.recover(rest)
        evaluation = system.evaluate(state)
    failure = f"cell {evaluation.failed} {evaluation.failure}" if evaluation.failed >= 0 else f"{_MOST} recoveries"
    for term in system.terms:
        term.revert()  # the next displacement begins with converged parameters, not with these
    raise NoConvergence(
        "the enhanced parameters have no equilibrium at this displacement",
        where="settle",
        value=failure,
        cause="a displacement far from the converged state, or one that turns a cell inside out",
        remedy="settle at displacements in between",
    )


def warn_of_pending(system: Evaluated, evaluation: Evaluation) -> bool:
    """Warn if enhanced parameters belong to another displacement or law; whether it did."""
    change, size = enhanced_change(evaluation), _size(system)
    cells = system.mesh.connectivity
    thickness = sheet_thickness(system.mesh) if len(cells) else 0.0  # of this rank: others may not ask
    if evaluation.failed >= 0 or change <= _PENDING * size + _SMALL * thickness**2:
        return False
    log.warning(
        "enhanced parameters are not in equilibrium at this displacement: the residual depends on what was evaluated "
        "before (largest change to come %.2g, largest parameter %.2g); model.system.recover(du) after u += du, or "
        "model.system.settle(state): docs/residual-and-tangent.md",
        change,
        size,
    )
    return True
