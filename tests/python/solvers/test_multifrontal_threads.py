"""The multifrontal solver on several threads, and beside BLAS's own."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from matrices import grid, saddle, stored
from scipy import sparse

import umform
from umform.solvers import blas
from umform.solvers.multifrontal import Multifrontal

SCALED = ["scaled indefinite", "scaled unsymmetric"]


pytestmark = pytest.mark.usefixtures("threads_as_before")


def large(kind):
    """More work than one unit of the schedule, and fronts that are shared."""
    if kind == "delayed pivots":
        return saddle(45, 600, 0), True
    matrix = grid((14, 14, 14), 3)
    if kind.startswith("scaled"):
        scale = sparse.diags(10.0 ** np.random.default_rng(0).uniform(-3.0, 3.0, matrix.shape[0]))
        matrix, symmetric = large(kind.removeprefix("scaled "))
        return scale @ matrix @ scale, symmetric
    if kind == "indefinite":
        return matrix - 8.0 * sparse.eye(matrix.shape[0]), True
    if kind == "unsymmetric":
        return matrix + 0.3 * sparse.triu(matrix, 1), False
    return matrix, True


@pytest.mark.parametrize("kind", ["positive", "indefinite", "unsymmetric", "delayed pivots", *SCALED])
def test_any_number_of_threads_gives_the_same_bits(kind, rng):
    matrix, symmetric = large(kind)
    pattern, values = stored(matrix, symmetric)
    b = rng.normal(size=(pattern.n, 2))

    def run(count):
        umform.set_threads(count)
        solver = Multifrontal()
        solver.analyse(pattern)
        told = solver.factor(values)
        return told, solver._factors.pivots().size, solver.solve(b), solver.solve(b[:, 0])

    expected = run(1)
    assert np.abs(matrix @ expected[2] - b).max() < (1e-9 if kind not in SCALED else 1e-6)
    for count in (2, 3, 5):
        for _ in range(2):
            told, *arrays = run(count)
            assert told == expected[0]
            for a, e in zip(arrays, expected[1:], strict=True):
                np.testing.assert_array_equal(a, e)


def test_the_number_may_change_between_factorisation_and_solve():
    matrix, _ = large("positive")
    pattern, values = stored(matrix)
    solver = Multifrontal()
    solver.analyse(pattern)
    solutions = []
    for count, then in ((1, 1), (1, 3), (3, 1), (2, 3)):
        umform.set_threads(count)
        solver.factor(values)
        umform.set_threads(then)
        solutions.append(solver.solve(np.ones(pattern.n)))
    for x in solutions[1:]:
        np.testing.assert_array_equal(x, solutions[0])


def test_solvers_in_several_threads_of_python():
    """The kernels release the interpreter: each solver has memory of its own."""
    matrices = [grid((20, 20), 3, seed) for seed in range(4)]
    expected = []
    for matrix in matrices:
        solver = Multifrontal()
        solver.analyse(stored(matrix)[0])
        solver.factor(stored(matrix)[1])
        expected.append(solver.solve(np.ones(1200)))
    failed = []

    def work(matrix, x):
        pattern, values = stored(matrix)
        solver = Multifrontal()
        solver.analyse(pattern)
        for _ in range(10):
            solver.factor(values)
            if not np.array_equal(solver.solve(np.ones(1200)), x):
                failed.append(matrix)

    workers = [threading.Thread(target=work, args=pair) for pair in zip(matrices, expected, strict=True)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert not failed


TWO = """
import sys, threading
sys.path.insert(0, sys.argv[1])
from matrices import Multifrontal, grid, np, stored
import umform
umform.set_threads(2)
given = [stored(grid((14, 14, 14), 3, seed)) for seed in range(2)]
found, start = [[], []], threading.Barrier(2)

def work(k):
    solver = Multifrontal()
    solver.analyse(given[k][0])
    for _ in range(3):
        start.wait(30)
        solver.factor(given[k][1])
        found[k].append(solver.solve(np.ones(given[k][0].n)))

workers = [threading.Thread(target=work, args=(k,)) for k in range(2)]
[worker.start() for worker in workers]
[worker.join() for worker in workers]
for k, (pattern, values) in enumerate(given):
    solver = Multifrontal()
    solver.analyse(pattern)
    solver.factor(values)
    x = solver.solve(np.ones(pattern.n))
    print(len(found[k]) == 3 and all(np.array_equal(x, other) for other in found[k]))
"""


def test_the_first_factorisations_of_a_process_may_be_two_at_once():
    """BLAS is handed over once, and has buffers for the threads of both."""
    command = [sys.executable, "-c", TWO, str(Path(__file__).parent)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert done.stdout.split() == ["True", "True"], done.stderr


def test_the_threads_of_blas_are_as_before():
    blas.hand_over()
    module = blas._module("scipy.linalg.cython_blas")
    functions = blas.thread_functions(module)
    if functions is None:
        pytest.skip("this BLAS does not say how many threads it has")
    set_threads, count = functions
    set_threads(2)
    pattern, values = stored(grid((20, 20), 3))
    solver = Multifrontal()
    solver.analyse(pattern)
    solver.factor(values)
    solver.solve(np.ones(pattern.n))
    assert count() == 2
