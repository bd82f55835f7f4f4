"""``umform resume``: continue the stopped run of a deck."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from umform.cli.check import Trust, deck_errors
from umform.cli.folders import out_option
from umform.cli.ranks import WithPetscOptions, let_the_first_end_all, let_the_first_talk, on_all_ranks, petsc_options
from umform.cli.root import Debug, Overwrite, Verbose, app
from umform.cli.run import Every, finish
from umform.cli.warnings import print_warnings_once
from umform.errors import FileProblem


@app.command(cls=WithPetscOptions)
def resume(
    ctx: typer.Context,
    checkpoint: Annotated[
        Path, typer.Argument(metavar="CHECKPOINT", help="Checkpoint of `umform run`, or the folder of the run.")
    ],
    out: Annotated[str | None, out_option("the results", "that of the run")] = None,
    every: Every = 60.0,
    overwrite: Overwrite = False,
    trust: Trust = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Continue a stopped or killed run from its checkpoint, with the same results to the last bit.

    The checkpoint contains the deck. Mesh files of the deck must exist unchanged. With `mpiexec`, a run on many ranks
    continues on any number of ranks.
    """
    from umform.problem import running
    from umform.problem.deck_in_checkpoint import Kept

    let_the_first_talk()
    print_warnings_once()
    with deck_errors(), let_the_first_end_all():
        checkpoint = _file_of(checkpoint)
        kept = Kept.read(checkpoint, trust)
        with on_all_ranks(kept.chosen_solver, petsc_options(ctx)):
            outcome = running.resume(checkpoint, kept, out, every=every, overwrite=overwrite)
    finish(outcome)


def _file_of(path: Path) -> Path:
    """The checkpoint, or that in the folder of a run."""
    from umform.problem.results import CHECKPOINT, FILES, STATE

    if not path.is_dir() or (path / CHECKPOINT).is_file():
        return path / CHECKPOINT if path.is_dir() else path
    there = [name for name in FILES if (path / name).is_file()]
    if STATE in there:
        raise FileProblem(
            "the run in this folder is finished",
            where=str(path),
            cause=f"it has {STATE}; a run removes its checkpoint at the end",
            remedy="nothing is left to do; `umform view` and `umform plot` show the results",
        )
    raise FileProblem(
        f"this folder has no {CHECKPOINT}",
        where=str(path),
        cause="the run is finished, or it ended before its first checkpoint"
        if there
        else "no run of a deck ended here",
        remedy="give the file of `umform run --checkpoint FILE`, or run the deck again (--every 0: more of them)",
    )
