"""The text of a deck: read, parsed, changed; and where in it a key stands."""

from __future__ import annotations

import difflib
import json
import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path as File
from typing import Any

from umform.deck.lines import Path, lines_of, nearest_line
from umform.errors import FileProblem, InvalidValue, UmformError


class DeckSyntax(InvalidValue):
    """A text that is no TOML."""

    id = "deck.syntax"


class DeckKey(InvalidValue):
    """A key of a deck that is unknown, missing, or has a value that does not fit."""

    id = "deck.key"


class DeckError(UmformError):
    """All that is wrong with a deck.

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


#: What is said where nothing better is known.
ANY_CAUSE = "values that do not go together, or a value of another key"
ANY_REMEDY = "docs/decks.md says what each table may hold"


@dataclass(frozen=True)
class Source:
    """A deck as it was read.

    Attributes
    ----------
    name : str
        Of the file, for messages.
    folder : pathlib.Path
        Where other files are looked for.
    text : str
        The text.
    data : dict
        What tomllib makes of it, with the changes.
    lines : dict of path to int
        Line of each key.
    changes : dict of str to object
        Keys that have other values than in the text.
    """

    name: str
    folder: File
    text: str
    data: dict[str, Any]
    lines: Mapping[Path, int]
    changes: Mapping[str, Any]

    def place(self, path: Path) -> str:
        """File, line and key of a path."""
        line = nearest_line(self.lines, path)
        parts = [self.name, f"line {line}" if line else "", written(path)]
        return ", ".join(part for part in parts if part)


def read_file(path: str | File) -> str:
    """Text of a deck.

    Raises
    ------
    FileProblem
        If there is no such file, or it is no text.
    """
    path = File(path)
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise FileProblem(
            "the deck is no text",
            where=str(path),
            value=f"byte {error.start}",
            cause="another kind of file, or text that is not UTF-8",
            remedy="save it as UTF-8; umform new lists templates",
        ) from None
    except (OSError, ValueError) as error:
        cause = getattr(error, "strerror", None) or str(error)
        remedy = "look at the path; umform new lists templates"
        raise FileProblem("the deck cannot be read", where=str(path), cause=cause, remedy=remedy) from None


def parse(text: str, name: str, folder: File, changes: Mapping[str, Any] | None = None) -> Source:
    """Parse a deck.

    Parameters
    ----------
    text : str
        TOML.
    name : str
        Of the file, for messages.
    folder : pathlib.Path
        Where other files are looked for.
    changes : mapping of str to object, optional
        Other values of some keys: ``{"steps.0.increments": 3}``.

    Raises
    ------
    DeckError
        If the text is no TOML, or a changed key is nowhere.
    """
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise DeckError([_no_toml(text, name, error)]) from None
    source = Source(name, folder, text, data, lines_of(text), dict(changes or {}))
    wrong = [problem for key, value in source.changes.items() if (problem := _change(data, key, value))]
    if wrong:
        raise DeckError(wrong)
    return source


def _no_toml(text: str, name: str, error: Exception) -> DeckSyntax:
    said = str(error).splitlines()[0] if str(error) else type(error).__name__
    place = re.search(r"\(at line (\d+), column (\d+)\)", said)
    number = int(place[1]) if place else len(text.splitlines())
    lines = text.splitlines()
    wrong = lines[number - 1].strip() if 0 < number <= len(lines) else ""
    where = f"{name}, line {number}" + (f", column {place[2]}" if place else "")
    if isinstance(error, RecursionError):
        said = "arrays or tables are nested too deeply"
    return DeckSyntax(
        "the deck is no TOML",
        where=where,
        value=shortened(wrong) if wrong else None,
        cause=re.sub(r" \(at .*\)$", "", said),
        remedy='words stand in quotes, name = "die"; tables begin with [name], lists of tables with [[name]]',
    )


def _change(data: dict[str, Any], key: str, value: Any) -> DeckKey | None:
    """Give a key another value."""
    holder: Any = data
    *way, last = key.split(".")
    for number, part in enumerate(way):
        if isinstance(holder, list) and part.isdecimal() and int(part) < len(holder):
            holder = holder[int(part)]
        elif isinstance(holder, dict) and part in holder:
            holder = holder[part]
        elif isinstance(holder, dict) and number == len(way) - 1:
            holder = holder.setdefault(part, {})
        else:
            holder = None
    if isinstance(holder, dict):
        holder[last] = value
    elif isinstance(holder, list) and last.isdecimal() and int(last) < len(holder):
        holder[int(last)] = value
    else:
        return DeckKey(
            "a changed key is nowhere in the deck",
            where=key,
            value=shortened(value),
            cause="a number beyond the end of a list, or a value that holds no keys",
            remedy="write the way from the outside inwards, entries of lists by number from 0: steps.0.increments",
        )
    return None


def written(path: Path) -> str:
    """A path as in tools.die.corners[2]."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            key = part if re.fullmatch(r"[A-Za-z0-9_-]+", part) else json.dumps(shortened(part), ensure_ascii=False)
            text += f".{key}" if text else key
    return text


def shortened(value: object) -> str:
    """A value in one short line."""
    try:
        text = value if isinstance(value, str) else str(value).lower() if isinstance(value, bool) else repr(value)
    except ValueError:  # a whole number of more digits than Python writes
        text = "a very long number"
    text = " ".join(text.split())
    return text if len(text) <= 80 else text[:77] + "..."


def nearest(word: object, known: Iterable[str]) -> str:
    """The known word that looks most like one, or nothing."""
    names = {name.lower(): name for name in known}
    given = str(word).lower()[:100]
    found = difflib.get_close_matches(given, names, n=1, cutoff=0.55)
    found += [name for name in names if len(given) > 1 and name.startswith(given)]
    return names[found[0]] if found else ""


def slip(word: object, known: Iterable[str], otherwise: str = "another word than those known") -> str:
    """The likely cause of an unknown word."""
    near = nearest(word, known)
    return f"a slip of the pen: did you mean {near}?" if near else otherwise
