"""Independent runs in parallel processes, one thread each; results come in the order of the tasks."""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor, as_completed
from contextlib import closing, contextmanager
from functools import partial
from numbers import Integral
from typing import TypeVar

from umform import _core
from umform.errors import InvalidValue, SolveError
from umform.log import log_to_stderr
from umform.processors import available

Task = TypeVar("Task")
Answer = TypeVar("Answer")
#: Indices of tasks, each with a call that returns its result, or raises its exception.
_Answers = Generator[tuple[int, Callable[[], Answer]], None, None]

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def run_all(
    function: Callable[[Task], Answer],
    tasks: Sequence[Task],
    costs: Sequence[float],
    *,
    on_failure: Callable[[Task, Exception], Answer],
    processes: int | None = None,
    executor: Executor | None = None,
    tick: Callable[[float], None] = lambda fraction: None,
    each: Callable[[Answer], None] = lambda answer: None,
) -> list[Answer]:
    """Apply a function to all tasks, the most expensive ones first.

    Processes are spawned, so a script that calls this needs ``if __name__ == "__main__":``.

    Parameters
    ----------
    function : callable
        A function of a module.
    tasks, costs : sequence
        Its arguments, and the estimated durations, in any unit.
    on_failure : callable
        Makes the result for a task whose call raised an exception; the other tasks continue.
    processes : int, optional
        Number of parallel processes; default: the number of processors available to this process, at most one per task.
        With 1 all tasks run in this process.
    executor : concurrent.futures.Executor, optional
        Runs the tasks instead of processes of this machine; it is not shut down.
    tick : callable
        Called with the completed fraction of the costs.
    each : callable
        Called with each result when it is available.

    Raises
    ------
    InvalidValue
        If the number of processes is no whole number from 1 on.
    """
    check_processes(processes)
    count = min(processes or available(), len(tasks))
    order = sorted(range(len(tasks)), key=lambda number: -costs[number])
    calls = {number: partial(function, tasks[number]) for number in order}
    answers: dict[int, Answer] = {}
    if executor is not None:
        run = _in_executor(calls, executor)
    else:
        run = _here(calls) if count <= 1 else _in_processes(calls, count)
    with closing(run) as finished:
        for number, answer in finished:
            try:
                answers[number] = answer()
            except BrokenExecutor:  # it terminates all unfinished tasks
                answers[number] = on_failure(tasks[number], _died())
            except Exception as error:
                answers[number] = on_failure(tasks[number], error)
            each(answers[number])
            tick(sum(costs[done] for done in answers) / sum(costs))
    return [answers[number] for number in range(len(tasks))]


def _here(calls: Mapping[int, Callable[[], Answer]]) -> _Answers[Answer]:
    """The calls, to be made in this process."""
    with _one_thread():
        yield from calls.items()


@contextmanager
def _one_thread() -> Iterator[None]:
    """Run the kernels with one thread in this block."""
    before = _core.threads()
    _core.set_threads(1)
    try:
        yield
    finally:
        _core.set_threads(before)


def _in_processes(calls: Mapping[int, Callable[[], Answer]], count: int) -> _Answers[Answer]:
    """Calls that return the results of other processes, which end immediately if no caller waits for them."""
    level, others = logging.getLogger("umform").getEffectiveLevel(), set(multiprocessing.active_children())
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(count, mp_context=spawn, initializer=_prepare, initargs=(level,)) as pool:
        try:
            futures = {pool.submit(call): number for number, call in calls.items()}
            for future in as_completed(futures):
                yield futures[future], future.result
        except BaseException:
            for process in set(multiprocessing.active_children()) - others:
                process.terminate()
            pool.shutdown(cancel_futures=True)  # waits for its thread, which the end of Python would meet half closed
            raise
        finally:
            for name, value in before.items():
                os.environ.pop(name, None)
                os.environ.update({} if value is None else {name: value})


def _in_executor(calls: Mapping[int, Callable[[], Answer]], executor: Executor) -> _Answers[Answer]:
    """Calls that return the results of an executor; pending tasks are cancelled if no caller waits for them."""
    futures = {}
    try:
        for number, call in calls.items():
            futures[executor.submit(_with_one_thread, call)] = number
        for future in as_completed(futures):
            yield futures[future], future.result
    finally:
        for future in futures:
            future.cancel()


def _with_one_thread(call: Callable[[], Answer]) -> Answer:
    """Call a function with one kernel thread, in any process."""
    with _one_thread():
        return call()


def check_processes(processes: object) -> None:
    """Reject a number of processes that is no whole number from 1 on, for an early check.

    Raises
    ------
    InvalidValue
    """
    if processes is not None and not (isinstance(processes, Integral) and int(processes) >= 1):
        raise InvalidValue(
            "the number of processes must be a whole number, 1 or more",
            where="processes",
            value=processes,
            cause="zero, a sign, or a fraction",
            remedy="omit it: then there are as many as processors",
        )


def _died() -> SolveError:
    return SolveError(
        "a process that computes runs has died, this run or one beside it",
        cause="it was killed, perhaps because memory ran out",
        remedy="run again with fewer: processes=1",
    )


def _prepare(level: int) -> None:
    """Initialise a process: one kernel thread, the log of its parent; Ctrl-C, SIGTERM and the end of the parent stop it
    immediately.

    Without a log, warnings are returned with the results and not printed here.
    """
    threading.Thread(target=_end_with_parent, daemon=True).start()
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # a run would first finish its increment
    signal.signal(signal.SIGTERM, lambda number, frame: os._exit(128 + number))
    _core.set_threads(1)
    if level < logging.WARNING:
        log_to_stderr(level)
    else:
        logging.getLogger("umform").addHandler(logging.NullHandler())


def _end_with_parent() -> None:
    """Wait for the end of the parent, which may be killed, and then end this process."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
