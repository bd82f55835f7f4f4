"""Errors of pydantic in the form of umform: place, value, cause and remedy."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, Tag, TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from umform.errors import UmformError
from umform.problem.contents import Contents
from umform.problem.errors import ANY_CAUSE, ANY_REMEDY, DeckKey, nearest, shortened, slip
from umform.problem.lines import Path
from umform.problem.places import placed
from umform.problem.reading import UNIONS
from umform.problem.source import Source
from umform.problem.tagged import OWN, table, texts

_BEYOND = ("greater_than", "greater_than_equal", "less_than", "less_than_equal")
_TABLES = ("dict_type", "model_type", "model_attributes_type")
_CAUSES = {
    **dict.fromkeys(_BEYOND, "a sign, another unit, or a typing error"),
    **dict.fromkeys(_TABLES, "a value where keys should be"),
    **dict.fromkeys(("tuple_type", "list_type"), "one value, or a table, in place of an array"),
    "float_type": "a word, a truth value, or hundreds of digits",
    "int_type": "a fraction, a word or a truth value",
    "finite_number": "inf or nan",
    "string_type": "a value without quotes",
    "string_too_short": "nothing between the quotes",
    "string_pattern_mismatch": "a letter that does not belong there",
    "too_long": "an entry too many, or a decimal comma, which makes two numbers of one",
}
_TABLE = "write a table: a header, or keys between braces"
_REMEDIES = {
    **dict.fromkeys(_BEYOND, "write a number within the bound"),
    **dict.fromkeys(_TABLES, _TABLE),
    "float_type": "write a number, without quotes",
    "int_type": "write a whole number, without a point and without quotes",
    "bool_type": "write true or false, without quotes",
    "string_type": "write it in quotes",
    "string_too_short": "write the word, or leave the key out",
    "string_pattern_mismatch": "names begin with a letter and go on with letters, digits, _ and -; directions are "
    "letters such as xz",
    "tuple_type": "write an array: [0.0, 0.0, 1.0]",
    "list_type": "write an array: [0.0, 1.0]",
    "finite_number": "write a finite number",
    "too_long": "numbers have a decimal point, entries a comma between them: [25.0, 0.5]",
}


@cache
def _reader() -> TypeAdapter[Contents]:
    return TypeAdapter(table(Contents))


def checked(source: Source) -> tuple[Contents | None, list[UmformError]]:
    """The content of a deck, or all that is wrong with it."""
    try:
        return _reader().validate_python(source.data, context=source.context), []
    except ValidationError as error:
        return None, list(messages(error, source))


def messages(error: ValidationError, source: Source) -> Iterator[UmformError]:
    """One error of umform for each one of pydantic.

    Parameters
    ----------
    error : ValidationError
        Of `Contents`.
    source : Source
        The deck.
    """
    for found in error.errors(include_url=False):
        yield _message(found, source)


def _message(found: Mapping[str, Any], source: Source) -> UmformError:
    loc, kind, given = found["loc"], found["type"], found["input"]
    path = path_in(source.data, loc)
    context = found.get("ctx") or {}
    if kind == "object" and source.made:
        raise context["error"]
    if kind == "object":
        return placed(context["error"], path, source)
    if kind == "extra_forbidden":
        known = list(fields_at(loc[:-1]))
        return DeckKey(
            "this key is unknown here",
            where=source.place(path),
            value=shortened(given),
            cause=slip(loc[-1], known, "it belongs to another table, or to another version"),
            remedy=f"known keys: {', '.join(known)}",
        )
    if kind == "missing" and isinstance(loc[-1], int):
        return DeckKey(
            f"this array is too short: it has no entry {loc[-1]}",
            where=source.place(path),
            value=shortened(given),
            cause="a number left out",
            remedy="entries are counted from 0; " + ANY_REMEDY,
        )
    if kind == "missing":
        sentence = texts(part_at(loc[:-1])).get(str(loc[-1]), "")
        return _missing(source, path, str(loc[-1]), sentence and f": {sentence}")
    if kind in ("union_tag_not_found", "union_tag_invalid") or "key" in context:
        return _wrong_kind(source, path, given, context, _words_at(loc))
    words = _quoted(context.get("expected", ""))
    return DeckKey(
        worded(found["msg"]),
        where=source.place(path),
        value=None if isinstance(given, dict) else shortened(given),
        cause=slip(given, words) if words else _CAUSES.get(kind, ANY_CAUSE),
        remedy="one of " + ", ".join(words) if words else _REMEDIES.get(kind, ANY_REMEDY),
    )


def _missing(source: Source, path: Path, key: str, meaning: str, cause: str = "it was left out") -> DeckKey:
    return DeckKey(
        f"the key {key} is missing{meaning}".rstrip("."),
        where=source.place(path) if path else source.name,
        cause=cause,
        remedy=f"add {key} = ..." if path else f"add {key}",
    )


def _wrong_kind(source: Source, path: Path, given: Any, context: Mapping[str, Any], words: list[str]) -> DeckKey:
    """A table whose kind is missing or unknown."""
    key = str(context.get("key") or context.get("discriminator", "")).strip("'")
    known = _quoted(str(context.get("expected_tags", ""))) or words
    if not isinstance(given, dict):
        return DeckKey(
            "this should be a table",
            where=source.place(path),
            value=shortened(given),
            cause=_CAUSES["dict_type"],
            remedy=_TABLE,
        )
    if key not in given:
        near = next((word for word in given if nearest(word, [key])), "")
        cause = f"a typing error: {near} for {key}" if near else "it was left out"
        return _missing(source, path, key, f", one of {', '.join(known)}" if known else "", cause)
    return DeckKey(
        f"this {key} is unknown",
        where=source.place((*path, key)),
        value=shortened(given[key]),
        cause=slip(given[key], known),
        remedy="one of " + ", ".join(known),
    )


def worded(message: str) -> str:
    """A message of pydantic in the words of a deck."""
    return (
        message.replace("Input should", "it should")
        .replace("String should match pattern '^-?[xyz]$'", "it should be x, y, z, -x, -y or -z, or an array")
        .replace("String should", "it should")
        .replace(" after validation", "")
        .replace("valid tuple", "valid array")
        .replace("Tuple", "this array")
        .replace("List", "this array")
        .replace("valid dictionary", "table")
        .replace("table or object to extract fields from", "table")
        .replace("a valid list", "an array")
    )


def _quoted(text: str) -> list[str]:
    return re.findall(r"'([^']*)'", text)


def path_in(data: Any, loc: tuple[str | int, ...]) -> Path:
    """Path in the data for a location of pydantic, without its tags of unions."""
    path: Path = ()
    kind: Any = table(Contents)
    for part in loc:
        tag = get_origin(_bare(kind)) in UNIONS
        kind = _inside(kind, part)
        if tag:
            continue
        there = isinstance(data, dict) and part in data
        there = there or (isinstance(data, list) and isinstance(part, int) and 0 <= part < len(data))
        if there:
            path, data = (*path, part), data[part]
    return path


# Known keys ---------------------------------------------------------------------------------------------------


def fields_at(loc: tuple[str | int, ...]) -> dict[str, FieldInfo]:
    """Known keys at a location of pydantic."""
    kind = part_at(loc)
    return dict(kind.model_fields) if issubclass(kind, BaseModel) else {}


def part_at(loc: tuple[str | int, ...]) -> type:
    """Class of the table at a location of pydantic; `object` if there is none."""
    kind = _kind_at(loc)
    return kind if isinstance(kind, type) else object


def _words_at(loc: tuple[str | int, ...]) -> list[str]:
    """Words that distinguish the tables that a location of pydantic may hold."""
    kind = _kind_at(loc)
    members = get_args(kind) if get_origin(kind) in UNIONS else ()
    return [str(word) for member in members for word in _tags(member)]


def _kind_at(loc: tuple[str | int, ...]) -> Any:
    """Type at a location of pydantic."""
    kind: Any = table(Contents)
    for part in loc:
        kind = _inside(kind, part)
    return _bare(kind)


def _inside(kind: Any, part: str | int) -> Any:
    """Type at a key, at an index of an array, or of the member of a union with a tag."""
    kind = _bare(kind)
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        field = kind.model_fields.get(str(part))
        return field.annotation if field else None
    arguments = get_args(kind)
    if get_origin(kind) in UNIONS:
        return next((member for member in arguments if part in _tags(member)), OWN.get(str(part)))
    if get_origin(kind) is dict:
        return arguments[1]
    return arguments[0] if arguments else None


def _bare(kind: Any) -> Any:
    """A type without its annotations, and without the None of an optional one."""
    while True:
        if get_origin(kind) is Annotated:
            kind = get_args(kind)[0]
        elif get_origin(kind) in UNIONS and type(None) in get_args(kind):
            members = [member for member in get_args(kind) if member is not type(None)]
            kind = members[0] if len(members) == 1 else Union[tuple(members)]  # noqa: UP007
        else:
            return kind


def _tags(member: Any) -> set[object]:
    """Words that distinguish a member of a union from the others."""
    tags: set[object] = {note.tag for note in get_args(member)[1:] if isinstance(note, Tag)}
    bare = _bare(member)
    if not tags and isinstance(bare, type) and issubclass(bare, BaseModel):
        literals = [field.annotation for field in bare.model_fields.values() if get_origin(field.annotation) is Literal]
        tags |= {word for literal in literals for word in get_args(literal)}
    return tags
