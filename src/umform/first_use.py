"""Packages whose names are imported when they are first used: a run loads the files that it needs."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Mapping


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
