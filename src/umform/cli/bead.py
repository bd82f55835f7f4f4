"""``umform bead``: a sheet drawn through a modelled draw bead."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.given import Given, given_by
from umform.cli.metal import law_of
from umform.cli.options import (
    SOLUTION,
    FlowCurve,
    Material,
    Modulus,
    Poisson,
    PrintDeck,
    SwiftCurve,
    Yield,
    Young,
    option,
    print_deck,
)
from umform.cli.root import Debug, Overwrite, Verbose, app, console, printing
from umform.cli.run_checks import show_checks
from umform.cli.timing import Timed, show_timing
from umform.cli.warnings import echo_warnings, print_warnings_once
from umform.errors import UmformError
from umform.processes.draw_bead.spec import DrawBead

if TYPE_CHECKING:
    from umform.processes.draw_bead.measures import Drawn


@app.command()
@given_by(DrawBead, omit=("material",))
def bead(
    given: Given,
    out: Annotated[
        str | None,
        typer.Option(metavar="FOLDER", help="Folder for tables, pictures, fields and report; default: results/bead."),
    ] = None,
    material: Material = None,
    young: Young = None,
    poisson: Poisson = None,
    yield_stress: Yield = None,
    hardening_modulus: Modulus = None,
    swift: SwiftCurve = None,
    flow_curve: FlowCurve = None,
    extrapolate: Annotated[
        bool,
        option(
            "Also run two coarser meshes: extrapolated forces and their error.",
            SOLUTION,
            "--extrapolate/--no-extrapolate",
        ),
    ] = True,
    deck: PrintDeck = False,
    overwrite: Overwrite = False,
    timing: Timed = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Draw a sheet through a draw bead: restraining force, uplift, thinning, and the equivalent bead.

    Each number is defined in docs/draw-beads.md.
    """
    from umform.io.folders import folder_for
    from umform.io.staging import staging
    from umform.processes.draw_bead.case import drawn_through, extrapolated
    from umform.processes.draw_bead.files import FILES, RESULTS, write_files

    print_warnings_once()
    law, note = law_of(material, young, poisson, yield_stress, hardening_modulus, swift, flow_curve, given["thickness"])
    case = DrawBead(**given, material=law)
    if deck:
        print_deck(case)
        return
    say = partial(typer.echo, err=True)
    place = folder_for(out, Path("results/bead"), RESULTS, overwrite=overwrite, say=lambda text: say(f"umform: {text}"))
    with staging(place, FILES):
        with _what_was_reached(place):
            drawn = extrapolated(case) if extrapolate else drawn_through(case)
        try:
            with printing(f"the files of the bead are in {place}"):
                _show(drawn, note)
        finally:  # even if the table cannot be printed
            with drawn.result.timing.files:
                files = write_files(place, drawn, note)
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True)
    if timing:
        show_timing(drawn.result.timing)


@contextmanager
def _what_was_reached(out: Path) -> Iterator[None]:
    """Write the history of a run that ended early."""
    try:
        yield
    except (UmformError, KeyboardInterrupt) as stop:
        reached = getattr(stop, "result", None)
        if reached is not None and reached.frames:
            files = [reached.write(out / name) for name in ("history.csv", "bead.vtkhdf")]
            stop.add_note(f"  results so far are in {out}: {', '.join(file.name for file in files)}")
        raise


def _show(drawn: Drawn, note: str) -> None:
    """Print the measures and the equivalent bead."""
    from rich import box
    from rich.table import Table

    from umform.processes.draw_bead.equivalent import in_python
    from umform.processes.draw_bead.words import summary

    table = Table("quantity", title="Draw bead", box=box.SIMPLE_HEAD)
    table.add_column("value", justify="right")
    table.add_column("unit")
    for row in summary(drawn):
        table.add_row(*row)
    screen = console()
    screen.print(table)
    screen.print(f"equivalent: {in_python(drawn)}", soft_wrap=True, markup=False, highlight=False)
    show_checks(screen, drawn.stages)
    if note:
        screen.print(note, soft_wrap=True)
    echo_warnings(drawn.warnings)
