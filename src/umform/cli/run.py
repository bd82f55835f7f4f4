"""``umform run``: solve a deck and write the results."""

from __future__ import annotations

import shlex
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli import INTERRUPTED
from umform.cli.check import Changes, DeckFile, Force, Trust, deck_errors, read_to_run
from umform.cli.folders import out_option
from umform.cli.outcome_screen import print_table
from umform.cli.ranks import WithPetscOptions, let_the_first_end_all, let_the_first_talk, on_all_ranks, petsc_options
from umform.cli.root import Debug, Overwrite, Verbose, app, console, printing, say, say_of
from umform.cli.run_checks import show_checks
from umform.cli.step_table import step_tables
from umform.cli.timing import Timed, show_timing
from umform.cli.warnings import echo_warnings, print_warnings_once
from umform.errors import FileProblem, InvalidValue, UmformError

if TYPE_CHECKING:
    from umform.problem.running import ProblemOutcome

Every = Annotated[float, typer.Option(metavar="SECONDS", help="Seconds between checkpoints; 0: after each increment.")]


@app.command(cls=WithPetscOptions)
def run(
    ctx: typer.Context,
    deck: DeckFile,
    out: Annotated[str | None, out_option("the results", "that of the deck")] = None,
    solver: Annotated[str | None, typer.Option(help="Sparse solver, instead of that in the deck.")] = None,
    changes: Changes = None,
    checkpoint: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Checkpoint of the run; default: checkpoint.h5 in the folder of results."),
    ] = None,
    every: Every = 60.0,
    overwrite: Overwrite = False,
    budget: Annotated[
        bool, typer.Option("--budget", help="Error budget: repeat with coarser settings and show the errors.")
    ] = False,
    force: Force = False,
    trust: Trust = False,
    timing: Timed = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Solve a deck: history, fields, report, pictures, and a copy of the deck.

    If Newton's method fails (exit code 1) or Ctrl-C stops the run (130), the results so far are written.
    `umform resume` continues a stopped run. Results of another run are not overwritten: the default folder gets a
    number, an existing folder of `--out` is refused.

    On many ranks: `mpiexec -n 4 umform run deck.toml --solver petsc`. Options of PETSc take the prefix `-umform_`, such
    as `-umform_ksp_type cg -umform_pc_type gamg` (docs/parallel.md).
    """
    from umform.problem import running

    let_the_first_talk()
    print_warnings_once()
    with deck_errors(), let_the_first_end_all():
        loaded = read_to_run(deck, changes or (), trust)
        chosen = solver or loaded.contents.solution.solver
        if budget and chosen == "petsc":
            raise InvalidValue(
                "an error budget runs in one process",
                where="--budget",
                value="--solver petsc",
                cause="its coarser runs are independent, and go in parallel without ranks",
                remedy="another solver, such as --solver auto",
            )
        with on_all_ranks(chosen, petsc_options(ctx)):
            running.refuse_folder(chosen, out, overwrite=overwrite)
            problem = running.prepared(loaded, chosen, partial(running.refuse_implausible, loaded, force=force))
            outcome = running.run(
                loaded,
                problem,
                out,
                solver=solver,
                checkpoint=checkpoint,
                every=every,
                overwrite=overwrite,
                budget=budget,
            )
    finish(outcome, timing=timing)


def finish(outcome: ProblemOutcome, *, timing: bool = False) -> None:
    """Print the outcome of a run; exit with the code of an early end, or of a failure to print."""
    kept = f"the files of the run are in {outcome.files[0].parent}" if outcome.files else ""
    try:
        with printing(kept):
            show(outcome)
            if timing:
                show_timing(outcome.result.timing)
    except FileProblem as problem:
        say_of(problem)
        end(outcome)
        raise typer.Exit(1) from problem
    end(outcome)


def show(outcome: ProblemOutcome) -> None:
    """The table, events, and the files."""
    from umform.report.symmetry import modelled_part

    screen = console()
    result = outcome.result
    done = f"{len(result) - 1} increments in {result.seconds:.1f} s, solver {result.solver}"
    screen.print(f"{done}; the end of each step, in the units of the deck:", soft_wrap=True)
    for table in step_tables(result, screen.width):
        screen.print(table, crop=False, no_wrap=True, overflow="ignore")
    part = modelled_part(result.model)
    if part:
        screen.print(part, soft_wrap=True)
    show_checks(screen, outcome.stages)
    for rows in outcome.tables.values():
        print_table(rows)
    for note in outcome.all_notes:
        screen.print(note, soft_wrap=True, markup=False)
    for event in result.events:
        screen.print(event, soft_wrap=True, markup=False)
    if outcome.files:
        names = ", ".join(file.name for file in outcome.files)
        screen.print(f"Written to {outcome.files[0].parent}: {names}", soft_wrap=True, markup=False)
    echo_warnings(result.warnings)


def end(outcome: ProblemOutcome) -> None:
    """The message and the exit code of a run that ended early."""
    error = outcome.ended_by
    if error is None:
        return
    if outcome.checkpoint:
        error.add_note(f"  go on with: umform resume {shlex.quote(str(outcome.checkpoint))}")
    if isinstance(error, KeyboardInterrupt):
        say_of(error, "interrupted; the results so far are written")
        raise typer.Exit(INTERRUPTED)
    if isinstance(error, UmformError):
        say(error)
        typer.echo("  the results so far are written", err=True)
        raise typer.Exit(1)
    raise error
