"""``umform resume``: take up the run of a deck that was stopped."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from umform.cli.check import told
from umform.cli.root import Debug, Verbose, app
from umform.cli.run import Every, end, show


@app.command()
def resume(
    checkpoint: Annotated[Path, typer.Argument(metavar="CHECKPOINT", help="The file that `umform run` has left.")],
    out: Annotated[
        Path | None, typer.Option(metavar="FOLDER", help="Folder for what comes out; default: that of the run.")
    ] = None,
    every: Every = 60.0,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Take up a run that was stopped or killed: what comes out is what it would have given, to the last bit.

    The checkpoint holds the deck. A mesh file that the deck reads must still be there, and be the same.
    """
    from umform.deck import running

    with told():
        outcome = running.resume(checkpoint, out, every=every)
    show(outcome)
    end(outcome)
