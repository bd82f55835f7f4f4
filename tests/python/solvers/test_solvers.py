"""Every solver against dense algebra, and the promises of the protocol."""

from __future__ import annotations

import logging
import sys
import tracemalloc
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest
from scipy import sparse

from umform import solvers
from umform.errors import InvalidValue, NotFinite, SingularMatrix, SolveError
from umform.solvers import Factorisation, Pattern, banded, make_solver, mkl, multifrontal, pardiso, superlu

MAPS = Path("/proc/self/maps")
needs_mkl = pytest.mark.skipif(not pardiso.available(), reason="MKL is not installed")
SYMMETRIC = ["multifrontal", "superlu", "banded", pytest.param("pardiso", marks=needs_mkl)]
GENERAL = ["multifrontal", "superlu", pytest.param("pardiso", marks=needs_mkl)]


def stored(matrix, symmetric=True):
    """Return the pattern and the values of a dense matrix with its diagonal always stored."""
    present = (np.asarray(matrix) != 0) | np.eye(len(matrix), dtype=bool)
    rows, columns = np.nonzero(np.triu(present) if symmetric else present)
    indptr = np.searchsorted(rows, np.arange(len(matrix) + 1)).astype(np.int32)
    pattern = Pattern(len(matrix), indptr, columns.astype(np.int32), symmetric)
    return pattern, np.asarray(matrix, dtype=float)[rows, columns]


def sheet(cells, shift=0.0, seed=1):
    """Return a stiffness-like matrix with 3 unknowns a node, its lowest eigenvalues moved down by `shift`."""
    line = sparse.diags([-1.0, 2.0, -1.0], [-1, 0, 1], shape=(cells, cells))
    laplace = sparse.kronsum(line, line)
    block = np.random.default_rng(seed).normal(size=(3, 3))
    matrix = sparse.kron(laplace, block @ block.T + np.eye(3)).toarray()
    return matrix - shift * np.eye(len(matrix))


def solid():
    """Return a positive definite matrix that is not that of a sheet: each row has columns of its own."""
    random = np.random.default_rng(6)
    matrix = random.normal(size=(40, 40)) * (random.random((40, 40)) < 0.1)
    return matrix + matrix.T + 20.0 * np.eye(40)


def unsymmetric(cells):
    matrix = sheet(cells)
    return matrix + 0.3 * np.triu(matrix, 1)


def factored(name, matrix, symmetric=True):
    pattern, values = stored(matrix, symmetric)
    solver = make_solver(pattern, name)
    return solver, solver.factor(values)


@pytest.mark.parametrize("name", SYMMETRIC)
@pytest.mark.parametrize("columns", [(), (1,), (4,)])
def test_positive_definite(name, columns):
    matrix = sheet(6)
    solver, factorisation = factored(name, matrix)
    rhs = np.random.default_rng(0).normal(size=(len(matrix), *columns))
    kept = rhs.copy()
    x = solver.solve(rhs)
    assert x.shape == rhs.shape
    np.testing.assert_allclose(x, np.linalg.solve(matrix, rhs), rtol=1e-10, atol=1e-12)
    np.testing.assert_array_equal(rhs, kept)
    assert factorisation.negative_pivots == 0
    assert factorisation.fill >= np.count_nonzero(np.triu(matrix))


@pytest.mark.parametrize("name", SYMMETRIC)
@pytest.mark.parametrize("shift", [0.7, 3.0])
def test_indefinite_gives_the_inertia(name, shift):
    matrix = sheet(6, shift)
    solver, factorisation = factored(name, matrix)
    rhs = np.ones((len(matrix), 2))
    np.testing.assert_allclose(solver.solve(rhs), np.linalg.solve(matrix, rhs), rtol=1e-8, atol=1e-10)
    assert factorisation.negative_pivots == np.count_nonzero(np.linalg.eigvalsh(matrix) < 0) > 0


