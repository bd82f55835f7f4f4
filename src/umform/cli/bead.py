"""``umform bead``: a sheet drawn through a modelled draw bead."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from umform.cli.compensate import By, Want, compensated
from umform.cli.derive import Derive, check_derived, derived
from umform.cli.given import Given, given_by
from umform.cli.metal import law_of
from umform.cli.options import (
    SOLUTION,
    All,
    Curve,
    FlowCurve,
    Material,
    Modulus,
    Poisson,
    PrintDeck,
    Yield,
    Young,
    option,
    print_deck,
)
from umform.cli.outcome_screen import show_outcome
from umform.cli.plausible import refuse_implausible
from umform.cli.root import Csv, Debug, Overwrite, Verbose, app, console, printing
from umform.cli.scattering import ScatterOptions, scattering
from umform.cli.several_meshes import extrapolates
from umform.cli.timing import Timed, show_timing
from umform.cli.warnings import print_warnings_once
from umform.errors import UmformError
from umform.processes.draw_bead.spec import DrawBead


@app.command()
@given_by(DrawBead, omit=("material", "newton", "pace"))
@scattering
def bead(
    given: Given,
    out: Annotated[
        str | None,
        typer.Option(
            "--out",
            "-o",
            metavar="FOLDER",
            help="Folder for tables, pictures, fields and report; default: results/bead.",
        ),
    ] = None,
    material: Material = None,
    young: Young = None,
    poisson: Poisson = None,
    yield_stress: Yield = None,
    hardening_modulus: Modulus = None,
    curve: Curve = None,
    flow_curve: FlowCurve = None,
    extrapolate: Annotated[
        bool | None,
        option(
            "Also run two coarser meshes: extrapolated forces and their error; default, but not with --want, --derive "
            "or --scatter.",
            SOLUTION,
            "--extrapolate/--no-extrapolate",
        ),
    ] = None,
    want: Want = None,
    by: By = None,
    derive: Derive = None,
    deck: PrintDeck = False,
    everything: All = False,
    csv: Csv = "plain",
    overwrite: Overwrite = False,
    timing: Timed = False,
    verbose: Verbose = 0,
    debug: Debug = False,
    *,
    scatter_options: ScatterOptions,
) -> None:
    """Draw a sheet through a draw bead: restraining force, uplift, thinning, and the equivalent bead.

    Each number is defined in docs/draw-beads.md.
    """
    from umform.io.folders import folder_for
    from umform.io.staging import staging
    from umform.processes.draw_bead.case import drawn_through, extrapolated
    from umform.processes.draw_bead.equivalent import in_python
    from umform.processes.draw_bead.files import FILES, RESULTS, write_files

    print_warnings_once()
    law, note = law_of(material, young, poisson, yield_stress, hardening_modulus, curve, flow_curve, given["thickness"])
    case = DrawBead(**given, material=law)
    if deck:
        print_deck(compensated(case, want, by).case)
        return
    several = extrapolates(extrapolate, want, derive, scatter_options)
    check_derived(case, derive)
    scatter_options.check(case)
    refuse_implausible(case)
    say = partial(typer.echo, err=True)
    place = folder_for(out, Path("results/bead"), RESULTS, overwrite=overwrite, say=lambda text: say(f"umform: {text}"))
    goals = compensated(case, want, by)
    case = goals.case
    with staging(place, FILES):
        with _what_was_reached(place):
            drawn = extrapolated(case) if several else drawn_through(case)
        more: list[Path] = []
        scatter: list[Path] = []
        wanted: list[Path] = []
        try:
            drawn, more = derived(drawn, case, derive, place)
            drawn, scatter = scatter_options.added_to(drawn, case, place)
            drawn, wanted = goals.added_to(drawn, place)
            with printing(f"the files of the bead are in {place}"):
                show_outcome(drawn, f"equivalent: {in_python(drawn)}", note=note, everything=everything)
        finally:  # even if the table cannot be printed
            with drawn.result.timing.files:
                files = [*write_files(place, drawn, note), *more, *scatter, *wanted]
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True)
    if timing:
        show_timing(drawn.result.timing)
    goals.end()


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
