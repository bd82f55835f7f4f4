"""Commands of other packages: entry points of the group ``umform.commands``, such as ``umform verify`` of the book."""

from __future__ import annotations

from importlib.metadata import entry_points

import typer

GROUP = "umform.commands"


def add_plugins(app: typer.Typer) -> None:
    """Add the commands that installed packages offer.

    Parameters
    ----------
    app : typer.Typer
        The application. The name of an entry point becomes that of the command.
    """
    for point in sorted(entry_points(group=GROUP), key=lambda point: point.name):
        app.command(point.name)(point.load())
