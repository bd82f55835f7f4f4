"""``umform demo free-bending``: the example of the paper."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.folders import out_option, results_folder, say_written
from umform.cli.option_names import as_typed, options_of
from umform.cli.options import SOLUTION, PrintDeck, option, print_deck
from umform.cli.outcome_screen import print_table
from umform.cli.root import Debug, Overwrite, Verbose, app, console, printing, say
from umform.cli.spec_options import Given, given_by
from umform.cli.timing import Timed, show_timing
from umform.processes.bending.spec import RECONSTRUCTION, FreeBending

if TYPE_CHECKING:
    from umform.processes.bending.showcase import Demo

demos = typer.Typer(no_args_is_help=True, rich_markup_mode="markdown")
app.add_typer(demos, name="demo")


@demos.callback()
def demo() -> None:
    """Run an example and show the results."""


_RUNS = "Which runs"
_THROUGH: dict[str, Any] = dict.fromkeys(("thickness_points", "thickness_rule", "thickness_order", "tie_E33"))


@demos.command("free-bending", epilog=RECONSTRUCTION)
@given_by(
    FreeBending,
    omit=("mesh", "element", "contact"),
    called={"tie_E33": "--tie-e33/--no-tie-e33"},
    **_THROUGH,
)
def free_bending(
    context: typer.Context,
    given: Given,
    out: Annotated[str | None, out_option("tables, pictures, fields and report", "results/free-bending")] = None,
    mesh: Annotated[list[str] | None, option("Elements along and across, such as 24x1; repeatable.", _RUNS)] = None,
    element: Annotated[list[str] | None, option("Element of the catalogue; repeatable.", _RUNS)] = None,
    contact: Annotated[
        list[str] | None, option("Contact points per direction and facet, or nodes; may be repeated.", _RUNS)
    ] = None,
    processes: Annotated[int | None, option("Runs at a time; default: the processors.", SOLUTION)] = None,
    deck: PrintDeck = False,
    overwrite: Overwrite = False,
    timing: Timed = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Bend a strip over a cylinder and release it.

    Without options, the 14 runs of the example: 8-node elements on 24x1 and 48x2, 18-node elements on 12x1 and 24x2,
    with contact at the nodes and at two numbers of Gauss points, and a cubic thickness strain on the fine meshes.
    Options of mesh, element and contact select runs; a thickness option replaces the cubic ones; all other options
    apply to all runs.
    """
    logging.getLogger("umform").addHandler(logging.NullHandler())  # warnings are printed with the name of their run
    from umform.processes.bending import showcase
    from umform.processes.bending.options import read_contact, read_mesh

    selection = showcase.Selection(
        meshes=tuple(read_mesh(text) for text in mesh or ()),
        elements=tuple(element or ()),
        contacts=tuple(read_contact(text) for text in contact or ()),
    )
    base = FreeBending(**{name: value for name, value in given.items() if value is not None})
    runs = selection.runs(base, sharp=all(given[name] is None for name in _THROUGH))
    if deck:  # that of the first run
        print_deck(runs[0])
        return
    place = results_folder(out, "free-bending", showcase.FILES, overwrite=overwrite)
    outcome = showcase.demo(place, runs, processes=processes)
    with printing(f"the files of the runs are in {place}"):
        _show(outcome, place, options_of(context.command), timing=timing)


def _show(outcome: Demo, out: Path, options: Mapping[str, str], *, timing: bool) -> None:
    """Print the table, the files, and failures."""
    from umform.processes.bending.table import legend, table
    from umform.report.repeats import counted

    screen = console()
    print_table(table(outcome.runs), "Free bending of a strip over a cylinder")
    for line in legend(outcome.runs):
        screen.print(line)
    screen.print(RECONSTRUCTION)
    say_written(out, outcome.files)
    if timing:
        from umform.timing import Timing

        show_timing(Timing.sum(run.timing for run in outcome.runs))
    for run in outcome.runs:
        for warning in counted(run.warnings):
            say(f"{run.case.name}: {warning}")
    failed = [run for run in outcome.runs if run.failure]
    for run in failed:
        say(f"{run.case.name}: {as_typed(run.failure, options)}")
    if failed:
        typer.echo(f"  earlier results are in {out}", err=True)
        raise typer.Exit(1)
