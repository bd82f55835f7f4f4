"""Negative eigenvalues of the symmetric part of an unsymmetric matrix. eq. (5.101)"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from umform.analysis.newton.bordered import Bordered
from umform.analysis.newton.shift import Shift
from umform.analysis.newton.symmetric_part import SymmetricPart
from umform.analysis.newton.timed_solver import TimedSolver
from umform.ranks import OneRank
from umform.solvers import Pattern, make_solver
from umform.timing import Timing

N = 24


def unsymmetric(weakest):
    """A banded matrix whose symmetric part may have negative eigenvalues, with its pattern and values."""
    rng = np.random.default_rng(7)
    K = np.diag(np.where(np.arange(N) % 8 == 3, weakest, 50.0 + rng.random(N)))
    for k in (1, 5):
        K += np.diag(rng.normal(size=N - k), k) + np.diag(rng.normal(size=N - k), -k)
    rows, columns = np.nonzero(K)
    starts = np.concatenate([[0], np.cumsum(np.bincount(rows, minlength=N))])
    pattern = Pattern(N, starts.astype(np.int32), columns.astype(np.int32), symmetric=False)
    return K, pattern, K[rows, columns]


@pytest.mark.parametrize(("weakest", "number"), [(40.0, 0), (-3.0, 3), (-60.0, 3)])
def test_negative_eigenvalues_of_the_symmetric_part_are_counted(weakest, number):
    K, pattern, values = unsymmetric(weakest)
    assert np.count_nonzero(np.linalg.eigvalsh(0.5 * (K + K.T)) < 0.0) == number
    assert SymmetricPart(pattern).negative_pivots(values) == number


def test_both_triangles_count():
    """The skew part of this matrix is large: either triangle alone would be indefinite, the symmetric part is not."""
    pattern = Pattern(2, np.array([0, 2, 4], np.int32), np.array([0, 1, 0, 1], np.int32), symmetric=False)
    assert SymmetricPart(pattern).negative_pivots(np.array([1.0, 9.0, -9.0, 1.0])) == 0
    assert SymmetricPart(pattern).negative_pivots(np.array([1.0, 0.0, 9.0, 1.0])) == 1


def test_a_singular_symmetric_part_is_not_positive_definite():
    pattern = Pattern(2, np.array([0, 2, 4], np.int32), np.array([0, 1, 0, 1], np.int32), symmetric=False)
    assert SymmetricPart(pattern).negative_pivots(np.array([0.0, 1.0, -1.0, 1.0])) >= 1


def test_shifted_unsymmetric_tangents_go_downhill_whatever_the_residual():
    K, pattern, values = unsymmetric(-3.0)
    system = SimpleNamespace(pattern=pattern, largest_entry=lambda v: float(np.abs(v).max()), ranks=OneRank())
    evaluation = SimpleNamespace(values=values, border=SimpleNamespace(unknowns=()))
    solver, shift = Bordered(system, TimedSolver(make_solver(pattern), Timing())), Shift(system)
    assert shift.negative_pivots(evaluation, None) == 3
    residuals = np.random.default_rng(3).normal(size=(50, N))
    solver.factor(evaluation)
    assert any(r @ solver.solve(-r) > 0.0 for r in residuals)
    shift.factor(solver, evaluation)
    assert all(r @ solver.solve(-r) < 0.0 for r in residuals)
    du = solver.solve(-residuals[0])
    added = (-residuals[0] - K @ du) / du
    np.testing.assert_allclose(added, np.full(N, added[0]), rtol=1e-6)
