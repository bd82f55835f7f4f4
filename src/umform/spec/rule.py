"""Refusal of invalid parameters, and conditions that a type and bounds do not express."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from umform.errors import InvalidValue, NotFinite
from umform.spec.parameter import parameters


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
        subject = name if bool in (kind.type for kind in parameter.kinds) else parameter.subject
        what = f"{subject} must be {parameter.must_be}"
        raise _error(what, name, value, parameter.about.cause, parameter.remedy, parameter.about.error)
    for rule in kind.rules:
        rule.check(name, value)


def _error(
    what: str, name: str, value: Any, cause: str, remedy: str, kind: type[InvalidValue] | None = None
) -> InvalidValue:
    if kind is None:
        kind = NotFinite if isinstance(value, float) and not math.isfinite(value) else InvalidValue
    return kind(what, where=name, value=_shown(value), cause=cause, remedy=remedy)


def _shown(value: object) -> str:
    """A value as typed by hand: a mesh as 24x1."""
    if isinstance(value, tuple | list):
        return "x".join(map(str, value))
    return str(value)
