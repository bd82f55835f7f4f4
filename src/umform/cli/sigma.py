"""``umform sigma``: how much the results of a deck scatter, and why."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from umform.cli.check import Changes, DeckFile, Trust, deck_errors, read
from umform.cli.derive import say_written
from umform.cli.outcome_screen import show_annex
from umform.cli.root import Debug, Overwrite, Verbose, app
from umform.cli.scattering import ScatterOptions, scattering
from umform.cli.warnings import print_warnings_once


@app.command()
@scattering
def sigma(
    deck: DeckFile,
    changes: Changes = None,
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="FOLDER", help="Folder for the files; default: results/DECK-sigma."),
    ] = None,
    overwrite: Overwrite = False,
    trust: Trust = False,
    verbose: Verbose = 0,
    debug: Debug = False,
    *,
    scatter_options: ScatterOptions,
) -> None:
    """Standard deviation of the results of a deck, the share of each parameter, Cp and Cpk.

    `umform paths DECK` lists the parameters. The derivatives of one run give the numbers; a second run shows whether
    they hold. Processes have the same options with their own quantities: `umform bend --scatter thickness=2%`.
    """
    from umform.io.folders import folder_for
    from umform.io.staging import staging
    from umform.studies.scatter.found import FILES

    print_warnings_once()
    with deck_errors():
        loaded = read(deck, changes or (), trust)
    scatter_options.check(loaded)
    default = Path("results") / f"{deck.stem}-sigma"
    place = folder_for(
        out, default, FILES, overwrite=overwrite, say=lambda text: typer.echo(f"umform: {text}", err=True)
    )
    with staging(place, FILES):
        found = scatter_options.run(loaded)
        for annex in found.annexes:
            show_annex(annex)
        say_written(found.write(place))
