"""Names of the varied keys: in full as in --set, or the shortest unambiguous part."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from umform.errors import InvalidValue
from umform.problem.contents import Contents
from umform.problem.element import ElementPart
from umform.problem.errors import slip
from umform.problem.settings import Output, Solution
from umform.spec import parameters

#: Name of the material of a deck, whose values may be sheet metals of the library.
_MATERIAL = ("material", "material.library")
#: Keys that a deck may omit and that nevertheless have a short name.
_OPTIONAL = tuple(
    f"{table}.{key}"
    for table, part in (("element", ElementPart), ("solution", Solution), ("output", Output))
    for key in parameters(part)
)


def find_key(name: str, data: Mapping[str, Any]) -> str:
    """The key of a deck for a name.

    Parameters
    ----------
    name : str
        In full, as ``mesh.thickness`` or ``steps.0.to.stroke``; or its last parts, as ``thickness``.
    data : mapping
        The deck.

    Returns
    -------
    str
        The key in full.

    Raises
    ------
    InvalidValue
        There is no such key, or more than one.
    """
    parts = name.split(".")
    if name in _MATERIAL or (len(parts) > 1 and parts[0] in parameters(Contents)):
        return name
    keys = dict.fromkeys([*_keys(data), *_OPTIONAL])
    found = [key for key in keys if key.split(".")[-len(parts) :] == parts]
    if len(found) == 1:
        return found[0]
    if found:
        raise InvalidValue(
            "a varied key is ambiguous",
            where=name,
            value=", ".join(found),
            cause="the deck has several keys of this name",
            remedy=f"write more of it, as {found[0]}",
        )
    raise InvalidValue(
        "a varied key is nowhere in the deck",
        where=name,
        cause=slip(name, {key.split(".")[-1] for key in keys}, "a key that the deck leaves out"),
        remedy="write it in full from the outside inwards, as mesh.thickness, material.library or steps.0.to.stroke",
    )


def is_text(key: str, data: Mapping[str, Any]) -> bool:
    """Whether the value of a key in a deck is text, or the key names a metal."""
    return key in _MATERIAL or isinstance(value_of(key, data), str)


def value_of(key: str, data: Any) -> Any:
    """Value of a key in a deck; None if it is missing."""
    for part in key.split("."):
        if isinstance(data, Mapping):
            data = data.get(part)
        elif isinstance(data, list) and part.isdecimal() and int(part) < len(data):
            data = data[int(part)]
        else:
            return None
    return data


def change(key: str, value: Any, data: Mapping[str, Any]) -> tuple[str, Any]:
    """The change of a deck that sets a key to a value; the name of a metal replaces any other law."""
    if key in _MATERIAL and isinstance(value, str):
        rolling = value_of("material.rolling", data)
        return "material", {"library": value} | ({} if rolling is None else {"rolling": rolling})
    return key, value


def _keys(data: Any, before: str = "") -> Iterator[str]:
    """All keys of a deck in full, entries of lists by index."""
    entries: Any = ()
    if isinstance(data, Mapping):
        entries = data.items()
    elif isinstance(data, list):
        entries = enumerate(data)
    for key, value in entries:
        if not isinstance(value, Mapping):
            yield f"{before}{key}"
        yield from _keys(value, f"{before}{key}.")