@pytest.mark.parametrize("name", SYMMETRIC)
def test_definite_again_after_indefinite(name):
    pattern, values = stored(sheet(4))
    solver = make_solver(pattern, name)
    solver.factor(values)
    assert solver.factor(stored(sheet(4, shift=1.5))[1]).negative_pivots > 0
    assert solver.factor(values).negative_pivots == 0
    np.testing.assert_allclose(sheet(4) @ solver.solve(np.ones(pattern.n)), 1.0, rtol=1e-10)


@needs_mkl
@pytest.mark.parametrize("symmetric", [True, False])
def test_pardiso_reads_the_values_where_they_are(symmetric):
    """Python's memory grows by less than half a matrix during a factorisation, and that is given back."""
    matrix = np.random.default_rng(2).normal(size=(200, 200)) + 200.0 * np.eye(200)
    pattern, values = stored(matrix + matrix.T if symmetric else matrix, symmetric)
    solver = make_solver(pattern, "pardiso")
    solver.factor(values)
    tracemalloc.start()
    solver.factor(values)
    kept, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 0.5 * values.nbytes
    assert kept < 0.1 * values.nbytes


@pytest.mark.parametrize("name", GENERAL)
@pytest.mark.parametrize("large", [np.inf, 1e200, -1e300])
def test_large_values_are_no_infinity(name, large):
    pattern, values = stored(sheet(3) if name != "pardiso" else unsymmetric(3), name != "pardiso")
    solver = make_solver(pattern, name)
    values[3] = large
    if np.isinf(large):
        with pytest.raises(NotFinite, match="not finite"):
            solver.factor(values)
    else:
        assert pattern.checked(values) is values


@pytest.mark.parametrize("name", GENERAL)
def test_unsymmetric(name):
    matrix = unsymmetric(6)
    solver, factorisation = factored(name, matrix, symmetric=False)
    for rhs in (np.ones(len(matrix)), np.random.default_rng(0).normal(size=(len(matrix), 3))):
        np.testing.assert_allclose(solver.solve(rhs), np.linalg.solve(matrix, rhs), rtol=1e-10, atol=1e-12)
    assert factorisation.negative_pivots is None


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("name", ["multifrontal", "superlu"])
def test_the_sign_of_the_determinant(name, seed, symmetric, rng):
    """With pivots far from the diagonal too, whose order has a sign of its own."""
    matrix = np.random.default_rng(seed).normal(size=(30, 30)) * (
        np.random.default_rng(seed + 100).random((30, 30)) < 0.3
    )
    matrix += np.diag(rng.normal(size=30))
    if symmetric:
        matrix = matrix + matrix.T
    _, factorisation = factored(name, matrix, symmetric)
    assert factorisation.odd == (np.linalg.slogdet(matrix)[0] < 0)


@pytest.mark.parametrize("name", GENERAL)
def test_unsymmetric_structure(name):
    random = np.random.default_rng(3)
    matrix = random.normal(size=(40, 40)) * (random.random((40, 40)) < 0.1) + 5 * np.eye(40)
    solver, _ = factored(name, matrix, symmetric=False)
    np.testing.assert_allclose(solver.solve(np.ones(40)), np.linalg.solve(matrix, np.ones(40)), rtol=1e-10)


@pytest.mark.parametrize("name", GENERAL)
@pytest.mark.parametrize("symmetric", [True, False])
def test_pivots_far_from_the_diagonal_are_solved_or_refused(name, symmetric):
    """Matrices that no model yields: never a wrong solution."""
    random = np.random.default_rng(5)
    for _ in range(20):
        matrix = random.normal(size=(60, 60)) * (random.random((60, 60)) < 0.06)
        matrix += np.roll(np.eye(60), 1, axis=1)
        np.fill_diagonal(matrix, 0.0)
        matrix = matrix + matrix.T if symmetric else matrix
        try:
            solver, _ = factored(name, matrix, symmetric)
            x = solver.solve(np.ones(60))
        except SolveError:
            assert name == "pardiso"
        else:
            np.testing.assert_allclose(matrix @ x, 1.0, atol=1e-6 * max(1.0, np.abs(x).max()))


