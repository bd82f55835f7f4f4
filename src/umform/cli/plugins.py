"""Commands of other packages: entry points of the group ``umform.commands``, such as ``umform verify`` of the book."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import typer

from umform.errors import InvalidValue

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP = "umform.commands"
#: Commands of packages of the same repository: what they are, and where they are.
_APART = {"verify": ("the verification book", "umform-book", "./book")}


@cache
def plugins() -> dict[str, EntryPoint]:
    """Commands of installed packages by name."""
    from importlib.metadata import entry_points  # the import is slow

    return {point.name: point for point in sorted(entry_points(group=GROUP), key=lambda point: point.name)}


def plugin(name: str) -> Any:
    """The command of an installed package, which is loaded; None if there is none of this name."""
    return command_of(name, plugins()[name].load()) if name in plugins() else None


def command_of(name: str, function: Any, **more: Any) -> Any:
    """The command of click for a function."""
    app = typer.Typer(pretty_exceptions_enable=False)
    app.command(name, **more)(function)
    command = typer.main.get_command(app)
    command.name = name
    return command


def check_installed(name: str) -> None:
    """Refuse a command whose package is known but not installed.

    Raises
    ------
    InvalidValue
        With the line that installs the package.
    """
    if name in _APART:
        what, package, folder = _APART[name]
        raise InvalidValue(
            f"{what} is not installed",
            where=f"umform {name}",
            cause=f"{package} is a package of its own, which umform runs without",
            remedy=f"pip install {folder} in a clone of the repository of umform, or make book",
        )
