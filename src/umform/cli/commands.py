"""The commands and their files, of which only that of the called command is loaded."""

from __future__ import annotations

import importlib
import os
from collections.abc import Sequence

import typer

from umform.cli.importing import text_of
from umform.cli.root import app

#: File in this folder that defines a command, by a function of its name whose docstring is its help.
FILES = {
    "bead": "bead",
    "bench": "bench",
    "bend": "bend",
    "blank": "blank",
    "check": "check",
    "compensate": "compensate",
    "demo": "demo",
    "derive": "derive",
    "draw": "draw",
    "elements": "elements",
    "export": "export",
    "flat": "flat",
    "hem": "hem",
    "identify": "identify",
    "metal": "metals",
    "net": "net",
    "new": "new",
    "paths": "paths",
    "plot": "plot",
    "resume": "resume",
    "run": "run",
    "sigma": "sigma",
    "store": "store",
    "sweep": "sweep",
    "tools": "tools",
    "view": "view",
}


def application(words: Sequence[str] | None = None) -> typer.Typer:
    """The application with all commands, or for what was typed: its command, or else names and texts of all."""
    word = next((word for word in words or () if not word.startswith("-")), "")
    if words is None or "_UMFORM_COMPLETE" in os.environ:
        for file in FILES.values():
            importlib.import_module(f"umform.cli.{file}")
    elif word in FILES:
        importlib.import_module(f"umform.cli.{FILES[word]}")
    else:
        for name, file in FILES.items():
            app.command(name, help=text_of(f"umform.cli.{file}", name))(_not_loaded)
    return app


def _not_loaded() -> None:
    """Stands for a command in the list of all."""
