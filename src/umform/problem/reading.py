"""Read a table by the annotations of its class: quick, but with no word on what is wrong.

What does not fit, or needs a closer look, raises `Unfit`; pydantic then reads the deck once more, and says what and
where: `umform.problem.messages`. A value that fits becomes what it becomes there.
"""

from __future__ import annotations

import math
import operator
import re
import types
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING, fields, is_dataclass
from datetime import date, time
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt, MaxLen, MinLen

from umform.errors import UmformError
from umform.problem.errors import DeckKey
from umform.problem.notes import Built, Discriminator, Field, Instance, InTable, Later, Tag
from umform.spec import InDeck, OneOf, Parameter, deck_keys, hint_of, note_of, parameters

#: Folder of a deck (``folder``), and whether it is trusted (``trust``).
Context = Mapping[str, Any]
#: Values that a text of TOML gives; others are objects of Python.
WRITTEN = (dict, list, str, int, float, date, time)
#: Errors of what cannot be built.
REFUSED = (UmformError, ArithmeticError, ValueError, MemoryError)
#: Types of Python that a deck writes in a way of its own.
_WRITTEN_AS: dict[Any, Any] = {}
#: What `get_origin` returns for a union.
UNIONS = (Union, types.UnionType)
#: Bounds of the vocabulary of annotated_types, and their names.
_BOUNDS = {Gt: "gt", Ge: "ge", Lt: "lt", Le: "le", MinLen: "min_length", MaxLen: "max_length"}
#: Whether a value is within a bound.
_FITS: dict[str, Callable[[Any, Any], bool]] = {
    "gt": operator.gt,
    "ge": operator.ge,
    "lt": operator.lt,
    "le": operator.le,
    "min_length": lambda value, least: len(value) >= least,
    "max_length": lambda value, most: len(value) <= most,
    "pattern": lambda value, pattern: re.search(pattern, value) is not None and "\n" not in value,
}


class Unfit(Exception):
    """A value that does not fit its annotation, or whose reading is left to pydantic."""


def write_as(hint: Any, notation: Any) -> None:
    """Let a deck write values of a type in a way of its own.

    Parameters
    ----------
    hint : type or annotated type
        The annotation of fields.
    notation : type
        What is read in its place; the value is one of the type.
    """
    _WRITTEN_AS[hint] = notation


def written_as(hint: Any) -> Any:
    """What a deck writes for a type; None if that is the type."""
    return _WRITTEN_AS.get(hint)


def read(hint: Any, value: Any, context: Context) -> Any:
    """The value of an annotation that a deck writes.

    Raises
    ------
    Unfit
    """
    if (notation := written_as(hint)) is not None:
        return read(notation, value, context)
    origin = get_origin(hint)
    if origin is Annotated:
        return _noted(hint, value, context)
    if origin in UNIONS:
        return _one(get_args(hint), value, context)
    if origin is Literal:
        fit = [word for word in get_args(hint) if isinstance(value, str | int) and word == value]
        return _only(fit)
    if origin is list and isinstance(value, list):
        return [read(get_args(hint)[0], one, context) for one in value]
    if origin in (tuple, Sequence) and isinstance(value, list | tuple):
        return _array(get_args(hint) if origin is tuple else (*get_args(hint), ...), value, context)
    if origin is dict and isinstance(value, dict):
        of_key, of_value = get_args(hint)
        return {read(of_key, key, context): read(of_value, one, context) for key, one in value.items()}
    if hint is float:
        return _number(value, finite=True)
    if hint in (str, int, bool) and type(value) is hint:
        return value
    if hint is object or hint is Any:
        return value
    if isinstance(hint, type) and is_dataclass(hint):
        return _object(hint, None, value, context)
    raise Unfit


def _noted(hint: Any, value: Any, context: Context) -> Any:
    """The value of a type with notes."""
    inner, *notes = get_args(hint)
    finite = True
    for number, note in enumerate(notes):
        if isinstance(note, Built):
            return _built(note, Annotated[(inner, *notes[:number])], value, context)
    for note in notes:
        if isinstance(note, Later):
            return read(note.hint(), value, context)
        if isinstance(note, InDeck):
            return read(note.kind, value, context)
        if isinstance(note, OneOf):
            return _named(note, value, context)
        if isinstance(note, InTable):
            return _object(note.spec, note.within, value, context)
        if isinstance(note, Instance):
            return _only([value] if isinstance(value, inner) else [])
        if isinstance(note, Discriminator):
            value = _tagged(inner, note.given[0](value), value, context)
            break
        if isinstance(note, Field):
            if "discriminator" in note.named:
                return _of_kind(get_args(inner), note.named["discriminator"], value, context)
            finite = not note.named.get("allow_inf_nan", not finite)
    else:
        value = _number(value, finite=finite) if inner is float else read(inner, value, context)
    if not all(_FITS[name](value, limit) for name, limit in _limits(notes) if name in _FITS):
        raise Unfit
    return value


def _limits(notes: Iterable[Any]) -> Iterator[tuple[str, Any]]:
    for note in notes:
        if isinstance(note, Field):
            yield from note.named.items()
        elif type(note) in _BOUNDS:
            yield _BOUNDS[type(note)], getattr(note, _BOUNDS[type(note)])


