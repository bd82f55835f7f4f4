"""Sparse solvers: the protocol, one file per solver, and the choice among them.

``auto`` takes the fastest one present: the banded Cholesky solver for symmetric matrices of narrow band (long
strips), else PARDISO, else SuperLU. A solver of your own joins with `register`.
The ratios in these files were measured on a machine with two cores; ``benchmarks/sparse.py`` prints those of yours.
"""

from __future__ import annotations

import logging
from collections.abc import Callable

from ..errors import InvalidValue
from . import pardiso
from .band_order import wider_than
from .banded import Banded
from .pardiso import Pardiso
from .protocol import Factorisation, Pattern, SparseSolver

__all__ = ["Factorisation", "Pattern", "SparseSolver", "available", "make_solver", "register"]

_log = logging.getLogger("umform.solvers")

# Up to these bandwidths the banded solver is ahead of PARDISO and of SuperLU.
_NARROW_FOR_PARDISO, _NARROW_FOR_SUPERLU = 32, 128


def _superlu() -> SparseSolver:
    from .superlu import SuperLU  # slow to import

    return SuperLU()


def _multifrontal() -> SparseSolver:
    from .multifrontal import Multifrontal

    return Multifrontal()


_factories: dict[str, Callable[[], SparseSolver]] = {
    "multifrontal": _multifrontal,
    "pardiso": Pardiso,
    "banded": Banded,
    "superlu": _superlu,
}


def register(name: str, factory: Callable[[], SparseSolver]) -> None:
    """Make a solver known by a name.

    Parameters
    ----------
    name : str
        The name that `make_solver` is asked for; a solver of this name is replaced.
    factory : callable
        Returns a new solver, such as the class itself.
    """
    if name == "auto":
        raise InvalidValue("The name 'auto' stands for the choice among the solvers", remedy="take another")
    _factories[name] = factory


def available() -> dict[str, bool]:
    """Return for each solver whether it can run here."""
    return {name: name != "pardiso" or pardiso.available() for name in _factories}


def make_solver(pattern: Pattern, name: str = "auto") -> SparseSolver:
    """Return a solver that has analysed the pattern.

    Parameters
    ----------
    pattern : Pattern
        Where the matrix has entries.
    name : str, optional
        One of `available`, or ``auto`` for the fastest one present.
    """
    if name == "auto":
        return _fastest(pattern)
    if name not in _factories:
        raise InvalidValue(
            "There is no solver of this name",
            value=name,
            remedy=f"choose one of {', '.join(['auto', *_factories])}",
        )
    solver = _factories[name]()
    solver.analyse(pattern)
    return solver


def _fastest(pattern: Pattern) -> SparseSolver:
    """Return the solver that `auto` stands for, and say in one line of log which and what would be faster."""
    has_pardiso = available()["pardiso"]
    narrow = _NARROW_FOR_PARDISO if has_pardiso else _NARROW_FOR_SUPERLU
    hint = "" if has_pardiso else '; faster: pip install "umform[pardiso]"'
    if pattern.symmetric and not wider_than(narrow, pattern):
        banded = Banded()
        banded.analyse(pattern)
        if banded.bandwidth <= narrow:
            _log.info("solver: banded%s", hint if banded.bandwidth > _NARROW_FOR_PARDISO else "")
            return banded
    name = "pardiso" if has_pardiso else "superlu"
    _log.info("solver: %s%s", name, hint)
    return make_solver(pattern, name)
