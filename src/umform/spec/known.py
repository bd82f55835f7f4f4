"""The known classes of each kind: dataclasses in the files of a package that name an interface as their base."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from functools import cache
from inspect import isabstract
from pathlib import Path
from types import ModuleType

from umform.first_use import classes_in


class Known(Mapping[str, type]):
    """Classes by name, in the order of the files and of their lines; abstract ones are left out.

    To look one up imports its file only.

    Parameters
    ----------
    package : str
        Such as umform.materials.
    interface : type
        Such as Hardening.
    """

    def __init__(self, package: str, interface: type) -> None:
        self.package, self.interface = package, interface
        self.home = classes_in(importlib.import_module(package).__name__)

    def __getitem__(self, name: str) -> type:
        found: type = self._in(importlib.import_module(f"{self.package}.{self.home[name]}"))[name]
        return found

    def __iter__(self) -> Iterator[str]:
        folder = importlib.import_module(self.package).__path__[0]
        for file in sorted(Path(folder).glob("[a-z]*.py")):
            yield from self._in(importlib.import_module(f"{self.package}.{file.stem}"))

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def _in(self, module: ModuleType) -> dict[str, type]:
        return {
            name: kind
            for name, kind in vars(module).items()
            if isinstance(kind, type)
            and is_dataclass(kind)
            and self.interface in kind.__mro__[1:]
            and kind.__module__ == module.__name__
            and not isabstract(kind)
        }


#: Known classes, made once for each kind.
known = cache(Known)
