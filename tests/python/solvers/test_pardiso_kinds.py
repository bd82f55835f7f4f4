"""Which kind of factors PARDISO takes for a matrix, and on how many threads: with a dense stand-in for its phases."""

from __future__ import annotations

from contextlib import contextmanager

import numpy as np
import pytest
from scipy import sparse

from umform.errors import SingularMatrix
from umform.solvers import Pattern, mkl, pardiso
from umform.solvers.pardiso_handle import ANALYSE, CHOLESKY, FACTOR, INDEFINITE, PIVOT_NOT_POSITIVE, SOLVE

N = 12


def entries(lowest, pattern=None):
    """Values of a dense symmetric matrix with this lowest eigenvalue; with them its pattern if none is given."""
    vectors, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(N, N)))
    matrix = (vectors * np.r_[lowest, np.arange(2.0, N + 1.0)]) @ vectors.T
    upper = sparse.csr_matrix(np.triu(matrix))
    pattern = Pattern(N, upper.indptr.astype(np.int32), upper.indices.astype(np.int32), True)
    return pattern, matrix[pattern.rows, pattern.indices], matrix


class Dense:
    """PARDISO's phases by dense algebra."""

    log: list[tuple[int, int]]
    perturbed_pivots, fill = 0, N * N

    def __init__(self, kind, matrix):
        self.kind, self.kept = kind, False

    def call(self, phase, matrix, b=None, x=None):
        self.log.append((self.kind, phase))
        if phase == FACTOR:
            upper = sparse.csr_matrix((matrix.data, matrix.indices, matrix.indptr), shape=(N, N)).toarray()
            self.matrix = upper + np.triu(upper, 1).T
            values = np.linalg.eigvalsh(self.matrix)
            self.negative_pivots = int(np.count_nonzero(values < 0.0))
            self.kept = True
            if self.kind == CHOLESKY and self.negative_pivots:
                return PIVOT_NOT_POSITIVE
        if phase == SOLVE:
            assert self.kept
            x[...] = np.linalg.solve(self.matrix, b)
        return 0

    def eliminate_in(self, order):
        assert sorted(order) == list(range(N))

    def forget(self):
        self.kept = False

    def pivots(self):
        return np.ones(N), np.ones(N)


@pytest.fixture
def solver(monkeypatch):
    """PARDISO with the stand-in, and the calls that it makes."""
    log = []
    monkeypatch.setattr(pardiso, "Handle", type("Logged", (Dense,), {"log": log}))

    @contextmanager
    def threads(count):
        log.append(("threads", count))
        yield

    monkeypatch.setattr(mkl, "threads", threads)
    made = pardiso.Pardiso()
    made.analyse(entries(1.0)[0])
    return made, log


def kinds(log):
    """Kinds of the factorisations."""
    return [kind for kind, phase in log if phase == FACTOR]


def test_cholesky_comes_back_with_the_first_matrix_that_has_no_negative_pivot(solver):
    solver, log = solver
    found = []
    for lowest in (1.0, -1.0, -2.0, 1.0, 1.0, 1.0):
        _, values, matrix = entries(lowest)
        found.append(solver.factor(values).negative_pivots)
        np.testing.assert_allclose(matrix @ solver.solve(np.ones(N)), 1.0, rtol=1e-9)
    assert found == [0, 1, 1, 0, 0, 0]
    assert kinds(log) == [CHOLESKY, CHOLESKY, INDEFINITE, INDEFINITE, INDEFINITE, CHOLESKY, CHOLESKY]
    assert [phase for _, phase in log].count(ANALYSE) == 2  # one of each kind, whatever comes back


def test_a_matrix_at_the_limit_of_cholesky_is_not_factorised_twice_each_time(solver, monkeypatch):
    """Round-off may let Cholesky fail where L D L^T finds no negative pivot: then it is left out the next time."""
    solver, log = solver
    whole = Dense.call

    def fails(self, phase, matrix, b=None, x=None):
        code = whole(self, phase, matrix, b, x)
        return PIVOT_NOT_POSITIVE if phase == FACTOR and self.kind == CHOLESKY else code

    monkeypatch.setattr(Dense, "call", fails)
    for _ in range(4):
        solver.factor(entries(1.0)[1])
    assert kinds(log) == [CHOLESKY, INDEFINITE, INDEFINITE, CHOLESKY, INDEFINITE, INDEFINITE]


@pytest.mark.parametrize("after", range(1, 6))
def test_a_run_that_is_taken_up_takes_the_same_kinds(solver, after):
    solver, log = solver
    lowest = [1.0, -1.0, -2.0, 1.0, 1.0, -1.0, 1.0]
    for value in lowest[:after]:
        solver.factor(entries(value)[1])
    memory, before = solver.memory(), len(log)
    for value in lowest[after:]:
        solver.factor(entries(value)[1])
    through = kinds(log[before:])
    again = pardiso.Pardiso()
    again.analyse(entries(1.0)[0])
    again.recall(memory)
    before = len(log)
    for value in lowest[after:]:
        again.factor(entries(value)[1])
    assert kinds(log[before:]) == through


def test_factors_are_forgotten_with_the_kind_and_no_solve_uses_old_ones(solver):
    solver, _ = solver
    solver.factor(entries(1.0)[1])
    first = solver._handle
    solver.factor(entries(-1.0)[1])
    assert not first.kept
    with pytest.raises(SingularMatrix):
        type(first).perturbed_pivots = 1
        solver.factor(entries(-1.0)[1])
    with pytest.raises(RuntimeError, match="factor"):
        solver.solve(np.ones(N))


@pytest.mark.parametrize(("least", "threads"), [(N + 1, 1), (N, None)])
def test_small_matrices_take_one_thread(solver, monkeypatch, least, threads):
    _, log = solver
    monkeypatch.setattr(pardiso, "_SMALL", least)
    made = pardiso.Pardiso()
    log.clear()
    made.analyse(entries(1.0)[0])
    made.factor(entries(1.0)[1])
    made.solve(np.ones(N))
    assert {count for what, count in log if what == "threads"} == {threads}
    assert [what for what, _ in log].count("threads") == 3  # analysis, factors, solve
