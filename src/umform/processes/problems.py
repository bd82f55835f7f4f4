"""The problem of a case of any process, and what the process reports of its run."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from umform.errors import InvalidValue

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
        A bend has no stroke, or this is no such case.
    """
    made: Problem = _function(case, "problem")(case)
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
    found: Outcome = _function(case, "outcome")(case, result)
    return found


def _function(case: Any, file: str) -> Any:
    """The function ``<file>_of`` of a file in the folder of the process."""
    module = f"{type(case).__module__.rpartition('.')[0]}.{file}".lstrip(".")
    try:
        return getattr(import_module(module), f"{file}_of")
    except (ModuleNotFoundError, AttributeError) as error:
        if error.name not in (module, f"{file}_of"):
            raise
        raise InvalidValue(
            "this is no case of a process with one problem",
            where=f"{file}_of",
            value=type(case).__name__,
            cause="several operations, of which each has a problem, or another object",
            remedy="a case such as AirBending(stroke=6.0), or a Problem",
        ) from None
