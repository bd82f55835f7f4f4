"""``umform resume``: take up the run of a deck that was stopped."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from umform.cli.check import deck_errors
from umform.cli.ranks import WithPetscOptions, let_the_first_talk, on_all_ranks, petsc_options
from umform.cli.root import Debug, Overwrite, Verbose, app
from umform.cli.run import Every, finish
from umform.cli.warnings import print_warnings_once


@app.command(cls=WithPetscOptions)
def resume(
    ctx: typer.Context,
    checkpoint: Annotated[Path, typer.Argument(metavar="CHECKPOINT", help="The file that `umform run` has left.")],
    out: Annotated[
        str | None, typer.Option(metavar="FOLDER", help="Folder for what comes out; default: that of the run.")
    ] = None,
    every: Every = 60.0,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Take up a run that was stopped or killed: what comes out is what it would have given, to the last bit.

    The checkpoint holds the deck. A mesh file that the deck reads must still be there, and be the same. A run on many
    ranks goes on with `mpiexec`, on as many ranks as you like.
    """
    from umform.deck import running
    from umform.deck.kept import Kept

    let_the_first_talk()
    print_warnings_once()
    with deck_errors():
        kept = Kept.read(checkpoint)
        with on_all_ranks(kept.chosen_solver, petsc_options(ctx)):
            outcome = running.resume(checkpoint, kept, out, every=every, overwrite=overwrite)
    finish(outcome)
