"""``umform sigma``: how much the results of a deck scatter, and why."""

from __future__ import annotations

from typing import Annotated

from umform.cli.check import Changes, DeckFile, Trust, deck_errors, read_to_run
from umform.cli.folders import out_option, results_folder, say_written
from umform.cli.outcome_screen import show_annex
from umform.cli.root import Debug, Overwrite, Verbose, app
from umform.cli.scattering import ScatterOptions, with_scatter
from umform.cli.warnings import print_warnings_once


@app.command()
@with_scatter
def sigma(
    deck: DeckFile,
    changes: Changes = None,
    out: Annotated[str | None, out_option("the files", "results/DECK-sigma")] = None,
    overwrite: Overwrite = False,
    trust: Trust = False,
    verbose: Verbose = 0,
    debug: Debug = False,
    *,
    scatter: ScatterOptions,
) -> None:
    """Standard deviation of the results of a deck, the share of each parameter, Cp and Cpk.

    `umform paths DECK` lists the parameters. The derivatives of one run give the numbers; a second run shows whether
    they hold. Processes have the same options with their own quantities: `umform bend --scatter thickness=2%`.
    """
    from umform.io.staging import staging
    from umform.studies.scatter.found import FILES

    print_warnings_once()
    with deck_errors():
        loaded = read_to_run(deck, changes or (), trust)
    scatter.check(loaded)
    place = results_folder(out, f"{deck.stem}-sigma", FILES, overwrite=overwrite)
    with staging(place, FILES):
        found = scatter.run(loaded)
        for annex in found.annexes:
            show_annex(annex)
        say_written(place, found.write(place))
