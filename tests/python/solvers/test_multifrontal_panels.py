"""Large fronts, whose columns are stored by panels from the diagonal, and the memory of the factors."""

from __future__ import annotations

import numpy as np
import pytest
from matrices import error_of, factored, grid, negative_eigenvalues, stored
from scipy import sparse

from umform.solvers.multifrontal import Multifrontal


def check(matrix, columns, limit=1e-13):
    solver, told = factored(matrix)
    b = np.random.default_rng(1).normal(size=(matrix.shape[0], columns))
    assert error_of(matrix, solver.solve(b), b) < limit
    return told.negative_pivots


@pytest.mark.parametrize("columns", [1, 3])
@pytest.mark.parametrize("n", [97, 192, 500])
def test_one_dense_front(n, columns, rng):
    """Of one panel and a column, of two, of many; positive and indefinite."""
    dense = rng.normal(size=(n, n))
    assert check(dense @ dense.T + np.eye(n), columns) == 0
    dense += dense.T
    assert check(dense, columns) == negative_eigenvalues(dense) > 0


@pytest.mark.parametrize("zeros", [20, 70, 130, 200])
def test_pivots_that_fail_go_behind_other_panels(zeros, rng):
    """No pivot within the first columns: each pairs with a column in another panel, behind zeros that are left."""
    n = 420
    dense = rng.normal(size=(n, n))
    dense += dense.T
    dense[:zeros, : n - zeros] = dense[: n - zeros, :zeros] = 0.0
    assert check(dense, 2) == negative_eigenvalues(dense)
    dense[220 : 220 + zeros // 2, 220 : 220 + zeros // 2] = 0.0
    assert check(dense, 1) == negative_eigenvalues(dense)


def test_columns_that_children_leave_to_a_large_front():
    """Of a positive definite A each row of B gives one negative eigenvalue; its pivot is delayed."""
    stiffness, held = grid((9, 9, 9), 3), 150
    random = np.random.default_rng(3)
    border = sparse.random(held, stiffness.shape[0], density=0.002, random_state=random, format="csr")
    ones = (np.ones(held), (np.arange(held), random.permutation(stiffness.shape[0])[:held]))
    border = border + sparse.csr_matrix(ones, shape=border.shape)
    matrix = sparse.bmat([[stiffness, border.T], [border, None]]).tocsr()
    assert check(matrix, 2) == held


def test_the_memory_is_little_more_than_the_factors():
    """Less above the diagonal of the pivots than a fifteenth of all; updates partly where the last front will be."""
    pattern, values = stored(grid((90, 90), 3))
    solver = Multifrontal()
    solver.analyse(pattern)
    told = solver.factor(values)
    assert 8 * told.fill < solver._factors.bytes < 1.2 * 8 * told.fill


def test_a_factorisation_that_ends_early_leaves_nothing_behind():
    """Its updates are given up; the next one has all memory, and the same bits as the first."""
    matrix = grid((40, 40), 3)
    pattern, values = stored(matrix)
    solver, told = factored(matrix)
    b = np.ones(pattern.n)
    before, memory = solver.solve(b), solver._factors.bytes
    down = stored(matrix - 0.5 * float(matrix.diagonal().mean()) * sparse.eye(pattern.n))[1]
    for _ in range(3):
        assert solver.factor(down).negative_pivots > 0
    solver.recall(1)
    assert solver.factor(values).fill == told.fill
    assert solver._factors.bytes == memory
    assert np.array_equal(solver.solve(b), before)