@pytest.mark.parametrize("name", SYMMETRIC)
def test_widely_differing_stiffness_is_not_singular(name):
    matrix = sheet(4)
    stiff = np.r_[1e5, np.ones(len(matrix) - 1)]
    matrix = matrix * np.outer(stiff, stiff)
    solver, _ = factored(name, matrix)
    np.testing.assert_allclose(matrix @ solver.solve(np.ones(len(matrix))), 1.0, rtol=1e-6)


@pytest.mark.parametrize("name", SYMMETRIC)
@pytest.mark.parametrize(
    "matrix",
    [[[0.0]], [[1.0, 1.0], [1.0, 1.0]], [[0.0, 0.0], [0.0, 2.0]], [[1, 2, 3], [2, 4, 6], [3, 6, 10]]],
    ids=["zero", "ones", "empty row", "dependent rows"],
)
def test_singular(name, matrix):
    pattern, values = stored(matrix)
    solver = make_solver(pattern, name)
    with pytest.raises(SingularMatrix) as caught:
        solver.factor(values)
    assert caught.value.remedy
    with pytest.raises(RuntimeError, match="factor"):
        solver.solve(np.ones(pattern.n))


@pytest.mark.parametrize("name", GENERAL)
def test_singular_unsymmetric(name):
    with pytest.raises(SingularMatrix):
        factored(name, [[1.0, 2.0], [2.0, 4.0]], symmetric=False)


@pytest.mark.parametrize("name", SYMMETRIC)
def test_free_body_is_singular_in_spite_of_rounding(name):
    springs = np.random.default_rng(2).random(30) + 0.1
    matrix = np.diag(np.r_[springs, 0] + np.r_[0, springs]) - np.diag(springs, 1) - np.diag(springs, -1)
    with pytest.raises(SingularMatrix) as caught:
        factored(name, matrix)
    assert caught.value.value is None or 0 <= caught.value.value < 31


@pytest.mark.parametrize("name", SYMMETRIC)
def test_the_equation_of_a_vanishing_pivot_is_named(name):
    """Two bodies, the second of which is hardly held: the pivot is positive, but nothing but rounding."""
    loose = np.array([[1.0, -1.0], [-1.0, 1.0 + 4e-16]])
    matrix = np.zeros((12, 12))
    matrix[:10, :10] = sheet(4)[:10, :10]
    matrix[10:, 10:] = loose
    with pytest.raises(SingularMatrix) as caught:
        factored(name, matrix)
    assert caught.value.value in (10, 11)


@pytest.mark.parametrize("name", SYMMETRIC)
@pytest.mark.parametrize("entry", [3.0, -3.0])
def test_one_equation(name, entry):
    solver, factorisation = factored(name, [[entry]])
    np.testing.assert_allclose(solver.solve(np.array([6.0])), [6.0 / entry])
    assert factorisation.negative_pivots == (entry < 0)


@pytest.mark.parametrize("name", SYMMETRIC)
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_not_finite(name, bad):
    pattern, values = stored(sheet(3))
    solver = make_solver(pattern, name)
    solver.factor(values)
    spoilt = values.copy()
    spoilt[pattern.indptr[4] + 1] = bad
    with pytest.raises(NotFinite, match="equation 4"):
        solver.factor(spoilt)
    with pytest.raises(RuntimeError, match="factor"):
        solver.solve(np.ones(pattern.n))
    solver.factor(values)
    with pytest.raises(NotFinite, match="equation 2"):
        solver.solve(np.where(np.arange(pattern.n) == 2, bad, 1.0))


@pytest.mark.parametrize("name", SYMMETRIC)
def test_wrong_sizes(name):
    pattern, values = stored(sheet(3))
    solver = make_solver(pattern, name)
    with pytest.raises(InvalidValue, match="values"):
        solver.factor(values[:-1])
    solver.factor(values)
    with pytest.raises(InvalidValue, match="right-hand side"):
        solver.solve(np.ones(pattern.n - 1))


