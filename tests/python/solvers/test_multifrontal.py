"""The multifrontal solver against dense algebra, on matrices of every kind."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matrices import error_of, factored, grid, negative_eigenvalues, saddle, some_matrix, stored, tangent
from scipy import sparse
from scipy.sparse.linalg import spsolve

from umform.errors import SingularMatrix, SolveError
from umform.solvers import make_solver, multifrontal
from umform.solvers.multifrontal import Multifrontal

SHAPES = {
    "chain": lambda: grid((60,), 1),
    "strip": lambda: grid((20, 3), 3),
    "sheet": lambda: grid((12, 12), 3),
    "sheet of scalars": lambda: grid((20, 20), 1),
    "solid": lambda: grid((5, 5, 5), 3),
    "stack": lambda: grid((8, 8, 3), 2),
    "8 nodes": lambda: tangent((9, 7)),
    "18 nodes": lambda: tangent((4, 3), "hex18"),
}
#: Too large for dense algebra: more than one unit of the schedule, solids that are parted, blocks that are halved.
LARGE = {
    "8 nodes": lambda: tangent((40, 30)),
    "18 nodes": lambda: tangent((20, 12), "hex18"),
    "solid": lambda: grid((11, 11, 11), 3),
    "slab": lambda: grid((22, 22, 7), 3),
    "scalars": lambda: grid((60, 60), 1),
    "no shape": lambda: scattered(1500),
}


def scattered(n):
    """Entries anywhere, three in a row on average."""
    matrix = sparse.random(n, n, density=1.5 / n, random_state=0, format="csr")
    return (matrix + matrix.T + 4.0 * sparse.eye(n)).tocsr()


@pytest.fixture(scope="module", params=list(SHAPES))
def matrix(request):
    return SHAPES[request.param]()


def test_positive_definite(matrix, rng):
    solver, told = factored(matrix)
    b = rng.normal(size=(matrix.shape[0], 3))
    x = solver.solve(b)
    assert error_of(matrix, x, b) < 1e-14
    np.testing.assert_allclose(x[:, 0], spsolve(matrix.tocsc(), b[:, 0]), rtol=0, atol=1e-9 * np.abs(x).max())
    assert told.negative_pivots == 0
    assert told.odd is False


@pytest.mark.parametrize("share", [0.02, 0.3])
def test_indefinite(matrix, share, rng):
    """Moved down so far that this share of the eigenvalues is negative."""
    spectrum = np.linalg.eigvalsh(matrix.toarray())
    moved = matrix - float(np.quantile(spectrum, share)) * sparse.eye(matrix.shape[0])
    solver, told = factored(moved)
    b = rng.normal(size=matrix.shape[0])
    assert error_of(moved, solver.solve(b), b) < 1e-13
    assert told.negative_pivots == negative_eigenvalues(moved) > 0
    assert told.odd == (told.negative_pivots % 2 == 1)


def test_unsymmetric(matrix, rng):
    skew = sparse.triu(matrix, 1) * 0.4
    whole = (matrix + skew - skew.T).tocsr()
    solver, told = factored(whole, symmetric=False)
    b = rng.normal(size=(matrix.shape[0], 2))
    assert error_of(whole, solver.solve(b), b) < 1e-13
    assert told.negative_pivots is None
    assert told.odd == (np.linalg.slogdet(whole.toarray())[0] < 0)


@pytest.mark.parametrize("shape", list(LARGE))
@pytest.mark.parametrize("kind", ["positive", "indefinite", "unsymmetric"])
def test_large(shape, kind, rng):
    """Against SuperLU: the inertia or the sign of the determinant."""
    matrix = LARGE[shape]()
    if kind == "indefinite":
        down = 1e-4 * float(matrix.diagonal().mean()) if "nodes" in shape else 4.5
        matrix = matrix - down * sparse.eye(matrix.shape[0])
    elif kind == "unsymmetric":
        matrix = (matrix + 0.3 * sparse.triu(matrix, 1)).tocsr()
    pattern, values = stored(matrix, kind != "unsymmetric")
    solver, other = Multifrontal(), make_solver(pattern, "superlu")
    solver.analyse(pattern)
    told, expected = solver.factor(values), other.factor(values)
    b = rng.normal(size=(pattern.n, 2))
    assert error_of(matrix, solver.solve(b), b) < 1e-14
    assert told.odd == expected.odd
    if expected.negative_pivots is not None:  # SuperLU's pivots may leave the diagonal
        assert told.negative_pivots == expected.negative_pivots
    if kind == "indefinite":
        assert told.negative_pivots > 0


# Pivots that are not stable where they would come ---------------------------------------------------------


@pytest.mark.parametrize("seed", range(4))
def test_zeros_on_the_diagonal(seed):
    matrix = saddle(10, 40, seed)
    solver, told = factored(matrix)
    b = np.ones(matrix.shape[0])
    assert error_of(matrix, solver.solve(b), b) < 1e-13
    assert told.negative_pivots == 40  # of a positive definite A one for each row of B


@settings(max_examples=150, deadline=None, derandomize=True)
@given(seed=st.integers(0, 10**6), symmetric=st.booleans())
def test_any_sparsity(seed, symmetric):
    """Solved to rounding with the right inertia and sign, or refused as singular."""
    matrix = some_matrix(seed, symmetric)
    sizes = np.linalg.svd(matrix, compute_uv=False)
    try:
        solver, told = factored(matrix, symmetric)
        x = solver.solve(np.ones(len(matrix)))
    except SolveError:
        assert sizes[-1] < 1e-9 * sizes[0]
        return
    assert error_of(matrix, x, np.ones(len(matrix))) < 1e-12
    if sizes[-1] > 1e-9 * sizes[0]:
        assert told.odd == (np.linalg.slogdet(matrix)[0] < 0)
        if symmetric:
            assert told.negative_pivots == negative_eigenvalues(matrix)


@pytest.mark.parametrize("symmetric", [True, False])
def test_no_pivot_is_taken_that_is_tiny_beside_its_column(symmetric):
    """1e-20 on every diagonal entry of a strip: taken as pivots, they would leave nothing but rounding."""
    pairs = sparse.kron(sparse.eye(120), [[0.0, 1.0], [1.0, 0.0]])
    chain = sparse.diags([0.3, 0.3], [-2, 2], shape=(240, 240))
    matrix = (pairs + chain + 1e-20 * sparse.eye(240)).tocsr()
    solver, told = factored(matrix, symmetric)
    x = solver.solve(np.ones(240))
    assert error_of(matrix, x, np.ones(240)) < 1e-15
    np.testing.assert_allclose(x, np.linalg.solve(matrix.toarray(), np.ones(240)), rtol=1e-12)
    if symmetric:
        assert told.negative_pivots == negative_eigenvalues(matrix) == 120


@pytest.mark.parametrize("symmetric", [True, False])
def test_dense_rows(symmetric):
    """Rows that are full, as those of scalar unknowns are."""
    matrix = grid((25, 25), 1).tolil()
    for row in (0, 300, 624):
        matrix[row, :] = 0.01
        matrix[:, row] = 0.01
        matrix[row, row] = 900.0
    solver, _ = factored(matrix.tocsr(), symmetric)
    b = np.arange(625.0)
    assert error_of(matrix, solver.solve(b), b) < 1e-14


@pytest.mark.parametrize("scale", [1e-12, 1e12, 1e-150, 1e150])
@pytest.mark.parametrize("kind", ["positive", "indefinite", "unsymmetric"])
def test_the_unit_does_not_matter(scale, kind):
    matrix = grid((12, 12), 3) - (3.0 if kind == "indefinite" else 0.0) * sparse.eye(432)
    matrix = matrix + 0.2 * sparse.triu(matrix, 1) if kind == "unsymmetric" else matrix
    answers = []
    for factor in (1.0, scale):
        solver, told = factored(factor * matrix, kind != "unsymmetric")
        answers.append((told.negative_pivots, told.odd, factor * solver.solve(np.ones(432))))
    (*one, x), (*other, y) = answers
    assert one == other
    np.testing.assert_allclose(x, y, rtol=1e-10)


def test_many_right_hand_sides(rng):
    """More columns than are solved for at once; each as if it were alone, to rounding."""
    matrix = grid((10, 10), 3)
    solver, _ = factored(matrix)
    b = rng.normal(size=(300, 37))
    x = solver.solve(b)
    for column in (0, 15, 16, 36):
        np.testing.assert_allclose(x[:, column], solver.solve(b[:, column]), rtol=1e-11)


# Singular matrices ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("symmetric", [True, False])
def test_a_free_sheet_is_singular_and_the_equation_is_one_of_it(symmetric):
    held, free = grid((8, 8), 2), grid((7, 7), 2)
    free = (free - sparse.eye(98)).tocsr()  # each row sums up to nothing
    with pytest.raises(SingularMatrix) as caught:
        factored(sparse.block_diag([held, free]), symmetric)
    assert 128 <= caught.value.value < 226


@pytest.mark.parametrize("symmetric", [True, False])
def test_an_empty_row_is_named(symmetric):
    matrix = (grid((8, 8), 2) - 2.0 * sparse.eye(128)).tolil()
    matrix[77, :] = 0.0
    matrix[:, 77] = 0.0
    with pytest.raises(SingularMatrix) as caught:
        factored(matrix.tocsr(), symmetric)
    assert caught.value.value == 77
    assert "equation 77" in str(caught.value)


def test_nearly_singular_is_solved(rng):
    """An eigenvalue 1e-9 of the largest: no reason to refuse."""
    matrix = grid((9, 9), 2).toarray()
    values, vectors = np.linalg.eigh(matrix)
    matrix -= (values[0] - 1e-9 * values[-1]) * np.outer(vectors[:, 0], vectors[:, 0])
    solver, told = factored(matrix)
    b = rng.normal(size=len(matrix))
    assert error_of(matrix, solver.solve(b), b) < 1e-14
    assert told.negative_pivots == 0


@pytest.mark.parametrize("symmetric", [True, False])
def test_pivots_that_overflow_are_refused(symmetric):
    matrix = np.array([[0.2, 1.0], [1.0 if symmetric else -1.0, 1.0 - 2.0 * symmetric]]) * 1.7e308
    with pytest.raises(SolveError):
        factored(matrix, symmetric)[0].solve(np.ones(2))


# Refinement and the check of the residual -----------------------------------------------------------------


def test_a_poor_solution_is_refined_and_a_wrong_one_refused(monkeypatch):
    matrix = grid((12, 12), 2) - 3.0 * sparse.eye(288)
    solver, _ = factored(matrix)
    factors = solver._factors

    class Spoilt:
        """Solutions that are wrong by a part of themselves."""

        part = 1e-5

        def solve(self, b, x):
            factors.solve(b, x)
            x *= 1.0 + self.part

        def __getattr__(self, name):
            return getattr(factors, name)

    b = np.ones(288)
    monkeypatch.setattr(solver, "_factors", Spoilt())
    assert error_of(matrix, solver.solve(b), b) < 1e-14
    monkeypatch.setattr(Spoilt, "part", 0.5)
    with pytest.raises(SolveError, match="not accurate"):
        solver.solve(b)


# Memory, and what is kept from one matrix to the next ---------------------------------------------------------


def test_the_memory_that_is_needed_is_compared_with_the_machine(monkeypatch):
    pattern, values = stored(grid((20, 20), 3))
    solver = Multifrontal()
    solver.analyse(pattern)
    solver.factor(values)
    monkeypatch.setattr(multifrontal, "_installed", lambda: 1000.0)
    with pytest.raises(SolveError, match="not enough memory") as caught:
        solver.factor(values)
    assert "GB" in str(caught.value)
    with pytest.raises(RuntimeError, match="factor"):
        solver.solve(np.ones(pattern.n))
    monkeypatch.undo()
    solver.factor(values)
    assert np.isfinite(solver.solve(np.ones(pattern.n))).all()


LIMITED = """
import resource, sys
sys.path.insert(0, sys.argv[1])
from matrices import Multifrontal, grid, np, stored
import umform
from umform.errors import SolveError
umform.set_threads(1)
pattern, values = stored(grid((110, 110), 3))
solver = Multifrontal()
solver.analyse(pattern)
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
limit = resource.getrlimit(resource.RLIMIT_AS)
needed = solver._factors.bytes
for more in (needed // 8, needed + 2**24, needed // 8):  # no room for the factors; none for the buffer of OpenBLAS
    resource.setrlimit(resource.RLIMIT_AS, (used + more, limit[1]))
    try:
        solver.factor(values)
    except SolveError as error:
        print(str(error).split(" [")[0])
    resource.setrlimit(resource.RLIMIT_AS, limit)
solver.factor(values)
print(np.isfinite(solver.solve(np.ones(pattern.n))).all())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are those of Linux")
def test_out_of_memory_is_an_error_and_the_next_factorisation_works():
    command = [sys.executable, "-c", LIMITED, str(Path(__file__).parent)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.stdout.split("\n")[:4] == ["There is not enough memory for the factors of the matrix"] * 3 + ["True"]


def test_cholesky_is_left_out_from_the_first_negative_pivot_to_the_last():
    matrix = grid((8, 8), 2)
    pattern, positive = stored(matrix)
    indefinite = stored(matrix - 3.0 * sparse.eye(128))[1]
    solver = Multifrontal()
    solver.analyse(pattern)
    assert solver.memory() == 1
    kinds = []
    for values in (positive, indefinite, indefinite, positive, positive):
        solver.factor(values)
        kinds.append((solver._with_cholesky, solver.memory()))
    assert kinds == [(True, 1), (False, 0), (False, 0), (False, 1), (True, 1)]


def test_what_is_remembered_gives_the_same_bits():
    matrix = grid((8, 8), 2)
    pattern, positive = stored(matrix)
    indefinite = stored(matrix - 3.0 * sparse.eye(128))[1]
    one, other = Multifrontal(), Multifrontal()
    one.analyse(pattern)
    one.factor(indefinite)
    other.analyse(pattern)
    other.recall(one.memory())
    for values in (positive, positive, indefinite):
        assert one.factor(values) == other.factor(values)
        np.testing.assert_array_equal(one.solve(np.ones(128)), other.solve(np.ones(128)))
