"""Values of a deck with several notations or kinds, so that only the errors of one are reported."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from operator import or_
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import Discriminator, Tag


def one_of_notations(arms: Sequence[Any], optional: bool) -> Any:
    """One of several types, told by their notations if these differ, so that only the errors of one are reported."""
    noted = {_notation(arm): arm for arm in arms}
    one = one_of_tags(noted, _notation) if 1 < len(noted) == len(arms) else reduce(or_, arms)
    return one | None if optional else one


def one_of_tags(arms: Mapping[str, Any], which: Callable[[Any], str]) -> Any:
    """One of several types, by their tags."""
    noted = [Annotated[arm, Tag(tag)] for tag, arm in arms.items()]
    return Annotated[reduce(or_, noted), Discriminator(which)]


def _notation(value: Any) -> str:
    """How TOML writes a value, or the values of a type: a word, a number, an array or a table."""
    kind = value
    while get_origin(kind) is Annotated:
        kind = get_args(kind)[0]
    kind = get_origin(kind) or (kind if isinstance(kind, type) else type(kind))
    if kind in (str, Literal):
        return "word"
    return "number" if kind in (int, float, bool) else "array" if kind in (list, tuple) else "table"
