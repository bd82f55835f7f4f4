"""Import less in the processes of commands, which start quicker then."""

from __future__ import annotations

import importlib.util
import inspect
import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import CodeType, ModuleType
from typing import Any

#: Executes a module.
Execute = Callable[[ModuleType], None]


def around(name: str, change: Callable[[Execute, ModuleType], None] | None = None) -> None:
    """Execute a module in another way, once it is imported; nothing is imported before.

    Parameters
    ----------
    name : str
        Name of the module.
    change : callable, optional
        Takes the function that executes the module, and the module; by default the first use of a name executes it.
    """
    sys.meta_path.insert(0, _Finder(name, change))


class _Finder:
    """Finds a module, once."""

    def __init__(self, name: str, change: Callable[[Execute, ModuleType], None] | None) -> None:
        self.name, self.change = name, change

    def find_spec(self, name: str, path: Sequence[str] | None = None, target: object = None) -> ModuleSpec | None:
        """The module with a loader that executes it in the other way; None for any other."""
        if name != self.name:
            return None
        sys.meta_path.remove(self)
        spec = PathFinder.find_spec(name, path)
        change = self.change
        if spec is None or spec.loader is None:
            return spec
        if change is None:
            spec.loader = importlib.util.LazyLoader(spec.loader)
        else:
            execute = spec.loader.exec_module
            spec.loader.exec_module = lambda module: change(execute, module)  # type: ignore[method-assign]
        return spec


def text_of(module: str, name: str) -> str:
    """Docstring of a function in the compiled code of a module, which is not executed; empty without one."""
    loader: Any = getattr(importlib.util.find_spec(module), "loader", None)
    parts = loader.get_code(module).co_consts
    codes = (part for part in parts if isinstance(part, CodeType) and part.co_name == name)
    text = next((code.co_consts[0] for code in codes if code.co_consts), None)
    return inspect.cleandoc(text) if isinstance(text, str) else ""
