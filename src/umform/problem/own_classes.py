"""Classes of the user that a deck names as ``module:Class``: code, which runs only if the user trusts the deck."""

from __future__ import annotations

import importlib
import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any

from umform.errors import InvalidValue

_OWN = re.compile(r"[\w.]+:\w+")


def own_class(key: str, word: str, context: Mapping[str, Any]) -> type:
    """The class that a word of a deck names.

    Parameters
    ----------
    key, word : str
        Key of the deck, and ``module:Class``: a module in the folder of the deck or on the path of Python.
    context : mapping
        Whether the deck is trusted (``trust``), and its folder (``folder``).

    Raises
    ------
    InvalidValue
        If the deck is not trusted, or there is no such dataclass.
    """
    if not context.get("trust"):
        raise InvalidValue(
            f"this {key} is code of the author of the deck, which is not trusted",
            where=key,
            value=word,
            cause="a class of Python in a deck: reading it runs its module",
            remedy="if you trust the author: umform run --trust, check --trust, or load(path, trust=True)",
        )
    module, _, name = word.partition(":")
    folder = Path(context.get("folder", ".")).resolve()
    if str(folder) not in sys.path:
        sys.path.append(str(folder))
    try:
        imported = importlib.import_module(module)
        found = getattr(imported, name)
    except Exception as error:  # whatever a module of the user raises
        raise InvalidValue(
            f"the class of this {key} cannot be imported",
            where=key,
            value=word,
            cause=f"{type(error).__name__}: {error}",
            remedy=f"{module}.py in the folder of the deck, or installed, with the class {name}",
        ) from error
    beside, file = folder.joinpath(*module.split(".")).with_suffix(".py"), getattr(imported, "__file__", None)
    if beside.is_file() and (file is None or not beside.samefile(file)):
        raise InvalidValue(
            f"the class of this {key} would be that of another module of this name",
            where=key,
            value=word,
            cause=f"{file or 'a module of Python'} was found before {beside}",
            remedy=f"another name for {beside.name}; of decks in several folders, each in a process of its own",
        )
    if not isinstance(found, type) or not is_dataclass(found):
        raise InvalidValue(
            f"the class of this {key} must be a dataclass",
            where=key,
            value=word,
            cause="a function, an object, or a class without fields",
            remedy="@dataclass(frozen=True); its fields are the keys of the table",
        )
    return found


def texts(data: Any) -> Iterator[str]:
    """All texts of parsed data."""
    if isinstance(data, str):
        yield data
    elif isinstance(data, Mapping | list | tuple):
        for entry in data.values() if isinstance(data, Mapping) else data:
            yield from texts(entry)


def modules_of(data: Any) -> dict[str, bytes]:
    """Contents of the modules whose classes parsed data name, by their names; of those that are loaded from a file."""
    names = sorted({text.partition(":")[0] for text in texts(data) if _OWN.fullmatch(text)})
    files = {name: getattr(sys.modules.get(name), "__file__", None) for name in names}
    return {name: Path(file).read_bytes() for name, file in files.items() if file and Path(file).is_file()}
