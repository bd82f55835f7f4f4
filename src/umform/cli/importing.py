"""Import less in the processes of commands, which start quicker then."""

from __future__ import annotations

import dataclasses
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


def compile_methods_later() -> None:
    """Let dataclasses compile their methods, but for the constructors, at the first call: most are never called.

    It saves a tenth of a short bend. Python 3.13 compiles them otherwise, and stays as it is.
    """
    now: Any = getattr(dataclasses, "_create_fn", None)
    if now is None:
        return

    def create(name: str, arguments: Sequence[str], *more: Any, **named: Any) -> Any:
        if name == "__init__":
            return now(name, arguments, *more, **named)

        made: list[Any] = []

        def later(self: Any, *values: Any) -> Any:
            if not made:
                made.append(now(name, arguments, *more, **named))
            return made[0](self, *values)

        later.__name__ = name
        return later

    vars(dataclasses)["_create_fn"] = create
