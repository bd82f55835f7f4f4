"""Parameters of free bending as options of the command line: how they are written, read, and named in messages."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import fields

from umform.errors import InvalidValue, UmformError
from umform.processes.bending.parameters import FreeBending

_NAMES = {field.name for field in fields(FreeBending)} | {"processes", "out"}
_SETTING = re.compile(rf"\b({'|'.join(sorted(_NAMES, key=len, reverse=True))})=(\w+)")


def option(name: str) -> str:
    """The option of a parameter: --tie-e33 of tie_E33."""
    return "--" + name.lower().replace("_", "-")


def as_typed(text: str) -> str:
    """A text in which settings of Python, such as line_search=True, are options."""

    def written(match: re.Match[str]) -> str:
        name, value = match.groups()
        return option(name) if value == "True" else f"{option(name)} {value}"

    return _SETTING.sub(written, text)


def message(error: UmformError, options: Mapping[str, str]) -> str:
    """The message of an error that names options in place of parameters, which are given by name."""
    if isinstance(error, InvalidValue):  # a file may be called as a parameter is
        error.where = options.get(error.where, error.where)
    error.what, error.cause, error.remedy = map(as_typed, (error.what, error.cause, error.remedy))
    return str(error)


def read_mesh(text: str) -> tuple[int, int]:
    """The mesh that is written as 24x1."""
    along, _, across = text.lower().partition("x")
    if not (_is_count(along) and _is_count(across)):
        raise InvalidValue(
            "this is no mesh",
            where="mesh",
            value=repr(text),
            cause="a mesh is two whole numbers with an x between them",
            remedy="write the elements along and across the strip, such as 24x1",
        )
    return int(along), int(across)


def read_contact(text: str) -> int | str:
    """The contact rule that is written as nodes, 5 or 5x5."""
    first, _, second = text.lower().partition("x")
    if text.lower() == "nodes":
        return "nodes"
    if not _is_count(first) or (second or first) != first or text.lower().endswith("x"):
        raise InvalidValue(
            "this is no contact rule",
            where="contact",
            value=repr(text),
            cause="the points are as many in one direction of a facet as in the other",
            remedy="write nodes, or points per direction such as 5",
        )
    return int(first)


def _is_count(text: str) -> bool:
    return text.isascii() and text.isdecimal()
