"""Functions whose further arguments are the fields of a Spec, or arguments of another function."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING
from inspect import Parameter, signature
from typing import Any, TypeVar

from umform.spec.parameter import declared

F = TypeVar("F", bound=Callable[..., Any])


def takes(spec: Any, *leave: str) -> Callable[[F], F]:
    """Decorator of a function whose ``**options`` are fields of a Spec: its signature names them with their defaults.

    Parameters
    ----------
    spec : type or function
        The Spec, or the other function.
    *leave : str
        Fields that are arguments of the function already.
    """

    def add(function: F) -> F:
        own = signature(function)
        options = [
            Parameter(
                one.name,
                Parameter.KEYWORD_ONLY,
                default=Parameter.empty if one.default is MISSING else one.default,
                annotation=one.type,
            )
            for one in declared(spec)
            if one.name not in leave
        ]
        function.__signature__ = own.replace(parameters=[*list(own.parameters.values())[:-1], *options])  # type: ignore[attr-defined]
        return function

    return add
