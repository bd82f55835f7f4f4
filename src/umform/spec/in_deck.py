"""How a deck writes a field, where type and name of the field do not say it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Inline:
    """Annotation of the field, by default the first one, whose object has its keys in the table around it."""


@dataclass(frozen=True)
class OneOf:
    """Annotation of a field whose object is of one of several classes.

    Attributes
    ----------
    key : str
        Key of a deck whose word names the class; empty if each word is itself the key of a table.
    classes : callable
        The classes by their words; called when a deck is read, so that the classes may be declared later.
    """

    key: str
    classes: Callable[[], Mapping[str, type]]


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