def _number(value: Any, *, finite: bool) -> float:
    try:
        if type(value) not in (int, float) or (finite and not math.isfinite(value)):
            raise Unfit
        return float(value)
    except OverflowError:  # a whole number of hundreds of digits
        raise Unfit from None


def _only(fit: Sequence[Any]) -> Any:
    if len(fit) != 1:
        raise Unfit
    return fit[0]


def _array(arms: Sequence[Any], value: Sequence[Any], context: Context) -> tuple[Any, ...]:
    if arms[-1] is ...:
        arms = [arms[0]] * len(value)
    if len(arms) != len(value):
        raise Unfit
    return tuple(read(arm, one, context) for arm, one in zip(arms, value, strict=True))


def _one(arms: Sequence[Any], value: Any, context: Context) -> Any:
    """The value of the only member of a union that it fits."""
    if value is None and type(None) in arms:
        return None
    fit = []
    for arm in arms:
        try:
            fit.append(None if arm is type(None) else read(arm, value, context))
        except Unfit:
            continue
    return _only([one for one in fit if one is not None])


def _tagged(union: Any, tag: str | None, value: Any, context: Context) -> Any:
    arms = [arm for arm in get_args(union) if any(isinstance(n, Tag) and n.given[0] == tag for n in get_args(arm)[1:])]
    return read(_only(arms), value, context)


def _of_kind(arms: Sequence[type], key: str, value: Any, context: Context) -> Any:
    """The table whose class has the word of a key."""
    word = value.get(key) if isinstance(value, dict) else getattr(value, key, None)
    return read(_only([arm for arm in arms if word in _words(arm, key)]), value, context)


@cache
def _words(table: type, key: str) -> tuple[Any, ...]:
    return get_args(next(hint_of(table, one) for one in fields(table) if one.name == key))


def _built(note: Built, inner: Any, value: Any, context: Context) -> Any:
    if isinstance(value, note.kind):
        return value
    part = read(inner, value, context)
    try:
        return note.build(part, Path(context.get("folder", ".")))
    except REFUSED:
        raise Unfit from None


def _named(choice: OneOf, value: Any, context: Context) -> Any:
    """An object of the class that the word of a key names."""
    within = choice.within
    if not isinstance(value, WRITTEN):
        return within(value) if within and not isinstance(value, within) else value
    word = value.get(choice.key) if isinstance(value, dict) else None
    kind = choice.classes().get(word) if isinstance(word, str) else None
    if kind is None or not isinstance(value, dict):
        raise Unfit
    return _object(kind, within, {key: one for key, one in value.items() if key != choice.key}, context)


def _object(spec: Any, within: type | None, value: Any, context: Context) -> Any:
    """The object that a table describes."""
    if not isinstance(value, WRITTEN) or isinstance(value, spec):
        return value
    if not isinstance(value, dict):
        raise Unfit
    known = {key: (one, kind) for one in [*own(spec), *around(within)] for key, kind in deck_keys(one).items()}
    given = {}
    for key, one in value.items():
        if key not in known:
            raise Unfit
        parameter, kind = known[key]
        given[key] = _object(kind, None, one, context) if kind else read(parameter.hint, one, context)
    if any(needed(one) and key not in given for key, (one, _) in known.items()):
        raise Unfit
    try:
        return made(spec, within, given, context)
    except REFUSED:
        raise Unfit from None


def needed(one: Parameter) -> bool:
    """Whether a deck must have a field."""
    other = note_of(one.hint, InDeck)
    return bool(other and other.needed) or (one.default is MISSING and one.factory is None)


def made(spec: Any, within: type | None, given: Mapping[str, Any], context: Context) -> Any:
    """The object of a class, in that around it, from the values of the keys of a table."""
    one = getattr(spec, "of_values", spec)(**arguments(own(spec), given, context))
    return within(**{inner(within).name: one}, **arguments(around(within), given, {})) if within else one


def arguments(known: Iterable[Parameter], given: Mapping[str, Any], context: Context) -> dict[str, Any]:
    """Arguments of a class from the keys of a table."""
    found = {}
    for one in known:
        keys, other = list(deck_keys(one)), note_of(one.hint, InDeck)
        there = [given[key] for key in keys if given.get(key) is not None]
        if len(there) > 1:
            raise DeckKey(
                f"give {' or '.join(keys)}, not both",
                where=keys[-1],
                cause="two tables for one thing",
                remedy="take one of them out",
            )
        if there:
            in_folder = other is not None and other.path
            found[one.name] = Path(context.get("folder", "")).absolute() / there[0] if in_folder else there[0]
    return found


def own(spec: type) -> Sequence[Parameter]:
    """Fields of a class."""
    return list(parameters(spec).values())


def inner(within: type) -> Parameter:
    """The field of a class around an object that holds it."""
    return parameters(within)[within.inside] if hasattr(within, "inside") else own(within)[0]


def around(within: type | None) -> Sequence[Parameter]:
    """Its other fields."""
    return [one for one in own(within) if one is not inner(within)] if within else []
