"""Common base of all parts of a deck: strict types, no unknown keys, and numbers, vectors and directions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Annotated, Any, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Discriminator, Field, InstanceOf, Strict, Tag
from pydantic.json_schema import SkipJsonSchema

from umform.spec import sentences


class Part(BaseModel):
    """A table of a deck. Numbers are finite, words are not converted to numbers, and unknown keys are errors."""

    # Python starts quickly: validators are built when a table is read, sentences are read when they are shown.
    model_config = ConfigDict(defer_build=True, extra="forbid", strict=True, allow_inf_nan=False, frozen=True)


def describe() -> None:
    """Give all keys of all parts their sentences, for a schema."""
    parts = list(_below(Part))
    for part in parts:
        for name, sentence in sentences(part).items():
            if name in part.model_fields:
                part.model_fields[name].description = sentence
    for part in parts:
        part.model_rebuild(force=True)


def _below(part: type[Part]) -> Iterator[type[Part]]:
    for kind in part.__subclasses__():
        yield kind
        yield from _below(kind)


_T = TypeVar("_T")
#: An object of Python as a value of a problem; no notation in TOML.
Own = SkipJsonSchema[InstanceOf[_T]]
Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]
Count = Annotated[int, Field(ge=1)]
#: Names become columns of tables and labels of figures.
Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_-]*$", max_length=60)]
Axis = Literal["x", "y", "z"]

# TOML has arrays where Python has tuples; their entries stay strict.
Pair = Annotated[tuple[float, float], Strict(False)]
Vector = Annotated[tuple[float, float, float], Strict(False)]


def word_or_array(value: Any) -> str | None:
    """Discriminator between two notations of a value, so that only the errors of one are reported."""
    return "word" if isinstance(value, str) else "array" if isinstance(value, list | tuple) else None


def number_or_array(value: Any) -> str | None:
    """Discriminator between two notations of a value."""
    return "array" if isinstance(value, list | tuple) else "number"


def number_or_table(value: Any) -> str | None:
    """Discriminator between two notations of a value."""
    return "table" if isinstance(value, dict) else "number"


def tagged_by(key: str, other: str) -> Callable[[Any], str | None]:
    """Discriminator between kinds of a table: the word of a key, or the name of another key that implies it."""

    def kind(value: Any) -> str | None:
        if isinstance(value, dict):
            word = other if other in value else value.get(key)
            return word if isinstance(word, str) else None
        return other if hasattr(value, other) else getattr(value, key, None)

    return kind


#: "x", "-z", ..., or three numbers.
Way = Annotated[
    Annotated[Literal["x", "y", "z", "-x", "-y", "-z"], Tag("word")] | Annotated[Vector, Tag("array")],
    Discriminator(
        word_or_array,
        custom_error_type="direction",
        custom_error_message="Input should be x, y, z, -x, -y, -z or three numbers",
    ),
]

__all__ = [
    "Axis",
    "Count",
    "Name",
    "NotNegative",
    "Own",
    "Pair",
    "Part",
    "Positive",
    "Vector",
    "Way",
    "describe",
    "number_or_array",
    "number_or_table",
    "tagged_by",
    "word_or_array",
]
