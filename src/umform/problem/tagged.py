"""Tables of a deck from classes of Python: keys, defaults, bounds, units and texts are those of the fields.

The value of such a table is an object of the class itself. An object that is given in place of a table stays as it is.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import MISSING, is_dataclass
from functools import cache, partial, reduce
from operator import or_
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, TypeVar, Union, get_args, get_origin

from pydantic import Discriminator, Field, Strict, TypeAdapter, ValidationInfo, WrapValidator
from pydantic import ValidatorFunctionWrapHandler as Handler
from pydantic import create_model as model_of
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

from umform.errors import UmformError
from umform.problem.errors import DeckKey
from umform.problem.keys import keys_of, plain, summary
from umform.problem.notations import one_of_notations, one_of_tags
from umform.problem.own_classes import own_class
from umform.problem.parts import Part
from umform.spec import InDeck, OneOf, Parameter, deck_keys, note_of, parameters

P = TypeVar("P", bound=Part)

#: Types of Python that a deck writes in a way of its own.
_WRITTEN_AS: dict[Any, Any] = {}
#: Values that a text of TOML gives; others are objects of Python.
_WRITTEN = (dict, list, str, int, float)
#: Tables of the classes of the user that decks have named, by their words.
OWN: dict[str, Any] = {}


def tagged(key: str, classes: Mapping[str, type], within: type | None = None) -> Any:
    """Type of a table in which the word of a key names one of several classes.

    Parameters
    ----------
    key : str
        The key, as ``curve``.
    classes : mapping of str to type
        Dataclasses by their words.
    within : type, optional
        A dataclass around the object: the field that its ``inside`` names, or the first one, takes the object, and its
        other fields are further keys of the same table.
    """
    members = [table(spec, within, (key, word)) for word, spec in classes.items()]
    union = Annotated[reduce(or_, members), Field(discriminator=key)] if len(members) > 1 else members[0]
    return Annotated[union, WrapValidator(partial(_object, key, within))]


@cache
def table(spec: type, within: type | None = None, tag: tuple[str, str] | None = None) -> Any:
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
    fields: dict[str, Any] = dict(key for one in [*_own(spec), *_around(within)] for key in _keys(one))
    module = spec.__module__
    if tag:
        module += f".{tag[0]}"
        fields = {tag[0]: (Literal[tag[1]], ...)} | fields
    keys = model_of(spec.__name__, __base__=_Keys, __doc__=summary(spec), __module__=module, **fields)
    keys.of, keys.tag = [*_own(spec), *_around(within)], tag
    return Annotated[keys, WrapValidator(partial(_made, spec, within))]


def with_keys(spec: type, leave: Sequence[str] = (), **names: str) -> Callable[[type[P]], type[P]]:
    """Decorator of a table: its further keys are the fields of a dataclass, which `Part.of_spec` returns.

    Parameters
    ----------
    spec : type
        The dataclass.
    leave : sequence of str
        Fields that the table writes in a way of its own.
    **names : str
        Keys that have other names than their fields.
    """
    chosen = [one for one in _own(spec) if one.name not in leave]

    def add(part: type[P]) -> type[P]:
        fields: dict[str, Any] = {names.get(key, key): kind for one in chosen for key, kind in _keys(one)}
        made = model_of(part.__name__, __base__=part, __doc__=part.__doc__, __module__=part.__module__, **fields)
        made.spec_keys = {names.get(one.name, one.name): one for one in chosen}
        return made

    return add


def write_as(hint: Any, notation: Any) -> None:
    """Let a deck write values of a type in a way of its own.

    Parameters
    ----------
    hint : type or annotated type
        The annotation of fields.
    notation : type
        What pydantic reads in its place; the value is one of the type.
    """
    _WRITTEN_AS[hint] = notation


class _Keys(Part):
    """Keys of a table, and the fields that they are."""

    of: ClassVar[Sequence[Parameter]] = ()
    tag: ClassVar[tuple[str, str] | None] = None

    @classmethod
    def texts(cls) -> dict[str, str]:
        """The sentence of each key."""
        known = {cls.tag[0]: f"The word {cls.tag[1]}."} if cls.tag else {}
        for one in cls.of:
            known |= {key: summary(spec) if spec else plain(one.sentence) for key, spec in deck_keys(one).items()}
        return known


def deck_type(hint: Any) -> Any:
    """Type of a key for the annotation of a field."""
    if hint in _WRITTEN_AS:
        return _WRITTEN_AS[hint]
    origin, inner = get_origin(hint), get_args(hint)
    if note_of(hint, FieldInfo) or note_of(hint, Discriminator):  # a type of pydantic
        return hint
    if origin is Annotated:
        if choice := note_of(hint, OneOf):
            return tagged(choice.key, choice.classes())
        if other := note_of(hint, InDeck):
            return deck_type(other.kind)
        return Annotated[(deck_type(inner[0]), *inner[1:])]
    if origin in (Union, types.UnionType):
        return one_of_notations([deck_type(arm) for arm in inner if arm is not type(None)], type(None) in inner)
    if origin in (tuple, Sequence):
        arms = tuple(arm if arm is ... else deck_type(arm) for arm in (inner if origin is tuple else (*inner, ...)))
        return Annotated[tuple.__class_getitem__(arms), Strict(False)]
    if isinstance(hint, type) and is_dataclass(hint):
        return table(hint)
    return Any if hint is object else hint


def _own(spec: type) -> Sequence[Parameter]:
    """Fields of a class."""
    return list(parameters(spec).values())


def _inner(within: type) -> Parameter:
    """The field of a class around an object that holds it."""
    return parameters(within)[within.inside] if hasattr(within, "inside") else _own(within)[0]


def _around(within: type | None) -> Sequence[Parameter]:
    """Its other fields."""
    return [one for one in _own(within) if one is not _inner(within)] if within else []


def _keys(one: Parameter) -> Iterator[tuple[str, tuple[Any, Any]]]:
    """Keys of a field with their types and defaults."""
    other = note_of(one.hint, InDeck)
    default = keys_of(one.hint, one.factory()) if one.factory else one.default
    if default is MISSING or (other and other.needed):
        default = ...
    for key, spec in deck_keys(one).items():
        kind = table(spec) if spec else deck_type(one.hint)
        yield key, (kind | None if default is None else kind, default)


def _made(spec: type, within: type | None, value: Any, read: Handler, info: ValidationInfo) -> Any:
    """The object that a table describes."""
    if not isinstance(value, _WRITTEN):
        return value
    keys = read(value)
    given = {key: getattr(keys, key) for key in keys.model_fields_set}
    with refused():
        made = spec(**_arguments(_own(spec), given, info.context or {}))
        beside = _arguments(_around(within), given, {})
        return within(**{_inner(within).name: made}, **beside) if within else made


@contextmanager
def refused() -> Iterator[None]:
    """Block that makes an object: its error becomes one of pydantic, so that it gets its place in the deck."""
    try:
        yield
    except (UmformError, ArithmeticError, ValueError, MemoryError) as error:
        raise PydanticCustomError("object", "{error}", {"error": error}) from None


def _arguments(fields: Sequence[Parameter], given: Mapping[str, Any], context: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of a class from the keys of a table."""
    arguments = {}
    for one in fields:
        keys, other = list(deck_keys(one)), note_of(one.hint, InDeck)
        found = [given[key] for key in keys if given.get(key) is not None]
        if len(found) > 1:
            raise DeckKey(
                f"give {' or '.join(keys)}, not both",
                where=keys[-1],
                cause="two tables for one thing",
                remedy="take one of them out",
            )
        if found:
            in_folder = other is not None and other.path
            arguments[one.name] = Path(context.get("folder", "")).absolute() / found[0] if in_folder else found[0]
    return arguments


def _object(key: str, within: type | None, value: Any, read: Handler, info: ValidationInfo) -> Any:
    """An object of Python as it is, and what a table describes, also one of a class of the user."""
    if not isinstance(value, _WRITTEN):
        return within(value) if within and not isinstance(value, within) else value
    word = value.get(key) if isinstance(value, dict) else None
    if not isinstance(word, str) or ":" not in word:
        return read(value)
    with refused():
        own: Any = table(own_class(key, word, info.context or {}), within, (key, word))
    OWN[word] = own
    alone = one_of_tags({word: own, "": None}, lambda _: word)
    return TypeAdapter(alone).validate_python(value, context=info.context)
