"""Slopes from whole runs: where results jump, the derivatives of one run do not hold beside it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from annotated_types import Ge, Gt, Le

from umform.errors import InvalidValue
from umform.pool import run_all
from umform.progress import Show, progress_bar
from umform.results.outcome import Outcome
from umform.spec import About, Scalar, changed, check_fields, scalars, takes
from umform.studies.derivatives.derive import known_parameter
from umform.studies.slopes.found import Numbers, Run, Slopes


@dataclass(frozen=True)
class SlopeOptions:
    """Which runs the slopes are taken from."""

    width: Annotated[float, Gt(0.0), Le(0.5), About(cause="per cent instead of a part of one")] = 0.02
    """Half of the range of each parameter, over its value."""
    each_side: Annotated[int, Ge(1), Le(20)] = 2
    """Runs with smaller values of each parameter, and with larger ones, at equal distances."""

    def __post_init__(self) -> None:
        check_fields(self)


@takes(SlopeOptions)
def slopes(
    process: Callable[[Any], Outcome],
    case: Any,
    by: Sequence[str],
    *,
    base: Outcome | None = None,
    processes: int | None = None,
    progress: Show = None,
    **options: Any,
) -> Slopes:
    """Slopes of the results of a process over a range of each parameter, by least squares through whole runs.

    The runs go in parallel processes, which are spawned: a script that calls this needs
    ``if __name__ == "__main__":``.

    Parameters
    ----------
    process : callable
        Runs a case, as `hemming` and `air_bending`; a function of a module.
    case : Spec
        The parameters; an angle that is a goal stays one.
    by : sequence of str
        Paths of numbers of the case, or their ends.
    base : Outcome, optional
        That of the case, if it has been run.
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

    Examples
    --------
    >>> import umform as uf
    >>> from umform.processes.hemming import Hemming, hemming
    >>> found = uf.slopes(hemming, Hemming(form="rope"), ["gap"])  # doctest: +SKIP
    >>> found["roll_in", "gap"].value, found["roll_in", "gap"].band  # doctest: +SKIP
    """
    planned = planned_runs(case, by, **options)
    made = process(case) if base is None else base
    with progress_bar(progress) as tick:
        answers = run_all(
            _numbers,
            [_Task(process, changed(case, {path: value})) for path, value in planned],
            [1.0] * len(planned),
            on_failure=lambda task, error: str(error).splitlines()[0],
            processes=processes,
            tick=lambda done: tick("slopes", done),
        )
    runs = [Run(path, value, answer) for (path, value), answer in zip(planned, answers, strict=True)]
    return Slopes.of(parameters_of(case, by), made, runs, SlopeOptions(**options).width)


@takes(SlopeOptions)
def planned_runs(case: Any, by: Sequence[str], **options: Any) -> list[tuple[str, float]]:
    """Path and value of the parameter of each run of `slopes`.

    Raises
    ------
    InvalidValue
        As `slopes`.
    """
    wanted = SlopeOptions(**options)
    steps = [step for step in range(-wanted.each_side, wanted.each_side + 1) if step]
    runs = [
        (one.path, one.value * (1.0 + wanted.width * step / wanted.each_side))
        for one in parameters_of(case, by)
        for step in steps
    ]
    for path, value in runs:
        changed(case, {path: value})
    return runs


def parameters_of(case: Any, by: Sequence[str]) -> list[Scalar]:
    """The numbers of a case by their paths, or the ends of these, each once.

    Raises
    ------
    InvalidValue
        There is none, it is a whole number, or zero.
    """
    known = {one.path: one for one in scalars(case)}
    found = {one.path: one for one in (known_parameter(name, known) for name in by)}
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


@dataclass(frozen=True)
class _Task:
    process: Callable[[Any], Outcome]
    case: Any


def _numbers(task: _Task) -> Numbers | str:
    """Numbers of a run by their names; what has gone wrong, if it has."""
    return {one.name: one.value for one in task.process(task.case).quantities}
