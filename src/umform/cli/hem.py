"""``umform hem``: an acute bend, flattened over an insert or open."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from umform.cli.metal import law_of
from umform.cli.options import SHEET, SOLUTION, Curve, FlowCurve, Material, Modulus, Poisson, Yield, Young, option
from umform.cli.outcome_screen import show_outcome
from umform.cli.root import Debug, Overwrite, Verbose, app, console, printing
from umform.cli.warnings import print_warnings_once

_HEM, _TOOLS = "Hem (mm, degrees)", "Tools of the first bend (mm, degrees)"


@app.command()
def hem(
    out: Annotated[
        str | None,
        typer.Option(metavar="FOLDER", help="Folder for tables, pictures, fields and report; default: results/hem."),
    ] = None,
    gap: Annotated[
        float | None, option("Final distance of flange and base, thickness of the insert; default: 1 thickness.", _HEM)
    ] = None,
    flange: Annotated[float | None, option("Length of the flat flange; default: 12 thicknesses.", _HEM)] = None,
    base: Annotated[float | None, option("Length of the flat base; default: 30 thicknesses.", _HEM)] = None,
    insert: Annotated[
        bool, option("A rigid plate between flange and base, or an open hem.", _HEM, "--insert/--open")
    ] = True,
    angle: Annotated[float, option("Angle after the first bend.", _HEM)] = 40.0,
    opening: Annotated[float | None, option("Opening of the die; default: 8 thicknesses.", _TOOLS)] = None,
    die_angle: Annotated[float, option("Angle of the die.", _TOOLS)] = 30.0,
    die_radius: Annotated[float | None, option("Radius of the die shoulders; default: 1 thickness.", _TOOLS)] = None,
    punch_angle: Annotated[float, option("Angle of the punch.", _TOOLS)] = 30.0,
    punch_radius: Annotated[float | None, option("Radius of the punch tip; default: 0.5 thicknesses.", _TOOLS)] = None,
    thickness: Annotated[float, option("Thickness of the sheet.", SHEET)] = 1.0,
    material: Material = None,
    rolling: Annotated[
        float | None, option("Degrees from the bend line to the rolling direction: 0 along it, 90 across.", SHEET)
    ] = None,
    young: Young = None,
    poisson: Poisson = None,
    yield_stress: Yield = None,
    hardening_modulus: Modulus = None,
    curve: Curve = None,
    flow_curve: FlowCurve = None,
    layers: Annotated[int, option("Elements through the thickness.", SOLUTION)] = 2,
    elements_per_thickness: Annotated[float, option("Elements per thickness along the sheet.", SOLUTION)] = 3.0,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Hem a sheet: an acute bend in a V-die, then flattened between a plate and a table.

    Each number is defined in docs/bending-operations.md.
    """
    from umform.io.folders import folder_for
    from umform.io.staging import staging
    from umform.processes.air_bending.spec import AirBending
    from umform.processes.hemming import Hemming, hemming
    from umform.processes.hemming.files import FILES, RESULTS, write_files

    def size(given: float | None, thicknesses: float) -> float:
        return thicknesses * thickness if given is None else given

    print_warnings_once()
    law, note = law_of(material, young, poisson, yield_stress, hardening_modulus, curve, flow_curve, thickness)
    sheet = AirBending(
        thickness=thickness,
        opening=size(opening, 8.0),
        die_angle=die_angle,
        die_radius=size(die_radius, 1.0),
        punch_angle=punch_angle,
        punch_radius=size(punch_radius, 0.5),
        material=law,
        rolling=rolling,
        layers=layers,
        elements_per_thickness=elements_per_thickness,
    )
    case = Hemming(
        gap=size(gap, 1.0),
        flange=size(flange, 12.0),
        base=size(base, 30.0),
        insert=insert,
        angle=angle,
        sheet=sheet,
    )
    say = partial(typer.echo, err=True)
    place = folder_for(out, Path("results/hem"), RESULTS, overwrite=overwrite, say=lambda text: say(f"umform: {text}"))
    with staging(place, FILES):
        done = hemming(case)
        try:
            with printing(f"the files of the hem are in {place}"):
                show_outcome(done, note)
        finally:  # even if the table cannot be printed
            files = write_files(place, done, note)
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True)
