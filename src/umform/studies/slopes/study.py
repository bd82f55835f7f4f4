"""Slopes from whole runs: where results jump, the derivatives of one run do not hold beside it."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from annotated_types import Ge, Le

from umform.errors import InvalidValue, UmformError
from umform.pool import run_all
from umform.processes.problems import is_process_of, quantities_named
from umform.progress import Show, progress_bar
from umform.results.outcome import Outcome
from umform.spec import About, Scalar, check_fields, check_value, each, takes
from umform.studies.derivatives.derive import known_parameter, names_of, subject_of
from umform.studies.derivatives.responses import responses
from umform.studies.derivatives.subjects import OfFunction, Subject, refuse_same_model
from umform.studies.own_case import refuse_other_case
from umform.studies.slopes.found import Found, Run, Slopes, refuse_unknown
from umform.studies.sweep.measures import Function


@dataclass(frozen=True)
class SlopeOptions:
    """Which runs the slopes are taken from."""

    width: Annotated[float, Ge(1e-6), Le(0.5), About(cause="per cent instead of a part of one, or no range")] = 0.02
    """Half of the range of each parameter, over its value."""
    each_side: Annotated[int, Ge(1), Le(20)] = 2
    """Runs with smaller values of each parameter, and with larger ones, at equal distances."""

    def __post_init__(self) -> None:
        check_fields(self)


@takes(SlopeOptions)
def slopes(
    subject: Any,
    by: str | Sequence[str] | Mapping[str, float],
    of: str | Sequence[str | Function] | None = None,
    *,
    process: Callable[[Any], Outcome] | None = None,
    base: Outcome | None = None,
    processes: int | None = None,
    progress: Show = None,
    **options: Any,
) -> Slopes:
    """Slopes of results over a range of each parameter, by least squares through whole runs.

    The runs go in parallel processes, which are spawned: a script that calls this needs
    ``if __name__ == "__main__":``.

    Parameters
    ----------
    subject : Problem, case of a process, or callable
        As for `derivatives`.
    by : str, sequence of str, or mapping of str to float
        Paths of numbers, or their ends; parameters with their values for a function, which runs in this process.
    of : str, or sequence of str or callable, optional
        Results as for `derivatives`, each with a name of its own; with a process, names of its quantities.
    process : callable, optional
        Runs a case, as `hemming` and `air_bending`; a function of a module. An angle that is a goal stays one.
    base : Outcome, optional
        That of the case, if the process has run it.
    processes : int, optional
        Number of processes; default: that of the processors.
    progress : bool or callable, optional
        Show a progress bar.
    **options
        The fields of `SlopeOptions`.

    Returns
    -------
    Slopes
        With bands of 95 %, from the distances of the runs to the line.

    Raises
    ------
    InvalidValue
        A parameter does not exist, is a whole number or zero, or a value of its range is refused.
    UmformError
        The run of the case itself fails.

    Examples
    --------
    >>> import umform as uf
    >>> from umform.processes.hemming import Hemming, hemming
    >>> found = uf.slopes(Hemming(form="rope"), ["thickness"], process=hemming)  # doctest: +SKIP
    >>> found["roll_in", "thickness"].value, found["roll_in", "thickness"].band  # doctest: +SKIP
    """
    for name, value in {"by": by, "of": each(of)}.items():
        check_value(slopes, name, value)
    thing, wanted, of = subject_of(subject, by), SlopeOptions(**options), each(of)
    planned = planned_runs(subject, by, **options)
    if process is None:
        thing.refuse_unknown(thing.build(), of or ())
    elif is_process_of(process, thing.given) and (names := quantities_named(thing.given)) is not None:
        refuse_unknown(of or (), names)
    if base is not None:
        refuse_other_case(base, thing.given, "base")
    here = isinstance(thing, OfFunction)
    if here:
        refuse_same_model([thing.build(), thing.build()])
    elif processes != 1:
        _refuse_local(of, process)
    tasks = [_Task(thing.with_({path: value}), of, process) for path, value in planned]
    if base is None:
        tasks.append(_Task(thing, of, process))
    with progress_bar(progress) as tick:
        answers: list[Found | UmformError] = run_all(
            _run,
            tasks,
            [1.0] * len(tasks),
            on_failure=_failed,
            processes=1 if here else processes,
            tick=lambda done: tick("slopes", done),
        )
    first = answers.pop() if base is None else Found.of(base, of)
    if isinstance(first, UmformError):
        raise first
    runs = [Run(path, value, answer) for (path, value), answer in zip(planned, answers, strict=True)]
    return Slopes(tuple(_parameters(thing, by)), first.quantities, tuple(runs), wanted.width, first.main)


@takes(SlopeOptions)
def planned_runs(
    subject: Any, by: str | Sequence[str] | Mapping[str, float], **options: Any
) -> list[tuple[str, float]]:
    """Path and value of the parameter of each run of `slopes` beside that of the subject.

    Raises
    ------
    InvalidValue
        As `slopes`.
    """
    thing, wanted = subject_of(subject, by), SlopeOptions(**options)
    if not by:
        raise InvalidValue(
            "there is no parameter for slopes",
            where="by",
            cause="an empty list",
            remedy='by=["thickness"], for instance',
        )
    parameters = _parameters(thing, by)
    steps = [step for step in range(-wanted.each_side, wanted.each_side + 1) if step]
    runs = [
        (one.path, one.value * (1.0 + wanted.width * step / wanted.each_side)) for one in parameters for step in steps
    ]
    for path, value in runs:
        thing.with_({path: value})
    return runs


def _parameters(thing: Subject, by: str | Sequence[str] | Mapping[str, float]) -> list[Scalar]:
    """The numbers of these paths, each once; those that have a range."""
    known = {one.path: one for one in thing.parameters()}
    found = {one.path: one for one in (known_parameter(name, known) for name in names_of(thing, by))}
    for one in found.values():
        if one.value == 0.0:
            raise InvalidValue(
                "a number that is zero has no range about it",
                where=one.path,
                value=one.value,
                cause="its range is a part of its value",
                remedy="give it a value, such as half of the one that you compare with",
            )
    return list(found.values())


def _refuse_local(of: Sequence[str | Function] | None, process: Callable[[Any], Outcome] | None) -> None:
    """Refuse functions that other processes do not find."""
    for function in [*(one for one in of or () if callable(one)), *([process] if process else [])]:
        try:
            pickle.dumps(function)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise InvalidValue(
                "a function within another one, or of a notebook, is not known to other processes",
                where="of" if function is not process else "process",
                value=getattr(function, "__name__", function),
                cause=str(error),
                remedy="processes=1, or a function of a module",
            ) from None


@dataclass(frozen=True)
class _Task:
    thing: Subject
    of: Sequence[str | Function] | None
    process: Callable[[Any], Outcome] | None


def _failed(task: _Task, error: Exception) -> UmformError:
    """Why a run has no results; another error than of a run ends the study."""
    if not isinstance(error, UmformError):
        raise error
    return error


def _run(task: _Task) -> Found:
    """Results of a run."""
    if task.process is not None:
        return Found.of(task.process(task.thing.given), task.of)
    built = task.thing.build()
    results = built.solve(False)
    known = responses(task.of, task.thing.quantities(built, *results), results[-1])
    return Found(tuple(one.quantity for one in known), tuple(task.thing.main(*results)))
