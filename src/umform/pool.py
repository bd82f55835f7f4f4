"""Independent runs in parallel processes, one thread each; results come in the order of the tasks."""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import TypeVar

from umform import _core
from umform.errors import InvalidValue, SolveError
from umform.log import log_to_stderr

Task = TypeVar("Task")
Answer = TypeVar("Answer")

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def run_all(
    function: Callable[[Task], Answer],
    tasks: Sequence[Task],
    costs: Sequence[float],
    *,
    on_failure: Callable[[Task, Exception], Answer],
    processes: int | None = None,
    tick: Callable[[float], None] = lambda fraction: None,
) -> list[Answer]:
    """Apply a function to all tasks, the dearest ones first.

    Processes are spawned, so a script that calls this needs ``if __name__ == "__main__":``.

    Parameters
    ----------
    function : callable
        A function of a module.
    tasks, costs : sequence
        What it is called with, and how long this will take, in any unit.
    on_failure : callable
        Makes the answer for a task whose call raised an exception; the other tasks go on.
    processes : int, optional
        How many at a time; default: as many as this process may use processors, at most one a task. With one,
        everything happens here.
    tick : callable
        Is told the part of the costs that is done.

    Raises
    ------
    InvalidValue
        If the number of processes is less than 1.
    """
    check_processes(processes)
    count = min(processes or _processors(), len(tasks))
    order = sorted(range(len(tasks)), key=lambda number: -costs[number])
    answers: dict[int, Answer] = {}
    if count <= 1:
        with _one_kernel_thread():
            for number in order:
                try:
                    answers[number] = function(tasks[number])
                except Exception as error:
                    answers[number] = on_failure(tasks[number], error)
                tick(sum(costs[done] for done in answers) / sum(costs))
        return [answers[number] for number in range(len(tasks))]

    level = logging.getLogger("umform").getEffectiveLevel()
    spawn = multiprocessing.get_context("spawn")
    with (
        _environment(dict.fromkeys(_THREADS, "1")),
        ProcessPoolExecutor(count, mp_context=spawn, initializer=_prepare, initargs=(level,)) as pool,
    ):
        futures = {pool.submit(function, tasks[number]): number for number in order}
        try:
            for future in as_completed(futures):
                number = futures[future]
                try:
                    answers[number] = future.result()
                except BrokenProcessPool:  # it takes along all tasks that are not done
                    answers[number] = on_failure(tasks[number], _died())
                except Exception as error:
                    answers[number] = on_failure(tasks[number], error)
                tick(sum(costs[done] for done in answers) / sum(costs))
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
    return [answers[number] for number in range(len(tasks))]


def check_processes(processes: int | None) -> None:
    """Refuse a number of processes that is less than 1, for callers that do something else first.

    Raises
    ------
    InvalidValue
    """
    if processes is not None and processes < 1:
        raise InvalidValue(
            "the number of processes must be 1 or more",
            where="processes",
            value=processes,
            cause="zero or a sign",
            remedy="leave it out: then there are as many as processors",
        )


def _died() -> SolveError:
    return SolveError(
        "a process that computes runs has died, this run or one beside it",
        cause="it was killed, perhaps for want of memory",
        remedy="run again with fewer: processes=1",
    )


def _processors() -> int:
    """Number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _prepare(level: int) -> None:
    """Make a new process ready: one kernel thread, the log of its parent, silent on Ctrl-C.

    Without a log, warnings come back with the answers and are not printed here too.
    """
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    _core.set_threads(1)
    if level < logging.WARNING:
        log_to_stderr(level)
    else:
        logging.getLogger("umform").addHandler(logging.NullHandler())


@contextmanager
def _one_kernel_thread() -> Iterator[None]:
    before = _core.threads()
    _core.set_threads(1)
    try:
        yield
    finally:
        _core.set_threads(before)


@contextmanager
def _environment(variables: dict[str, str]) -> Iterator[None]:
    """Set environment variables for processes to be started."""
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
