"""Context for building a part of a deck: it collects errors with the place of the part."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from umform.errors import UmformError, own_code
from umform.problem.errors import ANY_CAUSE, ANY_REMEDY, DeckKey
from umform.problem.lines import Path
from umform.problem.source import Source


@dataclass(frozen=True)
class Place:
    """A block that may fail: its error is collected, with its place in the deck, or raised, see `Source.made`."""

    path: Path
    source: Source
    errors: list[UmformError]

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> bool:
        if self.source.made:
            return False
        if isinstance(error, UmformError | ArithmeticError | ValueError | MemoryError):
            self.errors.append(placed(error, self.path, self.source))
            return True
        return False


def placed(error: Exception, path: Path, source: Source) -> UmformError:
    """An error with its place in the deck; if it names a key of the table, or its value, the place of that key.

    Parameters
    ----------
    error : Exception
        Of what could not be built.
    path : Path
        Table, or key, that describes it.
    source : Source
        The deck.
    """
    if not isinstance(error, UmformError):
        own = own_code(error)
        return DeckKey(
            "nothing can be built from this",
            where=source.place(path),
            cause=f"{type(error).__name__}: {error}, in {own}" if own else str(error) or type(error).__name__,
            remedy="correct it there" if own else "look at the size of its numbers",
        )
    error.cause, error.remedy = error.cause or ANY_CAUSE, error.remedy or ANY_REMEDY
    table = _value(source.data, path)
    keys = table if isinstance(table, dict) else {}
    last = error.where.rpartition(".")[2]
    plain = isinstance(error.value, str | int | float)  # arrays are not compared
    named = [last] if last in keys else [key for key, given in keys.items() if plain and given == error.value]
    if named and not isinstance(keys[named[0]], dict):
        error.where = source.place((*path, named[0]))
    else:
        inner = f" ({' '.join(error.where.splitlines())})" if error.where and error.where != path[-1] else ""
        error.where = source.place(path) + inner
    return error


def _value(data: Any, path: Path) -> Any:
    for part in path:
        try:
            data = data[part]
        except (KeyError, IndexError, TypeError):
            return None
    return data
