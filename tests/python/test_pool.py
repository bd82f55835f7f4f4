"""Independent runs in parallel processes: order, failures, threads, interruptions."""

from __future__ import annotations

import concurrent.futures
import multiprocessing
import os
import subprocess
import sys
import time

import pytest

from umform import _core
from umform.errors import InvalidValue, SolveError
from umform.pool import run_all

_STARTED: list[int] = []


@pytest.fixture(autouse=True)
def importable(monkeypatch, pytestconfig):
    """Processes of the pool find the functions of this file by its name."""
    monkeypatch.syspath_prepend(pytestconfig.rootpath)


def double(number):
    _STARTED.append(number)
    if number < 0:
        raise ValueError(f"{number} is negative")
    return 2 * number


def surroundings(_):
    return _core.threads(), os.environ.get("OMP_NUM_THREADS"), os.getpid()


def sleep(seconds):
    time.sleep(seconds)
    return seconds


def die(_):
    os._exit(1)


def text(task, error):
    return f"{task}: {type(error).__name__} {error}"


@pytest.mark.parametrize("processes", [1, 2])
def test_answers_come_in_the_order_of_the_tasks_and_a_failure_is_one_of_them(processes):
    ticks = []
    answers = run_all(double, [1, -2, 3], [1.0, 2.0, 1.0], on_failure=text, processes=processes, tick=ticks.append)
    assert answers == [2, "-2: ValueError -2 is negative", 6]
    assert ticks[-1] == 1.0
    assert sorted(ticks) == ticks
    assert len(ticks) == 3


def test_the_dearest_come_first():
    _STARTED.clear()
    run_all(double, [1, 2, 3, 4], [1.0, 4.0, 3.0, 4.0], on_failure=text, processes=1)
    assert _STARTED == [2, 4, 3, 1]


def test_each_has_one_thread_and_nothing_changes_here():
    before, variable = _core.threads(), os.environ.get("OMP_NUM_THREADS")
    found = run_all(surroundings, [0, 1], [1.0, 1.0], on_failure=text, processes=2)
    assert {(threads, limit) for threads, limit, _ in found} == {(1, "1")}
    assert os.getpid() not in {pid for _, _, pid in found}
    assert (_core.threads(), os.environ.get("OMP_NUM_THREADS")) == (before, variable)


def test_a_process_that_dies_takes_its_task_along_and_is_told():
    (answer,) = set(run_all(die, [1, 2], [1.0, 1.0], on_failure=lambda task, error: type(error), processes=2))
    assert answer is SolveError


def test_an_interruption_ends_all_processes_at_once():
    def interrupt(done):
        raise KeyboardInterrupt

    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        run_all(sleep, [0.0, 60.0], [2.0, 1.0], on_failure=text, processes=2, tick=interrupt)
    while multiprocessing.active_children():
        assert time.monotonic() - start < 40.0
        time.sleep(0.05)


class Executor(concurrent.futures.Executor):
    """One of the user, which runs what it gets at once."""

    def submit(self, function, /, *arguments):
        future = concurrent.futures.Future()
        try:
            future.set_result(function(*arguments))
        except Exception as error:
            future.set_exception(error)
        return future


def test_an_executor_of_the_user_takes_the_place_of_processes():
    before, each = _core.threads(), []
    options = {"on_failure": text, "executor": Executor(), "each": each.append}
    assert run_all(double, [1, -2, 3], [1.0, 2.0, 1.0], **options) == [2, "-2: ValueError -2 is negative", 6]
    assert sorted(each, key=str) == ["-2: ValueError -2 is negative", 2, 6]
    _core.set_threads(2)
    ((threads, _, pid),) = run_all(surroundings, [0], [1.0], **options)
    assert (threads, pid, _core.threads()) == (1, os.getpid(), 2)
    _core.set_threads(before)


SCRIPT = """
import os
import time
from umform.pool import run_all

def tell_and_sleep(number):
    os.write(1, f"{number}\\n".encode())  # at once: print writes the end of the line by itself
    time.sleep(300)

if __name__ == "__main__":
    run_all(tell_and_sleep, [0, 1], [1.0, 1.0], on_failure=print, processes=2)
"""


def test_processes_end_when_the_one_that_waits_for_them_is_killed(tmp_path):
    (tmp_path / "script.py").write_text(SCRIPT)
    parent = subprocess.Popen([sys.executable, tmp_path / "script.py"], stdout=subprocess.PIPE, text=True)
    assert {parent.stdout.readline(), parent.stdout.readline()} == {"0\n", "1\n"}
    parent.kill()
    assert parent.communicate(timeout=60) == ("", None)  # the pipe is closed when all of them have ended


def test_less_than_one_process_is_refused():
    with pytest.raises(InvalidValue, match="processes"):
        run_all(double, [1], [1.0], on_failure=text, processes=0)
