"""The known classes of each kind: subclasses of an interface in the files of this package."""

from __future__ import annotations

import importlib
from dataclasses import is_dataclass
from functools import cache
from pathlib import Path


@cache
def known(interface: type) -> dict[str, type]:
    """Dataclasses of umform.materials that name an interface as their base, by name; those of a file in their order.

    Parameters
    ----------
    interface : type
        Such as Hardening.
    """
    files = sorted(file.stem for file in Path(__file__).parent.glob("[a-z]*.py"))
    modules = [importlib.import_module(f"{__package__}.{stem}") for stem in files]
    return {
        name: kind
        for module in modules
        for name, kind in vars(module).items()
        if isinstance(kind, type)
        and is_dataclass(kind)
        and interface in kind.__mro__[1:]
        and kind.__module__ == module.__name__
    }
