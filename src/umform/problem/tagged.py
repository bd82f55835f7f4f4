"""Tables of a deck in pydantic: keys, defaults, bounds, units and texts are those of the fields of the classes.

They name what is wrong in a deck, and make the JSON schema; `umform.problem.reading` reads a deck without errors. The
value of a table is an object of the class itself. An object that is given in place of a table stays as it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import is_dataclass
from functools import cache, partial, reduce
from inspect import cleandoc
from operator import or_
from pathlib import Path
from typing import Annotated, Any, ClassVar, ForwardRef, Literal, get_args, get_origin

import pydantic
from pydantic import BaseModel, ConfigDict, InstanceOf, Strict, TypeAdapter, ValidationInfo, WrapValidator
from pydantic import ValidatorFunctionWrapHandler as Handler
from pydantic import create_model as model_of
from pydantic.json_schema import SkipJsonSchema
from pydantic_core import PydanticCustomError

from umform.problem.keys import keys_of, plain, summary
from umform.problem.notations import one_of_notations, one_of_tags
from umform.problem.notes import Built, Discriminator, Field, Instance, InTable, Later, Note
from umform.problem.own_classes import own_class
from umform.problem.parts import Part
from umform.problem.reading import REFUSED, UNIONS, WRITTEN, around, made, needed, own, written_as
from umform.spec import InDeck, OneOf, Parameter, deck_keys

#: Tables of the classes of the user that decks have named, by their words.
OWN: dict[str, Any] = {}
#: Tables that are being made, and whether one within refers to that: by the name of its class.
_MAKING: dict[tuple[Any, ...], bool] = {}


def tagged(key: str, classes: Mapping[str, type], within: type | None = None) -> Any:
    """Type of a table in which the word of a key names one of several classes.

    Parameters
    ----------
    key : str
        The key, as ``curve``.
    classes : mapping of str to type
        Dataclasses by their words.
    within : type, optional
        A dataclass around the object, see `OneOf`.
    """
    members = [table(spec, within, (key, word)) for word, spec in classes.items()]
    union = Annotated[reduce(or_, members), pydantic.Field(discriminator=key)] if len(members) > 1 else members[0]
    return Annotated[union, WrapValidator(partial(_object, key, within))]


@cache
def table(spec: Any, within: type | None = None, tag: tuple[str, str] | None = None) -> Any:
    """Type of a table whose keys are the fields of a dataclass.

    Parameters
    ----------
    spec : type
        The dataclass.
    within : type, optional
        As for `tagged`.
    tag : tuple of str, optional
        A further key, and the word that it must have.
    """
    one = spec, within, tag
    if one in _MAKING:
        _MAKING[one] = True
        return ForwardRef(spec.__name__)
    _MAKING[one] = False
    try:
        keys = _keys_of(spec, within, tag)
    finally:
        refers_to_itself = _MAKING.pop(one)
    kind: Any = Annotated[keys, WrapValidator(partial(_made, spec, within))]
    if refers_to_itself:
        keys.model_rebuild(_types_namespace={spec.__name__: kind})
    return kind


class _Keys(BaseModel):
    """Keys of a table, and the fields that they are."""

    model_config = ConfigDict(defer_build=True, extra="forbid", strict=True, allow_inf_nan=False, frozen=True)

    of: ClassVar[Sequence[Parameter]] = ()
    tag: ClassVar[tuple[str, str] | None] = None


def _keys_of(spec: Any, within: type | None, tag: tuple[str, str] | None) -> type[_Keys]:
    known = [*own(spec), *around(within)]
    fields: dict[str, Any] = dict(key for one in known for key in _keys(one))
    module = spec.__module__
    if tag:
        module += f".{tag[0]}"
        fields = {tag[0]: (Literal[tag[1]], ...)} | fields
    doc = cleandoc(spec.__doc__) if issubclass(spec, Part) else summary(spec)
    keys = model_of(spec.__name__, __base__=_Keys, __doc__=doc, __module__=module, **fields)
    keys.of, keys.tag = known, tag
    return keys


def texts(keys: type) -> dict[str, str]:
    """The sentence of each key of a table; none if it is no table."""
    if not issubclass(keys, _Keys):
        return {}
    known = {keys.tag[0]: f"The word {keys.tag[1]}."} if keys.tag else {}
    for one in keys.of:
        known |= {key: summary(spec) if spec else plain(one.sentence) for key, spec in deck_keys(one).items()}
    return known


def describe() -> None:
    """Give all keys of all tables their sentences, for a schema."""
    for keys in _Keys.__subclasses__():
        for name, sentence in texts(keys).items():
            keys.model_fields[name].description = sentence
    for keys in _Keys.__subclasses__():
        keys.model_rebuild(force=True)


def deck_type(hint: Any, told_apart: bool = True) -> Any:
    """Type of a key for the annotation of a field.

    Parameters
    ----------
    hint : type
        The annotation.
    told_apart : bool
        Whether the notation of a value selects the member of a union.
    """
    if (notation := written_as(hint)) is not None:
        return deck_type(notation, False)
    origin, inner = get_origin(hint), get_args(hint)
    if origin is Annotated:
        return _noted(inner[0], inner[1:], told_apart)
    arms = [arm if arm in (..., type(None)) else deck_type(arm, told_apart) for arm in inner]
    if origin in UNIONS and told_apart:
        return one_of_notations([arm for arm in arms if arm is not type(None)], type(None) in inner)
    if origin in UNIONS:
        return reduce(or_, arms)
    if origin in (tuple, Sequence):
        arms = arms if origin is tuple else [*arms, ...]
        return Annotated[tuple.__class_getitem__(tuple(arms)), Strict(False)]
    if origin in (list, dict):
        return origin[tuple(arms)]
    if isinstance(hint, type) and is_dataclass(hint):
        return table(hint)
    return Any if hint is object else hint


def _noted(hint: Any, notes: Sequence[Any], told_apart: bool) -> Any:
    """Type of an annotation with notes, inner ones first."""
    if not notes:
        return deck_type(hint, told_apart)
    *inner, last = notes
    found = _instead(last, Annotated[(hint, *inner)] if inner else hint)
    if found is not None:
        return found
    told_apart = told_apart and not isinstance(last, Field | Discriminator)
    note = getattr(pydantic, type(last).__name__)(*last.given, **last.named) if isinstance(last, Note) else last
    return Annotated[_noted(hint, inner, told_apart), note]


def _instead(note: Any, hint: Any) -> Any:
    """The type that a note puts in place of what it annotates; None if it only adds to it."""
    if isinstance(note, Later):
        return deck_type(note.hint(), False)
    if isinstance(note, OneOf):
        return tagged(note.key, note.classes(), note.within)
    if isinstance(note, InDeck):
        return deck_type(note.kind)
    if isinstance(note, InTable):
        return table(note.spec, note.within)
    if isinstance(note, Built):
        return Annotated[deck_type(hint, False), WrapValidator(partial(_built, note))]
    return SkipJsonSchema[InstanceOf[hint]] if isinstance(note, Instance) else None  # type: ignore[misc]


def _keys(one: Parameter) -> Iterator[tuple[str, tuple[Any, Any]]]:
    """Keys of a field with their types and defaults."""
    default = one.factory() if one.factory else one.default
    default = dict(vars(default)) if isinstance(default, Part) else keys_of(one.hint, default)
    if needed(one):
        default = ...
    in_part = issubclass(one.spec, Part) and one.name not in one.spec.spec_keys
    for key, spec in deck_keys(one).items():
        kind = table(spec) if spec else deck_type(one.hint, not in_part)
        yield key, (kind | None if default is None else kind, default)


def _made(spec: Any, within: type | None, value: Any, read: Handler, info: ValidationInfo) -> Any:
    """The object that a table describes."""
    if not isinstance(value, WRITTEN) and (isinstance(value, spec) or not issubclass(spec, Part)):
        return value
    keys = read(value)
    given = {key: getattr(keys, key) for key in keys.model_fields_set}
    with refused():
        return made(spec, within, given, info.context or {})


def _built(note: Built, value: Any, read: Handler, info: ValidationInfo) -> Any:
    """The object of a table; files are found from the folder of the deck."""
    if isinstance(value, note.kind):
        return value
    part = read(value)
    with refused():
        return note.build(part, Path((info.context or {}).get("folder", ".")))


@contextmanager
def refused() -> Iterator[None]:
    """Block that makes an object: its error becomes one of pydantic, so that it gets its place in the deck."""
    try:
        yield
    except REFUSED as error:
        raise PydanticCustomError("object", "{error}", {"error": error}) from None


def _object(key: str, within: type | None, value: Any, read: Handler, info: ValidationInfo) -> Any:
    """An object of Python as it is, and what a table describes, also one of a class of the user."""
    if not isinstance(value, WRITTEN):
        return within(value) if within and not isinstance(value, within) else value
    word = value.get(key) if isinstance(value, dict) else None
    if not isinstance(word, str) or ":" not in word:
        return read(value)
    with refused():
        own_table: Any = table(own_class(key, word, info.context or {}), within, (key, word))
    OWN[word] = own_table
    alone = one_of_tags({word: own_table, "": None}, lambda _: word)
    return TypeAdapter(alone).validate_python(value, context=info.context)
