"""The text of a deck: read, parse, change; and the place of each key."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path as File
from typing import Any

from umform.errors import FileProblem
from umform.problem.deck_text import deck_text, plain
from umform.problem.errors import DeckError, DeckKey, shortened, slip, written
from umform.problem.keys import written_out
from umform.problem.lines import Path, lines_of, nearest_line
from umform.problem.syntax import no_toml

#: Tables of things by name.
_NAMED = ("tools", "contacts", "sheet_contacts", "beads", "controls", "measures")
#: Keys of a sheet metal of the library.
_OF_A_METAL = ("material.library", "material.rolling", "material.law")


@dataclass(frozen=True)
class Source:
    """The source of a deck.

    Attributes
    ----------
    name : str
        Of the file, for messages.
    folder : pathlib.Path
        Folder of other files.
    text : str
        The text.
    data : dict
        Parsed data, with the changes.
    lines : dict of path to int
        Line of each key.
    changes : dict of str to object
        Keys whose values differ from the text.
    remarks : tuple of str
        Paragraphs at the head of the text of a problem that was made, not read.
    made : bool
        Whether the data were made by a program: their errors are raised one by one, as they are.
    trust : bool
        Whether classes of Python that it names may be imported.
    """

    name: str
    folder: File
    text: str
    data: dict[str, Any]
    lines: Mapping[Path, int]
    changes: Mapping[str, Any]
    remarks: tuple[str, ...] = ()
    made: bool = False
    trust: bool = False

    @property
    def written(self) -> str:
        """The text as it was read, without the changes, or that of the data.

        Raises
        ------
        InvalidValue
            A value that was made by a program has no notation in TOML.
        """
        return deck_text(self.data, self.remarks) if self.made else self.text

    @property
    def context(self) -> dict[str, Any]:
        """What reading the data depends on."""
        return {"folder": self.folder, "trust": self.trust}

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


def parse(
    text: str,
    name: str,
    folder: File,
    changes: Mapping[str, Any] | None = None,
    trust: bool = False,
    default: Callable[[str], Any] = lambda _: None,
) -> Source:
    """Parse a deck.

    Parameters
    ----------
    text : str
        TOML.
    name : str
        Of the file, for messages.
    folder : pathlib.Path
        Folder of other files.
    changes : mapping of str to object, optional
        Other values of some keys: ``{"steps.0.increments": 3}``.
    trust : bool
        Whether classes of Python that it names may be imported.
    default : callable
        As for `change`.

    Raises
    ------
    DeckError
        If the text is not valid TOML, or a changed key does not exist.
    """
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise DeckError([no_toml(text, name, error)]) from None
    if "bends" in data and "mesh" not in data:
        raise DeckError(
            [
                DeckKey(
                    "this is a sequence of bends and no deck",
                    where=name,
                    cause="it has a table [[bends]], and no mesh",
                    remedy=f"umform bend --sequence {folder / name} --material DC04",
                )
            ]
        )
    change(data, changes or {}, default)
    return Source(name, folder, text, data, lines_of(text), dict(changes or {}), trust=trust)


def change(data: dict[str, Any], changes: Mapping[str, Any], default: Callable[[str], Any]) -> None:
    """Give keys of parsed data other values, in place; a key of the law of a library metal writes the law out.

    A table or list comes before the keys within it, in whatever order they are given.

    Parameters
    ----------
    data : dict
        The data.
    changes : mapping of str to object
        Values by path; their arrays and tables are copied.
    default : callable
        Gives the array of a path that the data leave out, so that one of its entries can be changed; None without one.

    Raises
    ------
    DeckError
        If a key does not exist.
    """
    wrong = []
    for key in sorted(changes, key=lambda one: (one.count("."), one not in _OF_A_METAL)):
        if key.startswith("material.") and key not in _OF_A_METAL:
            data["material"] = plain(written_out(data.get("material")))
        if problem := _change(data, key, plain(changes[key]), default):
            wrong.append(problem)
    if wrong:
        raise DeckError(wrong)


def within(key: str, others: Iterable[str]) -> bool:
    """Whether a key is one of others, or in the table or list of one."""
    return any(f"{key}.".startswith(f"{one}.") for one in others)


def _change(data: dict[str, Any], key: str, value: Any, default: Callable[[str], Any]) -> DeckKey | None:
    """Give a key another value."""
    holder: Any = data
    *way, last = key.split(".")
    if len(way) == 2 and way[0] in _NAMED and way[1] not in data.get(way[0], {}):
        known = list(data.get(way[0], {}))
        return DeckKey(
            f"there is nothing of this name among the {way[0]}",
            where=key,
            value=way[1],
            cause=slip(way[1], known, f"another name than those of the deck: {', '.join(known) or 'it has none'}"),
            remedy=f"a whole table adds one: {way[0]}.{way[1]}",
        )
    for number, part in enumerate(way):
        if isinstance(holder, list) and part.isdecimal() and int(part) < len(holder):
            holder = holder[int(part)]
        elif isinstance(holder, dict) and part in holder:
            holder = holder[part]
        elif isinstance(holder, dict) and number == len(way) - 1:
            array = default(".".join(way)) if last.isdecimal() else None
            holder = holder.setdefault(part, {} if array is None else array)
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
