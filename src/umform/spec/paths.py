"""Paths: the names of all numbers of a Spec, such as ``tools.die.radius`` or ``steps.2.to.stroke``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, is_dataclass
from typing import Any

from umform.errors import InvalidValue
from umform.spec.in_deck import entries
from umform.spec.parameter import Parameter, are_several


@dataclass(frozen=True)
class Scalar:
    """A number of a Spec.

    Attributes
    ----------
    path : str
        Its name: keys and numbers of entries, from 0, from the outside inwards.
    value : float or int
        Its value.
    unit : str
        Unit, if its type declares one.
    sentence : str
        What it is; for an entry of a list, what the list is.
    """

    path: str
    value: float | int
    unit: str = ""
    sentence: str = ""


def each(names: Any) -> Any:
    """Names as they are given; a text or a function alone is a list of one."""
    return [names] if isinstance(names, str) or callable(names) else names


def listed(values: Any) -> Any:
    """Several values as a tuple; one alone, of any type, is a tuple of one."""
    return tuple(values) if are_several(values) else (values,)


def scalars(spec: Any, path: str = "", unit: str = "", sentence: str = "") -> Iterator[Scalar]:
    """All numbers of a Spec, in the order of its fields; truth values are none."""
    if isinstance(spec, int | float) and not isinstance(spec, bool):
        yield Scalar(path, spec, unit, sentence)
    for name, value, own_unit, own_sentence in _entries(spec):
        yield from scalars(value, f"{path}.{name}" if path else str(name), own_unit or unit, own_sentence or sentence)


def changed(spec: Any, changes: Mapping[str, Any]) -> Any:
    """A Spec with other values at some paths; dataclasses are made again and check themselves.

    Raises
    ------
    InvalidValue
        A path leads nowhere, or a value is refused; ``where`` is the path.
    """
    for path, value in changes.items():
        spec = _changed(spec, path.split("."), value, path)
    return spec


def _changed(spec: Any, way: list[str], value: Any, path: str) -> Any:
    if not way:
        return value
    name, *inner = way
    known: list[Any] = [entry[0] for entry in _entries(spec)]
    key = next((one for one in known if str(one) == name), None)
    if key is None and not (isinstance(spec, Mapping) and not inner):
        raise InvalidValue(
            "a path leads nowhere",
            where=path,
            value=name,
            cause="another name, or a number beyond the end of a list",
            remedy=f"one of {', '.join(map(str, known))}" if known else f"leave out .{'.'.join(way)}",
        )
    if isinstance(spec, Mapping):
        return {**spec, name: _changed(spec.get(name), inner, value, path)}
    if isinstance(spec, list | tuple):
        return type(spec)(_changed(one, inner, value, path) if n == key else one for n, one in enumerate(spec))
    try:
        own = {
            one.name: (_changed(part, inner, value, path) if one_key == key else part)
            for one_key, one, part in entries(spec)
        }
        made: Any = type(spec)(**own)
        return made
    except InvalidValue as error:
        error.where = path
        raise


def _entries(spec: Any) -> Iterator[tuple[Any, Any, str, str]]:
    """Name, value, unit and sentence of each entry."""
    kind: Any = type(spec)
    if isinstance(spec, Mapping):
        yield from ((name, value, "", "") for name, value in spec.items())
    elif isinstance(spec, list | tuple):
        yield from ((number, value, "", "") for number, value in enumerate(spec))
    elif is_dataclass(spec) and not isinstance(spec, type):
        for name, one, value in entries(spec):
            if name == getattr(kind, "inside", None):
                yield from _entries(value)
            else:
                yield name, _as_declared(value, one), one.about.unit, one.sentence


def _as_declared(value: Any, one: Parameter) -> Any:
    """The value of a field; a whole number where any number may stand is a number."""
    whole = isinstance(value, int) and not isinstance(value, bool)
    return float(value) if whole and {kind.type for kind in one.kinds} == {float} else value
