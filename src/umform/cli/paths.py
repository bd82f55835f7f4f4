"""``umform paths``: the names of all numbers of a deck."""

from __future__ import annotations

from typing import Annotated

import typer

from umform.cli.check import Changes, DeckFile, Trust, deck_errors, read
from umform.cli.root import Debug, Verbose, app, console
from umform.errors import InvalidValue


@app.command()
def paths(
    deck: DeckFile,
    within: Annotated[str, typer.Argument(metavar="TEXT", help="Only paths that contain this text.")] = "",
    changes: Changes = None,
    trust: Trust = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """List the numbers of a deck that can be changed: path, value, unit and meaning.

    A path is what `--set` and `umform sweep --vary` take, and `problem.with_({path: value})` in Python. Numbers of a
    sheet metal of the library are listed, too.
    """
    from rich import box
    from rich.table import Table

    from umform.problem.keys import plain

    with deck_errors():
        found = [one for one in read(deck, changes or (), trust).paths() if within in one.path]
    if not found:
        raise InvalidValue(
            "no path contains this text", where="TEXT", value=within, remedy="umform paths DECK lists all"
        )
    table = Table("path", box=box.SIMPLE_HEAD)
    table.add_column("value", justify="right")
    table.add_column("unit")
    table.add_column("what it is")
    for one in found:
        table.add_row(one.path, f"{one.value:.10g}", one.unit, plain(one.sentence))
    console().print(table)
