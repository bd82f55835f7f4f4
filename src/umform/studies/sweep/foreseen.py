"""Names of the numbers of a run that are known before it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager

from umform.analysis.run import Result
from umform.analysis.run.loose import carried
from umform.analysis.steps import Free, Step
from umform.errors import InvalidValue, UmformError
from umform.model import Model
from umform.problem import Problem
from umform.problem.errors import slip
from umform.problem.measured import may_report, names_begin
from umform.problem.unloading import loading_steps
from umform.studies.sweep.measures import SPRINGBACK, Function, Measure, no_springback

#: What the names of the checks of a run begin with.
_CHECKS = ("penetration of ", "drift of the energies")


def refuse_unknown(
    wanted: Sequence[str | Function],
    known: Collection[str],
    model: Model,
    steps: Sequence[Step],
    where: str = "of",
) -> None:
    """Refuse, before a run, what is no quantity, and what its history will not have.

    Parameters
    ----------
    wanted : sequence of str or callable
        Wanted numbers.
    known : collection of str
        Names of quantities.
    model, steps
        The model of the run at its beginning, and its steps.
    where : str
        Argument with the wanted numbers.

    Raises
    ------
    InvalidValue
    """
    unknown = [one for one in wanted if isinstance(one, str) and one not in known]
    if not unknown:
        return
    for step in steps:
        if isinstance(step, Free):
            step.prepare(model)  # its forces are columns
    with carried(model, steps):
        columns = list(Result(model).row(model.system.evaluate(model.state, tangent=False)))
        model.system.revert()
    for name in unknown:
        if name.partition(":")[0] not in columns:
            raise no_such(name, [*known, *columns], where)
        with refused_at(where):
            Measure.of(name)


def refuse_measures(problem: Problem, wanted: Sequence[str]) -> None:
    """Refuse measures of a sweep that its first job will not have; a job that cannot be built says so itself.

    Raises
    ------
    InvalidValue
    """
    contents = problem.contents
    if SPRINGBACK in wanted and loading_steps(contents) == len(contents.steps):
        raise no_springback()
    unknown = [one for one in wanted if not one.startswith((SPRINGBACK, *_CHECKS)) and not may_report(contents, one)]
    if not unknown:
        return
    try:
        made = problem.build()
    except UmformError:
        return
    refuse_unknown(unknown, [SPRINGBACK, *names_begin(contents)], made.model, made.steps, "measure")


@contextmanager
def refused_at(where: str) -> Iterator[None]:
    """What is refused inside is refused at an argument."""
    try:
        yield
    except InvalidValue as error:
        error.where = where
        raise


def no_such(wanted: str, names: Sequence[str], where: str) -> InvalidValue:
    """The error of a name that a run does not have."""
    names = list(dict.fromkeys(names))
    between = "; " if any("," in name for name in names) else ", "
    return InvalidValue(
        "the run has no such quantity or column",
        where=where,
        value=wanted,
        cause=slip(wanted, names, slip(wanted.partition(":")[0], names)),
        remedy=f"one of {between.join(names)}",
    )
