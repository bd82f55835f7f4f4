"""Responses: numbers of a run whose derivatives are wanted."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

from umform.analysis.run import Result
from umform.analysis.run.loose import carried
from umform.analysis.steps import Free, Step
from umform.errors import InvalidValue
from umform.model import Model
from umform.problem.errors import slip
from umform.results.quantity import Quantity
from umform.studies.sweep.measures import Function, Measure, column_number


@dataclass(frozen=True)
class Response:
    """A number of a run.

    Attributes
    ----------
    quantity : Quantity
        Label and unit; its value is that of the run.
    column : str
        Column of the history with its statistic, if it is no quantity.
    function : callable, optional
        A function of a result, if it is neither.
    """

    quantity: Quantity
    column: str = ""
    function: Function | None = None

    @property
    def name(self) -> str:
        """Its name."""
        return self.quantity.name

    def value(self, quantities: Mapping[str, float | None], result: Result) -> float | None:
        """The number of another run."""
        if self.function is not None:
            return _number(self.function, result).value
        return column_number(result, self.column) if self.column else quantities.get(self.name)


def responses(
    wanted: Sequence[str | Function] | None, quantities: Sequence[Quantity], result: Result, where: str = "of"
) -> list[Response]:
    """The wanted numbers with their values in a run; by default all quantities, or forces of the controls.

    Raises
    ------
    InvalidValue
        There is no such quantity or column, or two have the same name.
    """
    known = {one.name: one for one in quantities if one.value is not None}
    if wanted is None:
        forces = [f"{control.name}_force" for control in result.model.controls]
        wanted = list(known) or [f"{name}:{stat}" for name in forces for stat in ("last", "peak")]
    found = [_response(one, known, result, where) for one in wanted]
    names = [one.name for one in found]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InvalidValue(
            "two responses have the same name",
            where=where,
            value=twice,
            cause="two lambdas, or a name twice",
            remedy="functions with names of their own",
        )
    return found


def refuse_unknown(
    wanted: Sequence[str | Function], known: Collection[str], model: Model, steps: Sequence[Step], where: str = "of"
) -> None:
    """Refuse, before a run, what is no quantity, and what its history will not have.

    Parameters
    ----------
    wanted : sequence of str or callable
        Wanted numbers.
    known : collection of str
        Names of quantities; a beginning with a point at its end is that of all quantities of a measure.
    model, steps
        The model of the run at its beginning, and its steps.
    where : str
        Argument with the wanted numbers.

    Raises
    ------
    InvalidValue
    """
    names = [one for one in wanted if isinstance(one, str)]
    unknown = [one for one in names if one not in known and f"{one.partition('.')[0]}." not in known]
    if not unknown:
        return
    for step in steps:
        if isinstance(step, Free):
            step.prepare(model)  # its forces are columns
    with carried(model, steps):
        columns = list(Result(model).row(model.system.evaluate(model.state, tangent=False)))
        model.system.revert()
    for name in unknown:
        with _refused_at(where):
            column = Measure.of(name).column
        if column not in columns:
            listed = (f"{one} ..." if one.endswith(".") else one for one in known)
            raise _no_such(name, [*listed, *columns], where)


def _response(wanted: str | Function, known: Mapping[str, Quantity], result: Result, where: str) -> Response:
    if not isinstance(wanted, str):
        return Response(_number(wanted, result), function=wanted)
    if wanted in known:
        return Response(known[wanted])
    if wanted.partition(":")[0] in result.columns():
        with _refused_at(where):
            return Response(Quantity(wanted, value=column_number(result, wanted), digits=6), column=wanted)
    raise _no_such(wanted, [*known, *result.columns()], where)


@contextmanager
def _refused_at(where: str) -> Iterator[None]:
    """What is refused inside is refused at an argument."""
    try:
        yield
    except InvalidValue as error:
        error.where = where
        raise


def _no_such(wanted: str, names: Sequence[str], where: str) -> InvalidValue:
    names = list(dict.fromkeys(names))
    between = "; " if any("," in name for name in names) else ", "
    return InvalidValue(
        "the run has no such quantity or column",
        where=where,
        value=wanted,
        cause=slip(wanted, names, slip(wanted.partition(":")[0], names)),
        remedy=f"one of {between.join(names)}",
    )


def _number(function: Function, result: Result) -> Quantity:
    found = function(result)
    name = getattr(function, "__name__", "number")
    return replace(found, name=name) if isinstance(found, Quantity) else Quantity(name, value=float(found), digits=6)
