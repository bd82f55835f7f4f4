"""Values of an option as text: ranges, lists and words."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

from umform.errors import InvalidValue

#: More values of one key are probably a mistake: the number of values instead of the step between them.
MOST_VALUES = 10_000
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_RANGE = re.compile(rf"\s*({_NUMBER}):({_NUMBER}):({_NUMBER})\s*")
_PART_OF_RANGE = re.compile(rf"\s*{_NUMBER}(?::{_NUMBER})+\s*")
_OPENING, _CLOSING = "[{", "]}"


@dataclass(frozen=True)
class Written:
    """A value as text; whether it is a number or a word depends on the key."""

    text: str

    def value(self, *, as_text: bool) -> Any:
        """The value: parsed as TOML if possible, else the text itself.

        Parameters
        ----------
        as_text : bool
            Whether the key takes text: 1.4301 is then the name of a steel, not a number.
        """
        try:
            found = tomllib.loads(f"value = {self.text}")["value"]
        except (ValueError, RecursionError):
            return self.text
        return found if isinstance(found, str | dict | list) or not as_text else self.text


def read_values(text: str, where: str) -> list[Written]:
    """The values of an option: first:last:step with both ends, or a list with commas; both may be mixed.

    Parameters
    ----------
    text : str
        As ``0.8:1.2:0.1``, ``DC04,1.4301`` or ``[24, 1],[48, 1]``.
    where : str
        The option, for messages.

    Raises
    ------
    InvalidValue
        There is no value, one is empty, or a range is infinite or has no step.
    """
    values: list[Written] = []
    for piece in _pieces(text):
        found = _RANGE.fullmatch(piece)
        if found:
            values += _range(*map(Decimal, found.groups()), where=where, text=piece)
        elif _PART_OF_RANGE.fullmatch(piece):
            raise InvalidValue(
                "a range has a first and a last number and a step",
                where=where,
                value=text,
                cause="a decimal comma, or the step is missing",
                remedy="write first:last:step, as 0.8:1.2:0.1",
            )
        else:
            values.append(Written(piece.strip()))
    if not all(value.text for value in values):
        raise InvalidValue(
            "a list has an empty value",
            where=where,
            value=repr(text),
            cause="a comma too many, or nothing behind the sign",
            remedy="write first:last:step, as 0.8:1.2:0.1, or values with commas, as 0.8,0.9",
        )
    return values


def _pieces(text: str) -> Iterator[str]:
    """Parts between commas outside of brackets and quotes."""
    depth, quote, piece = 0, "", ""
    for letter in text:
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'":
            quote = letter
        depth += 0 if quote else (letter in _OPENING) - (letter in _CLOSING)
        if letter == "," and depth == 0 and not quote:
            yield piece
            piece = ""
        else:
            piece += letter
    yield piece


def _range(first: Decimal, last: Decimal, step: Decimal, *, where: str, text: str) -> list[Written]:
    """Values from first to last in decimal arithmetic, so that 0.8 and two steps of 0.1 are 1.0."""
    if step == 0 or (last - first) / step < 0:
        raise InvalidValue(
            "a range does not reach its end",
            where=where,
            value=text,
            cause="a step of zero, or of the wrong sign",
            remedy="write first:last:step, as 0.8:1.2:0.1 or 5:1:-1",
        )
    count = int((last - first) / step) + 1
    if count > MOST_VALUES:
        raise InvalidValue(
            f"a range has at most {MOST_VALUES} values",
            where=where,
            value=f"{text}: {count} values",
            cause="the number of values in place of the step between them",
            remedy="write first:last:step, as 0.8:1.2:0.1",
        )
    return [Written(str(first + number * step)) for number in range(count)]
