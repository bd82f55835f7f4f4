"""BLAS of SciPy for the kernels: function addresses, without importing the whole of ``scipy.linalg``."""

from __future__ import annotations

import ctypes
import functools
import sys
import threading
from collections.abc import Callable
from importlib import import_module, util
from importlib.machinery import PathFinder
from pathlib import Path
from types import ModuleType

from .. import _core

# Functions that set and get the number of threads of OpenBLAS, as built for SciPy, for NumPy (64-bit integers), or by
# others.
_CONTROLS = [
    (f"{prefix}_set_num_threads{suffix}", f"{prefix}_get_num_threads{suffix}")
    for prefix in ("scipy_openblas", "openblas")
    for suffix in ("", "64_")
]
_first = threading.Lock()


def hand_over() -> None:
    """Pass the functions of BLAS to the kernels, once per process; other threads wait until it is done."""
    with _first:
        _hand_over()


@functools.cache
def _hand_over() -> None:
    module = _module("scipy.linalg.cython_blas")
    _core.set_blas(module.__pyx_capi__, *_thread_control(module))


def _module(name: str) -> ModuleType:
    """A compiled module of SciPy, without importing its package, which takes 0.2 s."""
    if name in sys.modules:
        return sys.modules[name]
    import scipy

    folder = Path(str(scipy.__file__)).parent / "linalg"
    spec = PathFinder.find_spec(name, [str(folder)])
    if spec is None or spec.loader is None:
        return import_module(name)
    module = util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _thread_control(module: ModuleType) -> tuple[int, int]:
    """Addresses of the functions that set and get the number of threads of BLAS; 0 if there are none."""
    functions = thread_functions(module)
    if functions is None:
        return 0, 0
    set_threads, get_threads = (ctypes.cast(one, ctypes.c_void_p).value for one in functions)  # type: ignore[arg-type]
    return set_threads or 0, get_threads or 0


def thread_functions(module: ModuleType) -> tuple[Callable[[int], None], Callable[[], int]] | None:
    """Functions that set and get the number of threads of the OpenBLAS that a compiled module is linked to."""
    library = ctypes.CDLL(str(module.__file__))  # searches linked libraries as well
    for pair in _CONTROLS:
        if all(hasattr(library, name) for name in pair):
            return getattr(library, pair[0]), getattr(library, pair[1])
    return None
