"""Equations and unknowns of very different size: solved as if all were alike."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matrices import error_of, factored, grid, negative_eigenvalues, saddle, some_matrix, tangent
from scipy import sparse

from umform.errors import SolveError

KINDS = ["positive", "indefinite", "unsymmetric"]
SHAPES = {
    "chain": grid((150,), 1),
    "strip": grid((20, 3), 3),
    "scalars": grid((16, 16), 1),
    "solid": grid((4, 4, 5), 3),
    "8 nodes": tangent((9, 7)),
    "zeros on the diagonal": saddle(8, 30, 1),
}


def of_kind(shape, kind):
    """A matrix of a shape that is regular, and whether it is symmetric; None if there is none of the kind."""
    matrix = SHAPES[shape]
    if kind == "unsymmetric":
        return (matrix + 0.2 * sparse.triu(matrix, 1)).tocsr(), False
    if "zeros" in shape:
        return (matrix, True) if kind == "indefinite" else None
    if kind == "indefinite":
        down = 1e-3 * float(matrix.diagonal().mean()) if "nodes" in shape else 3.0
        matrix = (matrix - down * sparse.eye(matrix.shape[0])).tocsr()
    return matrix, True


CASES = {f"{kind}, {shape}": found for kind in KINDS for shape in SHAPES if (found := of_kind(shape, kind)) is not None}


def scaled(matrix, row, column):
    return (sparse.diags(row) @ sparse.csr_matrix(matrix) @ sparse.diags(column)).tocsr()


def scales(n, decades, seed, symmetric):
    """Factors of rows and columns, up to so many decades to either side; the same ones for both if symmetric."""
    random = np.random.default_rng(seed)
    row = 10.0 ** random.uniform(-decades, decades, n)
    return row, row if symmetric else 10.0 ** random.uniform(-decades, decades, n)


@pytest.mark.parametrize("case", list(CASES))
@settings(max_examples=8, deadline=None, derandomize=True)
@given(decades=st.floats(0.0, 12.0), seed=st.integers(0, 10**6))
def test_scaled_equations_are_solved_as_well_as_others(case, decades, seed):
    """R A C x = R b, with the answer of A y = b, x = y / C, and its inertia or sign."""
    matrix, symmetric = CASES[case]
    n = matrix.shape[0]
    row, column = scales(n, decades, seed, symmetric)
    b = np.random.default_rng(seed).normal(size=(n, 2))
    solver, told = factored(scaled(matrix, row, column), symmetric)
    y = column[:, None] * solver.solve(row[:, None] * b)
    assert error_of(matrix, y, b) < 2e-14
    expected = np.linalg.solve(matrix.toarray(), b)
    np.testing.assert_allclose(y, expected, rtol=0, atol=1e-9 * np.abs(expected).max())
    assert told.odd == (np.linalg.slogdet(matrix.toarray())[0] < 0)
    assert told.negative_pivots == (negative_eigenvalues(matrix) if symmetric else None)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(decades=st.floats(0.0, 12.0), seed=st.integers(0, 10**6), symmetric=st.booleans())
def test_any_sparsity_in_any_scale(decades, seed, symmetric):
    """With a diagonal, which may be weak: solved to rounding with the right inertia and sign, or refused."""
    matrix = some_matrix(seed, symmetric)
    n = len(matrix)
    signs = np.random.default_rng(seed).choice([-0.3, 0.3], n)
    matrix += np.diag(np.where(np.diag(matrix) == 0.0, signs, 0.0))
    row, column = scales(n, decades, seed, symmetric)
    sizes = np.linalg.svd(matrix, compute_uv=False)
    try:
        solver, told = factored(matrix * np.outer(row, column), symmetric)
        y = column * solver.solve(row)
    except SolveError:
        assert sizes[-1] < 1e-9 * sizes[0]
        return
    if sizes[-1] > 1e-9 * sizes[0]:
        assert error_of(matrix, y, np.ones(n)) < 1e-11
        assert told.odd == (np.linalg.slogdet(matrix)[0] < 0)
        assert told.negative_pivots == (negative_eigenvalues(matrix) if symmetric else None)


@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("seed", range(8))
def test_without_any_diagonal_units_24_decades_apart_are_found(seed, symmetric):
    """Sparse, with zeros on the diagonal and nothing to begin with: all entries are made alike in the mean."""
    random = np.random.default_rng(seed)
    n = 60
    matrix = sparse.random(
        n, n, density=0.05, random_state=random, data_rvs=lambda k: random.uniform(0.5, 2.0, k)
    ).toarray()
    matrix[np.arange(n), random.permutation(n)] += 4.0
    matrix = matrix + matrix.T if symmetric else matrix
    np.fill_diagonal(matrix, 0.0)
    sizes = np.linalg.svd(matrix, compute_uv=False)
    if sizes[-1] < 1e-9 * sizes[0]:
        pytest.skip("singular in any unit")
    row, column = scales(n, 12.0, seed, symmetric)
    solver, told = factored(matrix * np.outer(row, column), symmetric)
    y = column * solver.solve(row)
    assert error_of(matrix, y, np.ones(n)) < 1e-11
    assert told.odd == (np.linalg.slogdet(matrix)[0] < 0)


@pytest.mark.parametrize("case", list(CASES))
def test_scales_by_powers_of_two_do_not_change_a_bit(case):
    """Whatever the units are, the same matrix is eliminated."""
    matrix, symmetric = CASES[case]
    n = matrix.shape[0]
    answers = []
    for seed in (1, 2):
        scale = 2.0 ** np.random.default_rng(seed).integers(-30, 31, n)
        solver, told = factored(scaled(matrix, scale, scale), symmetric)
        y = scale * solver.solve(scale)
        answers.append((told.negative_pivots, told.odd, y))
        assert (solver._factors.scales[0].size > 0) == (not case.startswith("positive"))
    (*one, x), (*other, y) = answers
    assert one == other
    np.testing.assert_array_equal(x, y)


@pytest.mark.parametrize("case", [case for case in CASES if not case.startswith("positive")])
def test_what_is_eliminated_has_rows_and_columns_alike(case):
    matrix, symmetric = CASES[case]
    row, column = scales(matrix.shape[0], 12.0, 3, symmetric)
    whole = scaled(matrix, row, column)
    solver, _ = factored(whole, symmetric)
    r, c = solver._factors.scales
    for factor in (r, c):
        np.testing.assert_array_equal(np.frexp(factor)[0], 0.5)
    if symmetric:
        np.testing.assert_array_equal(r, c)
    balanced = np.abs(scaled(whole, r, c))
    largest = np.r_[balanced.max(axis=0).toarray().ravel(), balanced.max(axis=1).toarray().ravel()]
    assert 0.1 < largest.min() <= largest.max() < 16.0
    np.testing.assert_allclose(solver._factors.column_sizes, largest[: matrix.shape[0]], rtol=1e-15)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("cell", ["hex8", "hex18"])
def test_tangents_of_sheets_stay_as_they_are(kind, cell):
    matrix = tangent((8, 4), cell)
    if kind == "unsymmetric":
        matrix = matrix + 0.2 * sparse.triu(matrix, 1)
    elif kind == "indefinite":
        matrix = matrix - 1e-3 * float(matrix.diagonal().mean()) * sparse.eye(matrix.shape[0])
    solver, told = factored(matrix, kind != "unsymmetric")
    assert kind != "indefinite" or told.negative_pivots > 0
    assert solver._factors.scales[0].size == solver._factors.scales[1].size == 0


def test_one_huge_entry_hides_nothing():
    """Entries up to 1.7e308 beside others of 1e300: what would overflow in the elimination does not."""
    matrix = grid((6, 6), 2).toarray()
    matrix[0, 1] = matrix[1, 0] = 1.7e8
    solver, told = factored(1e300 * matrix)
    x = solver.solve(np.full(72, 1e300))
    np.testing.assert_allclose(x, np.linalg.solve(matrix, np.ones(72)), rtol=1e-12)
    assert told.negative_pivots == 1


@pytest.mark.parametrize("symmetric", [True, False])
def test_a_loose_part_in_small_units_is_singular_still(symmetric):
    """Each row sums up to nothing, in units in which all of that part is small."""
    held, free = grid((8, 8), 2), grid((7, 7), 2)
    free = (free - sparse.eye(98)).tocsr()
    matrix = sparse.block_diag([held, free]).tocsr()
    row, column = scales(226, 12.0, 5, symmetric)
    row[128:] *= 1e-12
    with pytest.raises(SolveError, match="singular") as caught:
        factored(scaled(matrix, row, row if symmetric else column), symmetric)
    assert 128 <= caught.value.value < 226
