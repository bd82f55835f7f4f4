"""``umform hem``: an acute bend, closed flat, over an inner sheet or an insert, open, or with a loop."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from umform.cli.derive import Derive, check_derived, derived, sloped
from umform.cli.drawn_tools import named_tools
from umform.cli.given import Given, given_by
from umform.cli.metal import law_of
from umform.cli.options import All, Curve, FlowCurve, Material, Modulus, Poisson, Yield, Young, option
from umform.cli.outcome_screen import show_outcome
from umform.cli.plausible import refuse_implausible
from umform.cli.root import Csv, Debug, Overwrite, Verbose, app, console, printing
from umform.cli.scattering import ScatterOptions, scattering
from umform.cli.warnings import print_warnings_once
from umform.processes.air_bending.spec import AirBending
from umform.processes.hemming.spec import ACUTE, FOLDED, Hemming, acute, jumps
from umform.spec import parameters

#: Parameters of the sheet that a hem does not have: drawn tools, and what belongs to a single bend.
_NONE_OF_A_HEM = ("punch_section", "die_section", "on_top", "width", "width_elements", "stroke", "bottoming")
_OF_HEM = [name for name in parameters(Hemming) if name != "sheet"]
#: Lengths that follow from the thickness, over the thickness.
_LENGTHS = Hemming.proportions | {
    name: size for name, size in ACUTE.items() if parameters(AirBending)[name].about.unit == "mm"
}


@app.command()
@given_by(
    Hemming,
    AirBending,
    omit=("sheet", "material", *_NONE_OF_A_HEM),
    otherwise={name: f"{times:g} thickness{'' if times == 1.0 else 'es'}" for name, times in _LENGTHS.items()},
    **ACUTE | FOLDED | dict.fromkeys(_LENGTHS) | {"thickness": 1.0, "gap": None},
)
@scattering
def hem(
    context: typer.Context,
    given: Given,
    out: Annotated[
        str | None,
        typer.Option(
            "--out",
            "-o",
            metavar="FOLDER",
            help="Folder for tables, pictures, fields and report; default: results/hem.",
        ),
    ] = None,
    punch: Annotated[str | None, option("Usual punch by name, such as 30/R0.8; see `umform tools`.", "Tools")] = None,
    die: Annotated[str | None, option("Usual die by name, such as V8/30; see `umform tools`.", "Tools")] = None,
    material: Material = None,
    young: Young = None,
    poisson: Poisson = None,
    yield_stress: Yield = None,
    hardening_modulus: Modulus = None,
    curve: Curve = None,
    flow_curve: FlowCurve = None,
    everything: All = False,
    derive: Derive = None,
    csv: Csv = "plain",
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
    *,
    scatter_options: ScatterOptions,
) -> None:
    """Hem a sheet: an acute bend in a V-die, then flattened between a plate and a table.

    Each number is defined in docs/bending-operations.md.
    """
    from umform.io.folders import folder_for
    from umform.io.staging import staging
    from umform.processes.hemming import hemming
    from umform.processes.hemming.files import FILES, RESULTS, write_files
    from umform.studies.slopes.study import planned_runs

    print_warnings_once()
    thickness = given["thickness"]
    given = named_tools(context, given, punch, die)
    law, note = law_of(material, young, poisson, yield_stress, hardening_modulus, curve, flow_curve, thickness)
    of_hem = {name: given.pop(name) for name in _OF_HEM}
    sheet = acute(**{name: value for name, value in given.items() if value is not None}, material=law)
    case = Hemming(**of_hem, sheet=sheet)
    by_slopes = bool(derive) and jumps(case)
    if derive or scatter_options:  # refuse what is wrong before the run
        some = case if by_slopes else replace(case, sheet=replace(sheet, stroke=0.5 * sheet.largest_stroke))
        check_derived(some, derive, {} if by_slopes else case.strokes)
        scatter_options.check(some)
    if by_slopes:
        planned_runs(case, derive or ())
    refuse_implausible(case)
    say = partial(typer.echo, err=True)
    place = folder_for(out, Path("results/hem"), RESULTS, overwrite=overwrite, say=lambda text: say(f"umform: {text}"))
    with staging(place, FILES):
        done, more = hemming(case), list[Path]()
        try:
            if by_slopes:
                done, more = sloped(done, hemming, case, derive or (), place)
            else:
                done, more = derived(done, done.with_stroke, derive, place, done.strokes)
            done, spread = scatter_options.added_to(done, done.with_stroke, place)
            more += spread
            with printing(f"the files of the hem are in {place}"):
                show_outcome(done, note=note, everything=everything)
        finally:  # even if the table cannot be printed
            files = [*write_files(place, done, note), *more]
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True)
