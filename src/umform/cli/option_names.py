"""Messages in terms of options: settings and names of Python become what is typed."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from umform.errors import InvalidPath, InvalidValue, UmformError

#: A number, a word, or a word in quotes; no value of an option of pairs, such as --want angle=90+-0.05.
_VALUE = r"(?:[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?|\w+|'[^']*')(?![\d.]|[+]-|[:@])"
#: A call of Python, which stays as it is.
_CALL = re.compile(r"(\w+\([^()]*\))")


def options_of(command: Any) -> dict[str, str]:
    """Options of a command and its subcommands, by their Python names."""
    each = [*getattr(command, "commands", {}).values(), command]
    return {str(parameter.name): parameter.opts[0] for one in each for parameter in one.params}


def as_typed(text: str, options: Mapping[str, str]) -> str:
    """A text in which settings of Python, such as bottoming=True, and names such as die_radius are options.

    Calls of Python, and pairs such as angle=90+-0.05, stay as they are.
    """
    return "".join(one if _CALL.fullmatch(one) else _options_in(one, options) for one in _CALL.split(text))


def _options_in(text: str, options: Mapping[str, str]) -> str:
    names = sorted(options, key=len, reverse=True)
    joined = [name for name in names if "_" in name]
    if names:
        text = re.sub(rf"(?<![\w.@-])({'|'.join(names)})=({_VALUE})", lambda match: _written(match, options), text)
    if joined:
        text = re.sub(rf"(?<![\w.@-])({'|'.join(joined)})\b(?![(=.\w])", lambda match: options[match[1]], text)
    return text


def _written(match: re.Match[str], options: Mapping[str, str]) -> str:
    name, value = match.groups()
    return options[name] if value == "True" else f"{options[name]} {value}"


def message(error: UmformError, options: Mapping[str, str]) -> str:
    """The message of an error that names options in place of parameters, which are given by name.

    Keys of files and paths of numbers stay as they are.
    """
    if error.id.startswith("deck"):
        return str(error)
    if isinstance(error, InvalidValue):  # a file may be called as a parameter is
        error.where = options.get(error.where, error.where)
    if isinstance(error, InvalidPath):
        return str(error)
    error.what, error.cause, error.remedy = (
        as_typed(text, options) for text in (error.what, error.cause, error.remedy)
    )
    return str(error)
