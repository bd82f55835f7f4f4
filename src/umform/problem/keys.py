"""What a deck writes for an object: the inverse of its table."""

from __future__ import annotations

import sys
import types
from collections.abc import Iterator
from dataclasses import MISSING, is_dataclass
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin

from umform.errors import InvalidValue
from umform.materials.laws import Law
from umform.spec import InDeck, OneOf, Parameter, parameters

_Note = TypeVar("_Note")


def law_keys(law: object, rolling: object = None) -> dict[str, Any]:
    """Keys of the table ``[material]`` for a law, exact to the last bit; defaults are left out.

    Parameters
    ----------
    law : Material
        The law.
    rolling : optional
        Deck value of the rolling direction of an anisotropic law: "x", or { angle = 45 } as a mapping.

    Raises
    ------
    InvalidValue
        If a deck cannot name the class of the law or of a part of it.
    """
    keys: dict[str, Any] = keys_of(Law, law, "material")
    return keys | {"rolling": rolling} if getattr(law, "directional", False) else keys


def keys_of(hint: object, value: Any, where: str = "") -> Any:
    """What a deck writes for the value of a field.

    Parameters
    ----------
    hint : object
        Annotation of the field.
    value : object
        Its value.
    where : str
        Name of the field, for messages.

    Raises
    ------
    InvalidValue
        If a deck cannot name its class.
    """
    choice = note_of(hint, OneOf)
    if choice and choice.key:
        return {choice.key: _word(choice, value, where), **dict(_table(value))}
    return dict(_table(value)) if is_dataclass(value) else value


def note_of(hint: Any, kind: type[_Note]) -> _Note | None:
    """Note of a kind in an annotation, also that of an optional field."""
    arms = get_args(hint) if get_origin(hint) in (Union, types.UnionType) else [hint]
    notes = (note for arm in arms if get_origin(arm) is Annotated for note in get_args(arm)[1:])
    return next((note for note in notes if isinstance(note, kind)), None)


def summary(spec: type) -> str:
    """First paragraph of the text of a class."""
    return " ".join(plain(spec.__doc__ or "").partition("\n\n")[0].split())


def plain(text: str) -> str:
    """A text without marks of code."""
    return text.replace("``", "")


def given(spec: Any) -> Iterator[tuple[Parameter, Any]]:
    """Fields of an object with the values from which it can be made again, without those that have their defaults."""
    kind: type = type(spec)
    written = spec.written() if hasattr(spec, "written") else {}
    for name, one in parameters(kind).items():
        value = written[name] if name in written else getattr(spec, name)
        default = one.factory() if one.factory else one.default
        if value is not None and (default is MISSING or value != default):
            yield one, value


def _table(value: Any) -> Iterator[tuple[str, Any]]:
    """Keys of an object."""
    for one, part in given(value):
        choice, other = note_of(one.hint, OneOf), note_of(one.hint, InDeck)
        key = _word(choice, part, one.name) if choice and not choice.key else other.key if other else ""
        yield key or one.name, keys_of(one.hint, part, one.name)


def _word(choice: OneOf, value: object, where: str) -> str:
    """The word of the class of an object; for one of your own its module and name."""
    kind = type(value)
    word = next((word for word, known in choice.classes().items() if known is kind), None)
    if word is not None:
        return word
    module = sys.modules.get(kind.__module__)
    importable = kind.__module__ != "__main__" and getattr(module, kind.__qualname__, None) is kind
    if choice.key and is_dataclass(value) and importable:
        return f"{kind.__module__}:{kind.__qualname__}"
    raise InvalidValue(
        f"a deck has no words for this {where.replace('_', ' ')}",
        where=where,
        value=value,
        cause="an object of a class that no module has, or that is no dataclass",
        remedy="a dataclass in a module of your own, or run it in Python",
    )
