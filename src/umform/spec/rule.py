"""Refusal of invalid parameters, and conditions that a type and bounds do not express."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any

from umform.errors import InvalidValue, NotFinite
from umform.spec.parameter import Parameter, are_several, parameters


@dataclass(frozen=True)
class Rule:
    """Condition on a parameter; as metadata of a type it is checked after type and bounds.

    Attributes
    ----------
    fits : callable
        Whether a value is valid.
    what : str
        What is wrong otherwise.
    cause, remedy : str
        Likely cause, and remedy.
    """

    fits: Callable[[Any], bool]
    what: str
    cause: str
    remedy: str

    def optional(self) -> Rule:
        """The same for an optional parameter, which may be None."""
        return Rule(lambda value: value is None or self.fits(value), self.what, self.cause, self.remedy)

    def check(self, name: str, value: Any) -> None:
        """Reject an invalid value.

        Raises
        ------
        NotFinite
            If it is NaN or infinite.
        InvalidValue
            ``where`` is the name.
        """
        if not self.fits(value):
            raise _error(self.what, name, value, self.cause, self.remedy)


@dataclass(frozen=True)
class Checked:
    """Condition that a function checks; metadata of a type as `Rule`.

    Attributes
    ----------
    function : callable
        Takes value and name, and raises `InvalidValue`.
    """

    function: Callable[[Any, str], object]

    def fits(self, value: Any) -> bool:
        """Whether a value is valid."""
        try:
            self.function(value, "")
        except InvalidValue:
            return False
        return True

    def check(self, name: str, value: Any) -> None:
        """Reject an invalid value."""
        self.function(value, name)


def check_fields(spec: Any) -> None:
    """Reject invalid values of a Spec, one by one.

    Raises
    ------
    NotFinite, InvalidValue
        ``where`` is the name of the field.
    """
    kind: type = type(spec)
    for name in parameters(kind):
        check_value(kind, name, getattr(spec, name))


def check_arguments(function: Callable[..., Any], at: str = "", /, **values: Any) -> None:
    """Reject invalid arguments of a function: their types and bounds are those of its signature.

    Parameters
    ----------
    function : callable
        The function.
    at : str
        Place for the message; by default the name of the function.
    **values
        Arguments.

    Raises
    ------
    NotFinite, InvalidValue
        ``where`` is the place and the name of the argument.
    """
    for name, value in values.items():
        try:
            check_value(function, name, value)
        except InvalidValue as error:
            error.where = f"{at or function.__name__}, {name}"
            raise


def check_value(spec: Any, name: str, value: Any) -> None:
    """Reject an invalid value of one field of a Spec, or of an argument of a function.

    Raises
    ------
    NotFinite, InvalidValue
        ``where`` is the name of the field.
    """
    parameter = parameters(spec)[name]
    if value is None and parameter.absent:
        return
    kind = parameter.kind_of(value)
    if kind is None:
        told = all(kind.type in (int, float, str, Collection, object) for kind in parameter.kinds)
        what = f"{parameter.subject if told else name} must be {parameter.must_be}"
        cause = parameter.about.cause or _cause(parameter, value)
        raise _error(what, name, value, cause, parameter.remedy, parameter.about.error)
    for rule in kind.rules:
        rule.check(name, value)


def _cause(parameter: Parameter, value: Any) -> str:
    """Why a value is none of a parameter, where its type does not say it."""
    if value is None:
        return "a missing value"
    if any(kind.is_of(value) for kind in parameter.kinds):
        return "a typing error"
    entries = [kind for one in parameter.kinds for kind in one.entries] if are_several(value) else []
    wrong = [one for one in value if not any(kind.is_of(one) for kind in entries)] if entries else []
    return f"an entry of type {type(wrong[0]).__name__}" if wrong else f"a value of type {type(value).__name__}"


def _error(
    what: str, name: str, value: Any, cause: str, remedy: str, kind: type[InvalidValue] | None = None
) -> InvalidValue:
    if kind is None:
        kind = NotFinite if isinstance(value, float) and not math.isfinite(value) else InvalidValue
    return kind(what, where=name, value=str(value), cause=cause, remedy=remedy)
