"""What the annotations of tables say without pydantic, which takes long to import: `umform.problem.tagged` has it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, TypeVar

_T = TypeVar("_T")


class Note:
    """The note of pydantic that has the name of the class, with its arguments."""

    def __init__(self, *given: Any, **named: Any) -> None:
        self.given, self.named = given, named


class Field(Note):
    """Bounds, a pattern, or the key that tells members of a union apart."""


class Tag(Note):
    """Word that tells a member of a union from the others."""


class Discriminator(Note):
    """Function that gives the tag of a value; texts of the error."""


class Instance:
    """An object of a class."""


#: An object of Python as a value of a problem; no notation in TOML.
Own = Annotated[_T, Instance()]


@dataclass(frozen=True)
class Later:
    """A type in files that are imported when a deck has such a table.

    Attributes
    ----------
    hint : callable
        Returns the type.
    """

    hint: Callable[[], Any]


@dataclass(frozen=True)
class InTable:
    """A table whose keys are the fields of a class, and the others of a class around it, see `OneOf`."""

    spec: type
    within: type | None = None


@dataclass(frozen=True)
class Built:
    """A table from which an object is built at once; an object of the class stays as it is.

    Attributes
    ----------
    kind : type
        The class.
    build : callable
        Takes the table and the folder of the deck.
    """

    kind: type
    build: Callable[[Any, Path], Any]
