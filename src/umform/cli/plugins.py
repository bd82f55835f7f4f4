"""Commands of other packages: entry points of the group ``umform.commands``, such as ``umform verify`` of the book."""

from __future__ import annotations

from functools import cache
from typing import Any

import typer

from umform.errors import InvalidValue

GROUP = "umform.commands"
#: Commands of packages of the same repository: what they are, and where they are.
_APART = {"verify": ("the verification book", "umform-book", "./book")}


@cache
def plugins() -> dict[str, Any]:
    """Commands of installed packages by name; loaded only for a command that umform does not have.

    Returns
    -------
    dict of str to command of click
        The name of an entry point becomes that of the command.
    """
    from importlib.metadata import entry_points  # the import is slow

    found = {}
    for point in sorted(entry_points(group=GROUP), key=lambda point: point.name):
        app = typer.Typer(pretty_exceptions_enable=False)
        app.command(point.name)(point.load())
        command = typer.main.get_command(app)
        command.name = point.name
        found[point.name] = command
    return found


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
