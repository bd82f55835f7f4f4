"""Classes that refuse an unknown parameter with the names of those that they have."""

from __future__ import annotations

from functools import wraps
from inspect import signature
from typing import Any, TypeVar

from umform.errors import InvalidValue

C = TypeVar("C", bound=type)


def names_its_words(kind: C) -> C:
    """Decorator of a dataclass: an unknown keyword is an error that lists the known ones.

    Raises
    ------
    InvalidValue
        In the class, in place of the TypeError of Python.
    """
    made = kind.__init__  # type: ignore[misc]
    words = [name for name in signature(made).parameters if name != "self"]

    @wraps(made)
    def init(self: Any, *arguments: Any, **named: Any) -> None:
        unknown = [name for name in named if name not in words]
        if unknown:
            raise InvalidValue(
                f"{kind.__name__} has no parameter {unknown[0]}",
                where=kind.__name__,
                value=named[unknown[0]],
                cause=f"a parameter of something other than {kind.__name__}, or another spelling",
                remedy=f"its parameters are {', '.join(words)}",
            )
        made(self, *arguments, **named)

    kind.__init__ = init  # type: ignore[misc]
    return kind
