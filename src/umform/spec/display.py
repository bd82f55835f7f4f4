"""What a notebook shows of an object whose fields are parameters: name, value, unit, meaning."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

from umform.notebook import Display, InNotebook
from umform.spec.parameter import parameters

#: Numbers up to which an array is shown whole.
_FEW = 6


class ParametersInNotebook(InNotebook):
    """Base of dataclasses with such fields."""

    __slots__ = ()

    def _display(self) -> Display:
        known = parameters(type(self))  # type: ignore[arg-type]
        rows = [["parameter", "value", "unit", "meaning"]]
        for one in fields(self):  # type: ignore[arg-type]
            about = known.get(one.name)
            unit, sentence = (about.about.unit, about.sentence) if about else ("", "")
            rows.append([one.name, value_text(getattr(self, one.name)), unit, sentence])
        empty = [n for n in range(2, 4) if not any(row[n] for row in rows[1:])]
        kept = [[cell for n, cell in enumerate(row) if n not in empty] for row in rows]
        return Display(type(self).__name__, {"": kept})


def value_text(value: Any) -> str:
    """A value in a few words: six digits of a number, the ends of a long array."""
    if value is None:
        return "–"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, Sequence) and not isinstance(value, str):
        if len(value) > _FEW:
            return f"{len(value)} values: {value_text(value[0])} ... {value_text(value[-1])}"
        return f"({', '.join(map(value_text, value))})"
    text = value if isinstance(value, str) else repr(value)
    return text if len(text) <= 160 else f"{text[:157]}..."
