"""Fields that hold an object of one of several classes, and how a deck names the class."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass


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
