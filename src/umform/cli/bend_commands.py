"""``umform bend`` and the commands below it."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Any

import typer

from umform.cli.options import is_typed
from umform.cli.root import app
from umform.errors import InvalidValue

bends = typer.Typer(rich_markup_mode="markdown")
app.add_typer(bends, name="bend")


def alone(command: Callable[..., None]) -> Callable[..., None]:
    """The callback of a group that runs unless a command below it is called, which has options of its own."""

    @wraps(command)
    def run(**values: Any) -> None:
        context: typer.Context = values["context"]
        below = context.invoked_subcommand
        if below is None:
            command(**values)
            return
        given = [name for name in values if is_typed(context, name)]
        if given:
            option = f"--{given[0].replace('_', '-')}"
            raise InvalidValue(
                f"options of umform bend {below} stand behind its name",
                where=option,
                remedy=f"umform bend {below} {option} ..., if it has this option",
            )

    run.__signature__ = inspect.signature(command)  # type: ignore[attr-defined]
    return run
