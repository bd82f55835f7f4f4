"""A run keeps NumPy's BLAS on one thread, and gives it back as it was."""

from __future__ import annotations

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

from umform.solvers.blas import thread_functions
from umform.solvers.one_thread import _threads, one_thread


@pytest.fixture
def threads():
    """The number of threads of NumPy's OpenBLAS, set to 3 during the test."""
    functions = _threads()._functions
    if functions is None:
        pytest.skip("NumPy has another BLAS than OpenBLAS")
    set_threads, get_threads = functions
    before = get_threads()
    set_threads(3)
    yield get_threads
    set_threads(before)


def test_one_thread_inside_and_as_many_as_before_outside(threads):
    with one_thread():
        assert threads() == 1
        with one_thread():
            assert threads() == 1
        assert threads() == 1
    assert threads() == 3


def test_an_error_gives_them_back(threads):
    with pytest.raises(ValueError, match="here"), one_thread():
        raise ValueError("here")
    assert threads() == 3


def test_the_last_of_several_threads_of_python_gives_them_back(threads):
    def enter(number: int) -> set[int]:
        seen = set()
        for _ in range(200):
            with one_thread():
                seen.add(threads())
        return seen

    with ThreadPoolExecutor(4) as pool:
        assert set().union(*pool.map(enter, range(4))) == {1}
    assert threads() == 3


def test_a_module_without_openblas_has_no_functions():
    import _ctypes

    assert thread_functions(_ctypes) is None


def test_a_run_keeps_to_one_thread(threads, build):
    from umform.analysis.run import solve
    from umform.analysis.steps import Move

    case = build.free_bending((6, 1))
    seen = []
    evaluate = case.model.system.evaluate

    def watched(*args, **kwargs):
        seen.append(threads())
        return evaluate(*args, **kwargs)

    case.model.system.evaluate = watched
    solve(case.model, Move(case.punch, -0.5, steps=1), frames=0)
    assert set(seen[2:]) == {1}  # before come the check of the model and its first state
    assert threads() == 3


# 24 000 unknowns: long enough for NumPy to share out a product.
_RUN = """
import time
import umform as uf
uf.set_threads(1)
model = uf.Model(uf.mesh.strip(60.0, 60.0, 1.0, (64, 62)), material=uf.SVK(E=210e3, nu=0.3))
model.fix("x0")
end = model.prescribe("x1_lower", "z", name="end")
uf.solve(model, uf.Move(end, to=-0.1, steps=1), frames=0, progress=False)
time.sleep(0.2)
own, whole = time.thread_time(), time.process_time()
uf.solve(model, uf.Move(end, to=-1.0, steps=2), frames=0, progress=False)
print((time.process_time() - whole) / (time.thread_time() - own))
"""


def test_no_thread_waits_actively_beside_a_run():
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "4", "OMP_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, "-c", _RUN], env=environment, capture_output=True, text=True, check=True)
    assert float(done.stdout) < 1.2, "CPU time of the process over that of the thread that runs"


def test_the_command_line_sets_it_before_numpy_is_loaded():
    environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    code = (
        "import atexit, os, sys; from umform import cli; sys.argv[1:] = ['--version']; "
        "assert 'numpy' not in sys.modules; "
        "atexit.register(lambda: print(os.environ['OPENBLAS_NUM_THREADS'])); cli.main()"
    )
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.split()[-1] == "1"
