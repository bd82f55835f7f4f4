"""What a deck writes for an object: the inverse of its table."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, is_dataclass
from typing import Any

from umform.materials.laws import Law
from umform.spec import OneOf, Parameter, entries, note_of

#: A reference in a text, such as :class:`umform.Element`.
_REFERENCE = re.compile(r":\w+:`~?([^`]*)`")


def law_keys(law: object, rolling: object = None) -> dict[str, Any]:
    """Keys of the table ``[material]`` for a law, exact to the last bit; defaults are left out.

    Parameters
    ----------
    law : Material
        The law.
    rolling : optional
        Deck value of the rolling direction of an anisotropic law: "x", or { angle = 45 } as a mapping.
    """
    keys: dict[str, Any] = keys_of(Law, law)
    return keys | {"rolling": rolling} if getattr(law, "directional", False) else keys


def written_out(material: Any) -> Any:
    """The table of a sheet metal of the library with its law in place of its name; any other as it is."""
    from umform import sheet_metals

    if not isinstance(material, Mapping) or not isinstance(material.get("library"), str):
        return material
    if not material.keys() <= {"library", "rolling"}:  # which reading the deck refuses
        return material
    return law_keys(sheet_metals.get(material["library"]).law, material.get("rolling"))


def keys_of(hint: object, value: Any) -> Any:
    """What a deck writes for the value of a field; an object without words in a deck as it is.

    Parameters
    ----------
    hint : object
        Annotation of the field.
    value : object
        Its value.
    """
    choice = note_of(hint, OneOf)
    if choice and choice.key:
        word = _word(choice, value)
        return {choice.key: word, **_table(value)} if word else value
    return _table(value) if is_dataclass(value) else value


def given(spec: Any) -> Iterator[tuple[str, Parameter, Any]]:
    """Key, field and value of the fields of an object that have not their defaults."""
    for key, one, value in entries(spec):
        default = one.factory() if one.factory else one.default
        if value is not None and (default is MISSING or value != default):
            yield key, one, value


def summary(spec: type) -> str:
    """First paragraph of the text of a class."""
    return " ".join(plain(spec.__doc__ or "").partition("\n\n")[0].split())


def plain(text: str) -> str:
    """A text without marks of code and of references."""
    return _REFERENCE.sub(r"\1", text).replace("``", "")


def _table(value: Any) -> dict[str, Any]:
    return {key: keys_of(one.hint, part) for key, one, part in given(value)}


def _word(choice: OneOf, value: object) -> str:
    """The word of the class of an object: ``module:Class`` for one of your own; none if a deck cannot name it."""
    kind = type(value)
    word = next((word for word, known in choice.classes().items() if known is kind), "")
    own = kind.__module__ != "__main__" and getattr(sys.modules.get(kind.__module__), kind.__qualname__, None) is kind
    return word or (f"{kind.__module__}:{kind.__qualname__}" if own and is_dataclass(value) else "")
