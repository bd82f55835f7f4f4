"""Values, tools and columns of the history for people: six digits, words instead of names of classes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from numbers import Integral, Real

import numpy as np

from umform.materials import Elastic
from umform.report.materials import material_text

#: Boundaries of the words in the name of a class: "VDie" is V, Die.
_WORDS = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
#: Ends of the columns of a tool, and what they are.
_ENDS = {f"f{axis}": f"force in {axis}" for axis in "xyz"} | {f"m{axis}": f"moment about {axis}" for axis in "xyz"}
#: More numbers than these are counted, not listed.
_LISTED = 6


def text_of(value: object) -> str:
    """A value for people: numbers with six digits, yes and no, objects by their class and fields."""
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    if isinstance(value, Integral | str | Enum):
        return str(value)
    if isinstance(value, Real):
        return f"{float(value) + 0.0:.6g}"
    if isinstance(value, Elastic):
        return material_text(value)
    if isinstance(value, Mapping):
        return _listed({str(name): one for name, one in value.items()})
    if isinstance(value, tuple | list | np.ndarray):
        items = np.asarray(value, dtype=object).ravel()
        return ", ".join(map(text_of, items)) if len(items) <= _LISTED else f"{len(items)} values"
    if is_dataclass(value) and not isinstance(value, type) and type(value).__str__ is object.__str__:
        name = " ".join(word if len(word) == 1 else word.lower() for word in _WORDS.split(type(value).__name__))
        given = _listed({one.name: getattr(value, one.name) for one in fields(value) if one.repr})
        return f"{name}: {given}" if given else name
    return str(value)


def _listed(values: Mapping[str, object]) -> str:
    """Names and values in a line; without those that are not given, and flags that are not set."""
    given = {name: one for name, one in values.items() if one is not None and one is not False}
    return "; ".join(f"{name.replace('_', ' ')} {text_of(one)}" for name, one in given.items())


def column_text(name: str) -> str:
    """A column of the history in words: ``punch_fz`` is "punch force in z"."""
    start, _, end = name.rpartition("_")
    return f"{start} {_ENDS[end]}".strip().replace("_", " ") if end in _ENDS else name.replace("_", " ")
