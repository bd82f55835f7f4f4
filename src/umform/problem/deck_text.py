"""Decks of ready processes: TOML text from tables."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from numbers import Real
from typing import Any

import numpy as np

from umform.errors import InvalidValue

_WIDTH = 118


def deck_text(data: Mapping[str, Any], remarks: Iterable[str] = ()) -> str:
    """Text of a deck.

    Parameters
    ----------
    data : mapping
        Its keys and tables.
    remarks : iterable of str
        Paragraphs of the comment at its head.

    Raises
    ------
    InvalidValue
        A value has no notation in TOML.
    """
    wrapped = (textwrap.wrap(text, _WIDTH, initial_indent="# ", subsequent_indent="# ") for text in remarks)
    lines = [line for paragraph in wrapped for line in paragraph]
    plain = {key: value for key, value in data.items() if not isinstance(value, Mapping | list)}
    lines += ["", *_lines(plain)]
    for header, keys in _tables(data):
        lines += ["", header, *_lines(keys)]
    return "\n".join(lines).lstrip() + "\n"


def _tables(data: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Header and keys of each table; tables of tables have one for each name."""
    for name, value in data.items():
        if isinstance(value, list):
            yield from ((f"[[{name}]]", one) for one in value)
        elif isinstance(value, Mapping) and value and all(isinstance(one, Mapping) for one in value.values()):
            yield from ((f"[{name}.{key}]", one) for key, one in value.items())
        elif isinstance(value, Mapping):
            yield f"[{name}]", value


def _lines(keys: Mapping[str, Any]) -> Iterator[str]:
    """Lines of the keys of a table; a key whose value is None is left out."""
    return (toml_line(key, value) for key, value in keys.items() if value is not None)


def toml_line(key: str, value: Any) -> str:
    """A key with its value; a long array goes on over several lines."""
    line = f"{key} = {toml(value)}"
    if len(line) > _WIDTH and isinstance(value, tuple | list):
        return "\n".join(textwrap.wrap(line, _WIDTH, subsequent_indent="    ", break_on_hyphens=False))
    return line


def toml(value: Any) -> str:
    """A value as TOML writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {toml(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, tuple | list):
        return "[" + ", ".join(toml(entry) for entry in value) + "]"
    if isinstance(value, Real):
        return repr(value)
    raise InvalidValue(
        "a deck has no words for this value",
        where="deck",
        value=f"{type(value).__name__}: {value}"[:80],
        cause="an object of Python: an element, a law or a surface of your own",
        remedy="give it in the deck by its name, or run the problem in Python",
    )


def plain(value: Any) -> Any:
    """Data as TOML has them: arrays are lists, numbers those of Python, and nothing is None."""
    if isinstance(value, Mapping):
        return {str(key): plain(one) for key, one in value.items() if one is not None}
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value
