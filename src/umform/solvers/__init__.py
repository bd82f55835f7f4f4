"""Sparse solvers: the protocol, one file per solver, and their selection.

``auto`` selects umform's multifrontal solver, which is as fast as the fastest of the others, from strips to large
sheets (``benchmarks/sparse.py``). The others are for comparison. `register` adds your own solver.
"""

from __future__ import annotations

import logging
from collections.abc import Callable

from ..errors import InvalidValue
from .multifrontal import Multifrontal
from .protocol import Factorisation, Pattern, SparseSolver

__all__ = ["Factorisation", "Pattern", "SparseSolver", "available", "make_solver", "register"]

_log = logging.getLogger("umform.solvers")


def _pardiso() -> SparseSolver:
    from .pardiso import Pardiso

    return Pardiso()


def _banded() -> SparseSolver:
    from .banded import Banded

    return Banded()


def _superlu() -> SparseSolver:
    from .superlu import SuperLU

    return SuperLU()


# Only the solver in use is imported.
_factories: dict[str, Callable[[], SparseSolver]] = {
    "multifrontal": Multifrontal,
    "pardiso": _pardiso,
    "banded": _banded,
    "superlu": _superlu,
}


def register(name: str, factory: Callable[[], SparseSolver]) -> None:
    """Register a solver under a name.

    Parameters
    ----------
    name : str
        The name for `make_solver`; a solver of this name is replaced.
    factory : callable
        Returns a new solver; for instance the class itself.
    """
    if name == "auto":
        raise InvalidValue("The name 'auto' stands for the choice among the solvers", remedy="take another")
    _factories[name] = factory


def available() -> dict[str, bool]:
    """For each solver, whether it can run on this machine."""
    from . import pardiso

    return {name: name != "pardiso" or pardiso.available() for name in _factories}


def make_solver(pattern: Pattern, name: str = "auto") -> SparseSolver:
    """A new solver that has analysed the pattern.

    Parameters
    ----------
    pattern : Pattern
        Pattern of the matrix.
    name : str, optional
        One of `available`, or ``auto`` for the fastest one.
    """
    if name == "auto":
        name = "multifrontal"
        _log.info("solver: %s", name)
    if name not in _factories:
        raise InvalidValue(
            "There is no solver of this name",
            where="solver",
            value=name,
            cause="a typing error, or one that is not installed",
            remedy=f"choose one of {', '.join(['auto', *_factories])}",
        )
    solver = _factories[name]()
    missing = [method for method in ("analyse", "factor", "solve") if not callable(getattr(solver, method, None))]
    if missing:
        raise InvalidValue(
            "A sparse solver has the methods analyse, factor and solve",
            where=f"solver {name}",
            value=f"{type(solver).__name__} without {', '.join(missing)}",
            cause="another interface, such as factors that solve",
            remedy="the methods of umform.solvers.SparseSolver; register takes the class or a function that makes one",
        )
    solver.analyse(pattern)
    return solver