@pytest.mark.parametrize("kind", [multifrontal.Multifrontal, superlu.SuperLU, banded.Banded, pardiso.Pardiso])
def test_solve_before_factor(kind):
    with pytest.raises(RuntimeError, match="factor"):
        kind().solve(np.ones(1))


@pytest.mark.parametrize("name", SYMMETRIC)
def test_factors_do_not_follow_the_values(name):
    matrix = sheet(3)
    pattern, values = stored(matrix)
    solver = make_solver(pattern, name)
    solver.factor(values)
    values[:] = 0.0
    np.testing.assert_allclose(matrix @ solver.solve(np.ones(pattern.n)), 1.0, rtol=1e-10)


@pytest.mark.parametrize(
    ("name", "module", "ordering"),
    [
        ("multifrontal", multifrontal._core, "Multifrontal"),
        ("superlu", superlu, "_minimum_degree"),
        ("superlu", superlu, "sheet_of"),
        ("banded", banded, "orders"),
        pytest.param("pardiso", pardiso, "Handle", marks=needs_mkl),
    ],
)
def test_new_values_reuse_the_ordering(monkeypatch, name, module, ordering):
    calls = []
    original = getattr(module, ordering)
    monkeypatch.setattr(module, ordering, lambda *args: calls.append(args) or original(*args))
    matrix = solid() if ordering == "_minimum_degree" else sheet(4)
    pattern, values = stored(matrix)
    solver = make_solver(pattern, name)
    for factor in (1.0, 2.0, 5.0):
        solver.factor(factor * values)
        np.testing.assert_allclose(factor * matrix @ solver.solve(np.ones(pattern.n)), 1.0, rtol=1e-10)
    assert len(calls) == 1


@needs_mkl
def test_pardiso_returns_to_cholesky_with_the_analysis_it_had():
    pattern, values = stored(sheet(4))
    indefinite = stored(sheet(4, shift=1.5))[1]
    solver = pardiso.Pardiso()
    solver.analyse(pattern)
    solver.factor(values)
    first, x = solver._handle, solver.solve(np.ones(pattern.n))
    solver.factor(indefinite)
    second, y = solver._handle, solver.solve(np.ones(pattern.n))
    for again, handle in ((indefinite, second), (values, second), (values, first), (indefinite, second)):
        solver.factor(again)
        assert solver._handle is handle
        if handle is first or again is indefinite:
            np.testing.assert_array_equal(solver.solve(np.ones(pattern.n)), x if handle is first else y)


def test_refinement_restores_the_accuracy_that_small_pivots_cost(monkeypatch):
    random = np.random.default_rng(0)
    matrix = random.normal(size=(200, 200)) * (random.random((200, 200)) < 0.02)
    matrix += matrix.T
    largest = np.abs(matrix).max(axis=0)
    np.fill_diagonal(matrix, 2e-3 * random.choice([-1, 1], 200) * largest + (largest == 0))
    solver, factorisation = factored("superlu", matrix)
    assert factorisation.negative_pivots == np.count_nonzero(np.linalg.eigvalsh(matrix) < 0)

    def error(x):
        return np.abs(matrix @ x - 1.0).max() / (largest.max() * np.abs(x).max() + 1.0)

    refined = error(solver.solve(np.ones(200)))
    monkeypatch.setattr(superlu, "_POOR_RESIDUAL", np.inf)
    assert refined < 1e-15 < 0.1 * error(solver.solve(np.ones(200)))


def test_banded_finds_the_strip_in_shuffled_equations():
    matrix = np.diag(np.full(50, 2.1)) - np.diag(np.ones(49), 1) - np.diag(np.ones(49), -1)
    shuffled = np.random.default_rng(0).permutation(50)
    solver, _ = factored("banded", matrix[np.ix_(shuffled, shuffled)])
    assert solver.bandwidth == 1


