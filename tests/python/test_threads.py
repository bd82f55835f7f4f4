"""Any number of threads gives the same bits."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import umform
from umform.analysis.run import solve
from umform.analysis.steps import Move

pytestmark = pytest.mark.usefixtures("threads_as_before")


def test_the_number_of_threads_is_what_was_set():
    for count in (1, 3, 2):
        umform.set_threads(count)
        assert umform.threads() == count


@pytest.mark.parametrize("element", ["DISP3D", "EAS3DEAS", "MI9K3DEAS"])
def test_one_evaluation_is_bitwise_the_same(build, rng, element):
    """More elements and facets than are worth more than one thread."""
    case = build.free_bending((36, 4), element)
    assert len(case.model.mesh.connectivity) > 128
    u = 0.02 * rng.normal(size=(len(case.model.mesh.points), 3))
    u[:, 2] -= 0.1  # into the tool
    u = u.ravel()

    def evaluate(count):
        umform.set_threads(count)
        evaluation = case.model.evaluate(u, np.ones(u.size))
        return evaluation.residual, evaluation.values, evaluation.predictor, evaluation.force_scale

    expected = evaluate(1)
    assert case.model.evaluate(u).found[case.contact].active.any()
    for count in (2, 3, 7):
        for a, b in zip(evaluate(count), expected, strict=True):
            np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("solver", ["multifrontal", "superlu"])
def test_a_run_is_bitwise_the_same(build, solver):
    def run(count):
        umform.set_threads(count)
        case = build.free_bending((24, 4))
        result = solve(case.model, Move(case.punch, -1.5, steps=3), frames=0, solver=solver)
        return (
            case.model.u,
            case.model.bodies.only.block.state,
            result["punch_force"],
            result["tool_fz"],
            result["iterations"],
        )

    for a, b in zip(run(1), run(2), strict=True):
        np.testing.assert_array_equal(a, b)


def test_the_number_may_change_while_another_thread_evaluates(build):
    """An evaluation reads the number once; the workspaces of a new block are as many as it has threads."""
    done = threading.Event()

    def change():
        while not done.is_set():
            for count in range(1, 9):
                umform.set_threads(count)

    other = threading.Thread(target=change)
    other.start()
    try:
        found = set()
        for _ in range(60):
            model = build.free_bending((40, 8)).model
            found.add(model.evaluate(np.zeros(3 * len(model.mesh.points))).values.tobytes())
    finally:
        done.set()
        other.join()
    assert len(found) == 1


def test_two_models_evaluate_in_two_python_threads(build, rng):
    """Kernels leave the interpreter to others while they work, and share nothing."""
    umform.set_threads(2)
    cases = [build.free_bending((40, 8)), build.free_bending((30, 10), "MI9K3DEAS")]
    states = []
    for case in cases:
        u = 0.02 * rng.normal(size=(len(case.model.mesh.points), 3))
        u[:, 2] -= 0.1
        states.append(u.ravel())

    def evaluate(number):
        evaluations = [cases[number].model.evaluate(states[number], np.ones(states[number].size)) for _ in range(20)]
        return {(e.residual.tobytes(), e.values.tobytes(), e.predictor.tobytes()) for e in evaluations}

    expected = [evaluate(0), evaluate(1)]
    with ThreadPoolExecutor(2) as pool:
        together = list(pool.map(evaluate, (0, 1)))
    assert together == expected
    assert [len(one) for one in together] == [1, 1]


@pytest.mark.parametrize(("given", "expected"), [(None, "passive"), ("active", "active")])
def test_threads_of_mkl_wait_passively_in_commands_unless_the_user_wants_otherwise(given, expected):
    environment = {name: value for name, value in os.environ.items() if name != "OMP_WAIT_POLICY"}
    environment |= {} if given is None else {"OMP_WAIT_POLICY": given}
    code = (
        "import atexit, os, sys, umform.cli; atexit.register(lambda: print(os.environ['OMP_WAIT_POLICY'])); "
        "sys.argv[1:] = ['elements']; umform.cli.main()"
    )
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == expected


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no processes are forked on this system")
def test_a_forked_process_evaluates_on_threads_of_its_own():
    code = (
        "import os, numpy as np, umform as uf; uf.set_threads(2)\n"
        "mesh = uf.mesh.strip(length=100.0, width=100.0, thickness=1.0, cells=(20, 20))\n"
        "model = uf.Model(mesh, material=uf.SVK(E=2e5, nu=0.3))\n"
        "u = 1e-3 * np.arange(3.0 * len(mesh.points))\n"
        "def bits(): return model.evaluate(u).residual.tobytes()\n"
        "before = bits(); child = os.fork()\n"
        "if child == 0: os._exit(0 if bits() == before else 1)\n"
        "raise SystemExit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))\n"
    )
    assert subprocess.run([sys.executable, "-c", code], timeout=300, check=False).returncode == 0


def test_an_import_sets_no_variable_of_the_process():
    code = "import os; before = dict(os.environ); import umform; umform.threads(); assert dict(os.environ) == before"
    environment = {name: value for name, value in os.environ.items() if name != "OMP_WAIT_POLICY"}
    subprocess.run([sys.executable, "-c", code], env=environment, check=True)
