"""The problem of a case of any process, and what the process reports of its run."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from umform.analysis.run import Result
    from umform.problem.problem import Problem
    from umform.results.outcome import Outcome


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
    made: Problem = _room(case, "problem").problem_of(case)
    return made


def outcome_of(case: Any, result: Result) -> Outcome:
    """What a process reports of a run of its problem, from the file ``outcome.py`` of its folder.

    Parameters
    ----------
    case : Spec
        The parameters.
    result : Result
        A run with a frame at the end of each step.
    """
    found: Outcome = _room(case, "outcome").outcome_of(case, result)
    return found


def _room(case: Any, file: str) -> Any:
    return import_module(f"{type(case).__module__.rpartition('.')[0]}.{file}")
