"""How a deck writes a field, where type and name of the field do not say it."""

from __future__ import annotations

import types
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin

from umform.spec.parameter import Parameter, parameters

_Note = TypeVar("_Note")


@dataclass(frozen=True)
class OneOf:
    """Annotation of a field whose object is of one of several classes.

    Attributes
    ----------
    key : str
        Key of a deck whose word names the class; empty if each word is itself the key of a table.
    classes : callable
        The classes by their words; called when a deck is read, so that the classes may be declared later.
    within : type, optional
        A class around the object, whose other fields are further keys of the same table: the field that its ``inside``
        names, or the first one, takes the object.
    """

    key: str
    classes: Callable[[], Mapping[str, type]]
    within: type | None = None


@dataclass(frozen=True)
class InDeck:
    """Annotation of a field that a deck writes otherwise.

    Attributes
    ----------
    kind : object
        Type of its value in a deck.
    key : str
        Its key in a deck; empty for the name of the field.
    path : bool
        Whether it is a path from the folder of the deck.
    needed : bool
        Whether a deck must have it although Python has a default.
    """

    kind: Any
    key: str = ""
    path: bool = False
    needed: bool = False


def note_of(hint: Any, kind: type[_Note]) -> _Note | None:
    """Note of a kind in an annotation, also that of an optional field."""
    arms = get_args(hint) if get_origin(hint) in (Union, types.UnionType) else [hint]
    notes = (note for arm in arms if get_origin(arm) is Annotated for note in get_args(arm)[1:])
    return next((note for note in notes if isinstance(note, kind)), None)


def deck_keys(one: Parameter) -> Mapping[str, type | None]:
    """Keys of a field in a deck: one for each of its classes if each has its table, else one, without a class."""
    choice, other = note_of(one.hint, OneOf), note_of(one.hint, InDeck)
    if choice and not choice.key:
        return choice.classes()
    return {(other.key if other else "") or one.name: None}


def entries(spec: Any) -> Iterator[tuple[str, Parameter, Any]]:
    """Key of a deck, field, and value of all fields of an object from which it can be made again.

    An object that can be made in several ways has a method ``written``, which returns other values of some fields.
    """
    kind: type = type(spec)
    written = spec.written() if hasattr(spec, "written") else {}
    for name, one in parameters(kind).items():
        value = written[name] if name in written else getattr(spec, name)
        keys = deck_keys(one)
        yield next((key for key, known in keys.items() if known in (None, type(value))), name), one, value
