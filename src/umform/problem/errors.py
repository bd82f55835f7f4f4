"""Errors of decks, and the notation of keys and values in them."""

from __future__ import annotations

import difflib
import json
import re
from collections.abc import Iterable

from umform.errors import InvalidValue, UmformError
from umform.problem.lines import Path


class DeckSyntax(InvalidValue):
    """A text that is not valid TOML."""

    id = "deck.syntax"


class DeckKey(InvalidValue):
    """A key of a deck that is unknown, missing, or has an invalid value."""

    id = "deck.key"


class DeckError(UmformError):
    """All mistakes of a deck.

    Parameters
    ----------
    errors : sequence of UmformError
        Each with its place in the deck.
    """

    id = "deck"

    def __init__(self, errors: Iterable[UmformError]) -> None:
        self.errors = tuple(errors)
        first = self.errors[0]
        count = len(self.errors)
        what = first.what if count == 1 else f"the deck has {count} errors"
        super().__init__(what, where=first.where, value=first.value, cause=first.cause, remedy=first.remedy)

    def __str__(self) -> str:
        return "\n".join(str(error) for error in self.errors)

    def __reduce__(self) -> tuple[object, ...]:
        return (DeckError, (self.errors,))


#: Default cause and remedy.
ANY_CAUSE = "values that do not go together, or a value of another key"
ANY_REMEDY = "docs/decks.md says what each table may hold"


def written(path: Path) -> str:
    """A path in the form tools.die.corners[2]."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            key = part if re.fullmatch(r"[A-Za-z0-9_-]+", part) else json.dumps(shortened(part), ensure_ascii=False)
            text += f".{key}" if text else key
    return text


def shortened(value: object) -> str:
    """A value as one short line."""
    try:
        text = value if isinstance(value, str) else str(value).lower() if isinstance(value, bool) else repr(value)
    except ValueError:  # an integer with more digits than Python prints
        text = "a very long number"
    text = " ".join(text.split())
    return text if len(text) <= 80 else text[:77] + "..."


def nearest(word: object, known: Iterable[str]) -> str:
    """The most similar known word, or nothing."""
    names = {name.lower(): name for name in known}
    given = str(word).lower()[:100]
    found = difflib.get_close_matches(given, names, n=1, cutoff=0.55)
    found += [name for name in names if len(given) > 1 and name.startswith(given)]
    return names[found[0]] if found else ""


def slip(word: object, known: Iterable[str], otherwise: str = "another word than those known") -> str:
    """The likely cause of an unknown word."""
    near = nearest(word, known)
    return f"a typing error: did you mean {near}?" if near else otherwise
