"""NumPy's BLAS on one thread."""

from __future__ import annotations

import functools
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from .blas import thread_functions

_NUMPY = ("numpy._core._multiarray_umath", "numpy.core._multiarray_umath")  # NumPy 2, NumPy 1


class _Threads:
    """How many threads NumPy's OpenBLAS has: one while anybody uses it so."""

    def __init__(self) -> None:
        self._lock, self._users, self._before = threading.Lock(), 0, 1
        module = next((sys.modules[name] for name in _NUMPY if name in sys.modules), None)
        self._functions = None if module is None else thread_functions(module)

    def enter(self) -> None:
        with self._lock:
            self._users += 1
            if self._functions is not None and self._users == 1:
                set_threads, get_threads = self._functions
                self._before = get_threads()
                set_threads(1)

    def leave(self) -> None:
        with self._lock:
            self._users -= 1
            if self._functions is not None and self._users == 0:
                self._functions[0](self._before)


_threads = functools.cache(_Threads)


@contextmanager
def one_thread() -> Iterator[None]:
    """Keep NumPy's products on the calling thread in this block: the same bits on any number of processors.

    After each product the other threads of OpenBLAS wait actively for some 30 ms. A run makes a few small products per
    iteration: these threads would take all processors for its whole time, from the kernels as well.
    """
    threads = _threads()
    threads.enter()
    try:
        yield
    finally:
        threads.leave()
