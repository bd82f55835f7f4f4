"""The problem of a case of any process, and what the process reports of its run."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
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


@dataclass(frozen=True)
class Operation:
    """One of several operations, each from the end of the one before.

    Attributes
    ----------
    name : str
        Letters, digits, hyphens.
    problem : callable
        Takes the run of the operation before, None for the first one; returns the problem.
    alone : bool
        Whether it also takes None in place of an operation before: elements and steps are those, the state is not.
    """

    name: str
    problem: Callable[[Result | None], Problem]
    alone: bool = True


def has_operations(case: Any) -> bool:
    """Whether a case is of a process of several operations: `BendSequence`, `Hemming`."""
    return _folder(case).startswith(__package__ or "") and find_spec(_module(case, "operations")) is not None


def is_process_of(process: Callable[..., Any], case: Any) -> bool:
    """Whether a function is in the folder of the process of a case."""
    folder = _folder(case)
    return folder.startswith(__package__ or "") and str(getattr(process, "__module__", "")).startswith(f"{folder}.")


def operations_of(case: Any) -> Sequence[Operation]:
    """The operations of a case, from the file ``operations.py`` of its folder.

    Parameters
    ----------
    case : Spec
        The parameters, with a stroke for each bend.

    Raises
    ------
    InvalidValue
        A bend has no stroke, or this is no such case.
    """
    found: Sequence[Operation] = _function(case, "operations")(case)
    return found


def outcome_of(case: Any, *results: Result) -> Outcome:
    """What a process reports of the runs of its problem or operations, from the file ``outcome.py`` of its folder.

    Parameters
    ----------
    case : Spec
        The parameters.
    *results : Result
        The run of each, with as many frames of each step as `frames_of` says.
    """
    found: Outcome = _function(case, "outcome")(case, *results)
    return found


def frames_of(case: Any) -> int:
    """States of each step that the numbers of a process follow from, ``FRAMES`` beside ``outcome_of``; else its end.

    Parameters
    ----------
    case : Spec
        The parameters.
    """
    frames: int = getattr(import_module(_module(case, "outcome")), "FRAMES", 1)
    return frames


def quantities_named(case: Any) -> Collection[str] | None:
    """Names of all quantities that a process may report, by ``names_of`` beside ``outcome_of``; None: known later.

    Parameters
    ----------
    case : Spec
        The parameters.
    """
    names_of = getattr(import_module(_module(case, "outcome")), "names_of", None)
    return None if names_of is None else names_of(case)


def _module(case: Any, file: str) -> str:
    return f"{_folder(case)}.{file}".lstrip(".")


def _folder(case: Any) -> str:
    return type(case).__module__.rpartition(".")[0]


def _function(case: Any, file: str) -> Any:
    """The function ``<file>_of`` of a file in the folder of the process."""
    module = _module(case, file)
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