@needs_mkl
def test_mkl_is_found_by_its_package_too(monkeypatch, tmp_path):
    """Not beside Python: in a folder of a user, say."""
    try:
        metadata.distribution("mkl")
    except metadata.PackageNotFoundError:
        pytest.skip("MKL was not installed by pip")
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    assert "mkl_rt" in mkl.find.__wrapped__().name


def test_mkl_is_found_where_pip_says_that_it_is(monkeypatch, tmp_path):
    site = tmp_path / "site"
    info = site / "mkl-2024.0.0.dist-info"
    info.mkdir(parents=True)
    (site / "libmkl_rt.so.2").touch()
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    monkeypatch.setattr(sys, "path", [str(site)])
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: mkl\nVersion: 2024.0.0\n")
    (info / "RECORD").write_text("libmkl_rt.so.2,,\n")
    assert mkl.find.__wrapped__() == (site / "libmkl_rt.so.2").resolve()
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    assert mkl.find.__wrapped__() is None


def test_banded_refuses_unsymmetric_patterns():
    with pytest.raises(InvalidValue, match="symmetric"):
        factored("banded", unsymmetric(3), symmetric=False)


@pytest.mark.parametrize(
    ("indptr", "indices", "words"),
    [
        ([0, 1], [0, 1], "row starts"),
        ([0, 2, 2], [0, 1], "empty"),
        ([0, 1, 2], [0, 2], "outside"),
        ([0, 2, 3], [1, 0, 1], "sorted"),
        ([0, 2, 3], [0, 0, 1], "sorted"),
        ([0, 2, 3], [0, 1, 0], "diagonal"),
        ([0, 1, 3], [0, 0, 1], "below"),
    ],
)
def test_pattern_refuses(indptr, indices, words):
    with pytest.raises(InvalidValue, match=words):
        Pattern(2, np.array(indptr, dtype=np.int32), np.array(indices, dtype=np.int32), symmetric=True)


class Dense:
    """A solver of one's own."""

    name = "dense"

    def analyse(self, pattern):
        self.positions = pattern.positions().toarray()

    def factor(self, values):
        self.matrix = np.r_[0.0, values][self.positions]
        return Factorisation(None, self.matrix.size)

    def solve(self, rhs):
        return np.linalg.solve(self.matrix, rhs)


def test_register(monkeypatch):
    monkeypatch.setattr(solvers, "_factories", dict(solvers._factories))
    solvers.register("dense", Dense)
    assert solvers.available()["dense"]
    solver, _ = factored("dense", sheet(3))
    np.testing.assert_allclose(sheet(3) @ solver.solve(np.ones(27)), 1.0)
    with pytest.raises(InvalidValue):
        solvers.register("auto", Dense)
    solvers.register("none", dict)
    with pytest.raises(InvalidValue, match="dict without analyse, factor, solve"):
        make_solver(stored(np.eye(2))[0], "none")


def test_unknown_name():
    with pytest.raises(InvalidValue, match=r"auto, multifrontal, pardiso, banded, superlu"):
        make_solver(stored(np.eye(2))[0], "nastran")


@pytest.mark.parametrize("mkl", [True, False])
@pytest.mark.parametrize(("cells", "symmetric"), [(3, True), (3, False), (14, True)])
def test_auto(monkeypatch, caplog, cells, symmetric, mkl):
    monkeypatch.setattr(pardiso, "available", lambda: mkl)
    matrix = sheet(cells) if symmetric else unsymmetric(cells)
    with caplog.at_level(logging.INFO, "umform.solvers"):
        solver = make_solver(stored(matrix, symmetric)[0])
    assert caplog.messages == ["solver: multifrontal"]
    assert solver.name == "multifrontal"


def test_pardiso_without_mkl(monkeypatch):
    monkeypatch.setattr(mkl, "find", lambda: None)
    assert not solvers.available()["pardiso"]
    mkl.library.cache_clear()
    with pytest.raises(InvalidValue, match="pip install"):
        make_solver(stored(np.eye(2))[0], "pardiso")
