"""The multifrontal solver against SciPy: solutions to round-off times condition, patterns drawn by hypothesis."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matrices import error_of, factored, grid, tangent
from scipy import sparse
from scipy.linalg import ldl
from scipy.sparse.linalg import spsolve

from umform.errors import SolveError

EPS = float(np.finfo(np.float64).eps)
SHAPES = {
    "sheet": lambda: grid((10, 10), 3),
    "stack": lambda: grid((6, 6, 3), 2),
    "8 nodes": lambda: tangent((8, 5)),
    "18 nodes": lambda: tangent((3, 2), "hex18"),
}


def near_singular(matrix, kind, gap):
    """A matrix of this kind with an eigenvalue of about this part of the largest."""
    identity = sparse.eye(matrix.shape[0])
    if kind == "unsymmetric":
        matrix = matrix + 0.05 * sparse.triu(matrix, 1)
    values = np.linalg.eigvals(matrix.toarray()) if kind == "unsymmetric" else np.linalg.eigvalsh(matrix.toarray())
    real = np.sort(values[np.abs(values.imag) < 1e-12 * np.abs(values).max()].real)
    eigenvalue = real[len(real) // 10 if kind == "indefinite" else 0]
    return (matrix - (eigenvalue - gap * np.abs(values).max()) * identity).tocsr()


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9, 1e-11])
@pytest.mark.parametrize("kind", ["positive", "indefinite", "unsymmetric"])
@pytest.mark.parametrize("shape", list(SHAPES))
def test_solutions_agree_to_round_off_times_condition(shape, kind, gap, rng):
    matrix = near_singular(SHAPES[shape](), kind, gap)
    condition = np.linalg.cond(matrix.toarray())
    assert condition > 0.1 / gap
    b = rng.normal(size=matrix.shape[0])
    x, expected = factored(matrix, kind != "unsymmetric")[0].solve(b), spsolve(matrix.tocsc(), b)
    assert np.linalg.norm(x - expected) < EPS * condition * np.linalg.norm(expected)


@st.composite
def sparse_matrices(draw):
    """A diagonal with zeros, and pairs and values drawn one by one, symmetric or not; they may vanish or be tiny."""
    n, symmetric = draw(st.integers(1, 12)), draw(st.booleans())
    place = st.integers(0, n - 1)
    entry = st.floats(-4.0, 4.0).map(lambda value: float(np.float32(value)))
    matrix = np.diag(draw(st.lists(st.sampled_from([0.0, 1.0, -2.0, 5.0]), min_size=n, max_size=n)))
    for i, j, value in draw(st.lists(st.tuples(place, place, entry), max_size=4 * n)):
        matrix[i, j] = value
        if symmetric:
            matrix[j, i] = value
    return matrix, symmetric


@settings(max_examples=150, deadline=None, derandomize=True)
@given(sparse_matrices())
def test_a_drawn_pattern_is_solved_with_the_inertia_of_lapack_or_refused(drawn):
    matrix, symmetric = drawn
    n = len(matrix)
    sizes = np.linalg.svd(matrix, compute_uv=False)
    try:
        solver, told = factored(matrix, symmetric)
        x = solver.solve(np.ones(n))
    except SolveError:
        assert sizes[-1] <= 1e-9 * sizes[0]
        return
    assert error_of(matrix, x, np.ones(n)) < 1e-12
    if sizes[-1] > 1e-9 * sizes[0]:
        expected = np.linalg.solve(matrix, np.ones(n))
        assert np.linalg.norm(x - expected) <= 100.0 * EPS * sizes[0] / sizes[-1] * np.linalg.norm(expected)
        assert told.odd == (np.linalg.slogdet(matrix)[0] < 0)
        if symmetric:
            assert told.negative_pivots == np.count_nonzero(np.linalg.eigvalsh(ldl(matrix)[1]) < 0)
