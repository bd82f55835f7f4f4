"""Commands of other packages: entry points of the group ``umform.commands``, such as ``umform verify`` of the book."""

from __future__ import annotations

from functools import cache
from typing import Any

import typer

GROUP = "umform.commands"


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
