"""The commands and their files, of which only that of the called command is loaded."""

from __future__ import annotations

import importlib
from collections.abc import Sequence

import typer

from umform.cli.root import app

#: File in this folder that defines a command.
FILES = {
    "bead": "bead",
    "bench": "bench",
    "bend": "bend",
    "check": "check",
    "demo": "demo",
    "derive": "derive",
    "draw": "draw",
    "elements": "elements",
    "hem": "hem",
    "identify": "identify",
    "metal": "metals",
    "new": "new",
    "paths": "paths",
    "plot": "plot",
    "resume": "resume",
    "run": "run",
    "sweep": "sweep",
    "view": "view",
}


def application(words: Sequence[str] = ()) -> typer.Typer:
    """The application with the command that the first word names, else with all commands."""
    files = [FILES[words[0]]] if words and words[0] in FILES else FILES.values()
    for file in files:
        importlib.import_module(f"umform.cli.{file}")
    return app
