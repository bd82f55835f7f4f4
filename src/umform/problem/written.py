"""Decks of ready processes: TOML text from tables."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterable, Mapping
from typing import Any

#: Header, as in [mesh] or [[steps]], and the keys below it; a key whose value is None is left out.
Entry = tuple[str, Mapping[str, Any]]

_WIDTH = 118


def deck_text(title: str, remarks: Iterable[str], entries: Iterable[Entry]) -> str:
    """Text of a deck.

    Parameters
    ----------
    title : str
        What it is about.
    remarks : iterable of str
        Paragraphs of the comment at its head.
    entries : iterable of Entry
        Its tables.
    """
    wrapped = (textwrap.wrap(text, _WIDTH, initial_indent="# ", subsequent_indent="# ") for text in remarks)
    lines = [*(line for paragraph in wrapped for line in paragraph), "", f"title = {toml(title)}"]
    for header, keys in entries:
        lines += ["", header, *(toml_line(key, value) for key, value in keys.items() if value is not None)]
    return "\n".join(lines) + "\n"


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
    return repr(value)
