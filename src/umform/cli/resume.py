"""``umform resume``: continue the stopped run of a deck."""

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
    checkpoint: Annotated[Path, typer.Argument(metavar="CHECKPOINT", help="Checkpoint of `umform run`.")],
    out: Annotated[
        str | None, typer.Option(metavar="FOLDER", help="Folder for the results; default: that of the run.")
    ] = None,
    every: Every = 60.0,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Continue a stopped or killed run from its checkpoint, with the same results to the last bit.

    The checkpoint contains the deck. Mesh files of the deck must exist unchanged. With `mpiexec`, a run on many ranks
    continues on any number of ranks.
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
