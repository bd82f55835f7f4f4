"""The known classes of each kind: dataclasses in the files of a package that name an interface as their base."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import is_dataclass
from functools import cache
from inspect import isabstract
from pathlib import Path


@cache
def known(package: str, interface: type) -> Mapping[str, type]:
    """Classes by name, in the order of the files and of their lines; abstract ones are left out.

    Parameters
    ----------
    package : str
        Such as umform.materials.
    interface : type
        Such as Hardening.
    """
    folder = importlib.import_module(package).__path__[0]
    files = sorted(file.stem for file in Path(folder).glob("[a-z]*.py"))
    modules = [importlib.import_module(f"{package}.{stem}") for stem in files]
    return {
        name: kind
        for module in modules
        for name, kind in vars(module).items()
        if isinstance(kind, type)
        and is_dataclass(kind)
        and interface in kind.__mro__[1:]
        and kind.__module__ == module.__name__
        and not isabstract(kind)
    }
