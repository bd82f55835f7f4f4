"""Packages whose names are imported when they are first used: a run loads the files that it needs."""

from __future__ import annotations

import importlib
import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path


def at_first_use(
    package: str, home: Mapping[str, str], others: Callable[[], Mapping[str, object]] = dict
) -> Callable[[str], object]:
    """Make the ``__getattr__`` of a package (PEP 562).

    Parameters
    ----------
    package : str
        Name of the package.
    home : mapping of str to str
        Module in the package, for each name. No module may have the name of what another one defines: once imported,
        it would hide it.
    others : callable, optional
        Further objects by name, such as the classes in the files of the package that `home` does not list.

    Returns
    -------
    callable
        Imports a name and keeps it in the package.
    """

    def find(name: str) -> object:
        if name in home:
            value: object = getattr(importlib.import_module(f"{package}.{home[name]}"), name)
        elif name[:1].isupper() and name in (found := others()):
            value = found[name]
        else:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        setattr(sys.modules[package], name, value)
        return value

    return find


def classes_in(package: str) -> dict[str, str]:
    """Module of each class of a package, read off its files without importing them.

    Parameters
    ----------
    package : str
        Name of the package, which is imported.
    """
    folder = Path(next(iter(sys.modules[package].__path__)))
    texts = {file.stem: file.read_text(encoding="utf-8") for file in sorted(folder.glob("[a-z]*.py"))}
    return {name: stem for stem, text in texts.items() for name in re.findall(r"^class (\w+)", text, re.MULTILINE)}
