"""The problem of a case of any process."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from umform.problem.problem import Problem


def problem_of(case: Any) -> Problem:
    """The problem of a case of a ready process: `AirBending`, `FreeBending`, `Cup`, `UBend`, `DrawBead`.

    Each folder of a process has a file ``problem.py`` with a function of this name. What it gives has the history of
    the process to the last bit; its `toml` is a deck for `umform run`, its `with_` the problem with other values.

    Parameters
    ----------
    case : Spec
        The parameters; a bend needs its stroke.

    Raises
    ------
    InvalidValue
        A bend has no stroke.
    """
    made: Problem = import_module(f"{type(case).__module__.rpartition('.')[0]}.problem").problem_of(case)
    return made
