"""Responses: numbers of a run whose derivatives are wanted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from umform.analysis.run import Result
from umform.errors import InvalidValue
from umform.results.quantity import Quantity
from umform.studies.sweep.foreseen import no_such, refused_at
from umform.studies.sweep.measures import Function, answer_of, column_number


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


def _response(wanted: str | Function, known: Mapping[str, Quantity], result: Result, where: str) -> Response:
    if not isinstance(wanted, str):
        return Response(_number(wanted, result), function=wanted)
    if wanted in known:
        return Response(known[wanted])
    if wanted.partition(":")[0] in result.columns():
        with refused_at(where):
            return Response(Quantity(wanted, value=column_number(result, wanted), digits=6), column=wanted)
    raise no_such(wanted, [*known, *result.columns()], where)


def _number(function: Function, result: Result) -> Quantity:
    found = answer_of(function, result)
    name = getattr(function, "__name__", "number")
    return replace(found, name=name) if isinstance(found, Quantity) else Quantity(name, value=found, digits=6)
