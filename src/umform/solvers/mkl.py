"""MKL from the PyPI package `mkl`: where it is, and how it is loaded."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from ..errors import InvalidValue, SolveError

_LP64 = 0


@cache
def find() -> Path | None:
    """The file of the library, or None if MKL is not installed."""
    return next((path for path in _candidates() if path.suffix != ".lib" and path.is_file()), None)


@cache
def library() -> ctypes.CDLL:
    """Load MKL, once, with 32-bit integers."""
    path = find()
    if path is None:
        raise InvalidValue(
            "The solver 'pardiso' needs MKL, which is not installed",
            where="solver",
            cause="the extra pardiso is not installed",
            remedy='pip install "umform[pardiso]"',
        )
    try:
        loaded = ctypes.CDLL(str(path))
    except OSError as error:
        raise SolveError(
            "MKL is installed, but cannot be loaded",
            where=str(path),
            cause=str(error),
            remedy="reinstall the package mkl, or remove it: umform then uses its own solver",
        ) from error
    loaded.MKL_Set_Interface_Layer(_LP64)
    return loaded


@contextmanager
def threads(count: int | None) -> Iterator[None]:
    """Limit the number of threads of MKL for calls of this thread; None changes nothing."""
    if count is None:
        yield
        return
    before = library().MKL_Set_Num_Threads_Local(count)
    try:
        yield
    finally:
        library().MKL_Set_Num_Threads_Local(before)


def _candidates() -> Iterator[Path]:
    """Yield candidate files: beside Python as pip and conda install it, then among the files of the package `mkl`."""
    prefix = Path(sys.prefix)
    yield from sorted(prefix.glob("lib/libmkl_rt.so*"), reverse=True)  # the newest
    yield from sorted(prefix.glob("Library/bin/mkl_rt*.dll"), reverse=True)
    if not any(any(Path(folder).glob("mkl-*.dist-info")) for folder in sys.path):
        return  # before an import that takes some per cent of a short run
    from importlib import metadata

    try:
        files = metadata.files("mkl") or []
    except metadata.PackageNotFoundError:
        return
    yield from (Path(str(file.locate())).resolve() for file in files if "mkl_rt" in file.name)
