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
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin

from pydantic import (
    Discriminator,
    Field,
    Strict,
    Tag,
    ValidationInfo,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)
from pydantic import create_model as model_of
from pydantic_core import PydanticCustomError

from umform.errors import UmformError
from umform.problem.parts import Part
from umform.spec import Inline, OneOf, Parameter, parameters

P = TypeVar("P", bound=Part)

#: Types of Python that a deck writes in a way of its own.
_WRITTEN_AS: dict[Any, Any] = {}
#: Values that a text of TOML gives; others are objects of Python.
_WRITTEN = (dict, list, str, int, float)


def tagged(key: str, classes: Mapping[str, type], within: type | None = None) -> Any:
    """Type of a table in which the word of a key names one of several classes.

    Parameters
    ----------
    key : str
        The key, as ``curve``.
    classes : mapping of str to type
        Dataclasses by their words.
    within : type, optional
        A dataclass around the object: it takes the object as its first field, and its other fields are further keys of
        the same table.
    """
    members = [table(spec, within, (key, word)) for word, spec in classes.items()]
    union = Annotated[reduce(or_, members), Field(discriminator=key)] if len(members) > 1 else members[0]
    return Annotated[union, WrapValidator(partial(_object, within))]


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
    own, around = parameters(spec), _around(within)
    fields: dict[str, Any] = {one.name: (deck_type(one.hint), _field(one)) for one in [*own.values(), *around]}
    module, text = spec.__module__, (spec.__doc__ or "").partition("\n\n")[0]
    if tag:
        module += f".{tag[0]}"
        fields = {tag[0]: (Literal[tag[1]], Field(description=f"The word {tag[1]}."))} | fields
    keys = model_of(spec.__name__, __base__=Part, __doc__=" ".join(text.split()), __module__=module, **fields)
    return Annotated[keys, WrapValidator(partial(_made, spec, within, tuple(own)))]


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
    chosen = {name: one for name, one in parameters(spec).items() if name not in leave}

    def add(part: type[P]) -> type[P]:
        fields: dict[str, Any] = {
            names.get(name, name): (deck_type(one.hint), _field(one)) for name, one in chosen.items()
        }
        made = model_of(part.__name__, __base__=part, __doc__=part.__doc__, __module__=part.__module__, **fields)
        made.spec_keys = {name: names.get(name, name) for name in chosen}
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


def deck_type(hint: Any) -> Any:
    """Type of a key for the annotation of a field."""
    if hint in _WRITTEN_AS:
        return _WRITTEN_AS[hint]
    origin, inner = get_origin(hint), get_args(hint)
    if origin is Annotated:
        chosen = next((note for note in inner[1:] if isinstance(note, OneOf)), None)
        return tagged(chosen.key, chosen.classes()) if chosen else Annotated[(deck_type(inner[0]), *inner[1:])]
    if origin in (Union, types.UnionType):
        return _union([deck_type(arm) for arm in inner if arm is not type(None)], type(None) in inner)
    if origin in (tuple, Sequence):
        arms = tuple(arm if arm is ... else deck_type(arm) for arm in (inner if origin is tuple else (*inner, ...)))
        return Annotated[tuple.__class_getitem__(arms), Strict(False)]
    if isinstance(hint, type) and is_dataclass(hint):
        return table(hint)
    return Any if hint is object else hint


def _union(arms: Sequence[Any], optional: bool) -> Any:
    """One of several notations, so that only the errors of one are reported."""
    one = arms[0]
    if len(arms) > 1:
        noted = [Annotated[arm, Tag(_notation(arm))] for arm in arms]
        one = Annotated[reduce(or_, noted), Discriminator(_notation)]
    return one | None if optional else one


def _notation(value: Any) -> str:
    """How TOML writes a value, or the values of a type: a word, a number, an array or a table."""
    kind = value
    while get_origin(kind) is Annotated:
        kind = get_args(kind)[0]
    kind = get_origin(kind) or (kind if isinstance(kind, type) else type(kind))
    if kind in (str, Literal):
        return "word"
    return "number" if kind in (int, float, bool) else "array" if kind in (list, tuple) else "table"


def _field(one: Parameter) -> Any:
    """Default and text of a key."""
    default = ... if one.default is MISSING else one.default
    return Field(default, description=one.sentence)


def _made(spec: type, within: type | None, own: Sequence[str], value: Any, read: ValidatorFunctionWrapHandler) -> Any:
    """The object that a table describes."""
    if not isinstance(value, _WRITTEN):
        return value
    keys = read(value)
    given = {name: getattr(keys, name) for name in keys.model_fields_set}
    with refused():
        made = spec(**{name: given[name] for name in own if name in given})
        if within is None:
            return made
        beside = {one.name: given[one.name] for one in _around(within) if one.name in given}
        return within(**{_inner(within).name: made}, **beside)


def _inner(within: type) -> Parameter:
    """The field that holds the object."""
    every = list(parameters(within).values())
    return next((one for one in every if any(isinstance(note, Inline) for note in get_args(one.hint))), every[0])


def _around(within: type | None) -> list[Parameter]:
    """The other fields of a class around an object."""
    return [one for one in parameters(within).values() if one is not _inner(within)] if within else []


@contextmanager
def refused() -> Iterator[None]:
    """Block that makes an object: its error becomes one of pydantic, so that it gets its place in the deck."""
    try:
        yield
    except (UmformError, ArithmeticError, ValueError, MemoryError) as error:
        raise PydanticCustomError("object", "{error}", {"error": error}) from None


def _object(within: type | None, value: Any, read: ValidatorFunctionWrapHandler, info: ValidationInfo) -> Any:
    """An object of Python as it is, and what a table describes."""
    if isinstance(value, _WRITTEN):
        return read(value)
    return within(value) if within and not isinstance(value, within) else value
