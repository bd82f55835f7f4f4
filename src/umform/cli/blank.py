"""``umform blank``: the blank of a formed part, estimated in one step."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from umform.cli.folders import out_option, results_folder, say_written
from umform.cli.metal import SheetMetal, with_metal
from umform.cli.options import SHEET, All, option
from umform.cli.outcome_screen import show_outcome
from umform.cli.root import Debug, Overwrite, Verbose, app, printing
from umform.cli.warnings import print_warnings_once
from umform.errors import InvalidValue

_HELD, _PART = "What holds the sheet", "Part"
#: Coefficient of friction of lubricated sheet.
_LUBRICATED = 0.1


@app.command()
@with_metal
def blank(
    part: Annotated[
        Path, typer.Argument(metavar="PART", help="Mid-surface of the part, drawn along z: STL, STEP, IGES, a mesh.")
    ],
    *,
    thickness: Annotated[float, option("Thickness of the sheet in mm.", SHEET)] = 1.0,
    metal: SheetMetal,
    rolling: Annotated[float, option("Angle of the rolling direction to x in degrees.", SHEET)] = 0.0,
    holder_force: Annotated[float, option("Force of the blank holder in N.", _HELD)] = 0.0,
    friction: Annotated[
        float | None,
        option(
            f"Coefficient of friction under the holder, and of punch and die on radii; default: {_LUBRICATED:g}, and "
            "none if the edge is clamped.",
            _HELD,
        ),
    ] = None,
    bead: Annotated[float, option("Restraining force of draw beads along the outer edge in N/mm.", _HELD)] = 0.0,
    gap: Annotated[
        float | None, option("Distance of punch and die in mm: walls are not thicker; default: no limit.", _HELD)
    ] = None,
    clamped: Annotated[
        bool, typer.Option("--clamped", help="The outer edge is held as it lies.", rich_help_panel=_HELD)
    ] = False,
    scale: Annotated[
        float, option("Factor on coordinates: 25.4 for STL and meshes in inches; CAD files have their unit.", _PART)
    ] = 1.0,
    offset: Annotated[
        float, option("Distance from the surface to the mid-surface along its normals in mm.", _PART)
    ] = 0.0,
    weld: Annotated[float, option("Corners nearer than this are one, in mm; default: 1e-6 of the size.", _PART)] = 0.0,
    size: Annotated[
        float | None,
        option("Largest side of a triangle in mm; default: those of the file, of CAD files 1/20 of the part.", _PART),
    ] = None,
    coarse: Annotated[
        bool, typer.Option("--coarse", help="Triangles of CAD files of 1/10 of the part.", rich_help_panel=_PART)
    ] = False,
    out: Annotated[str | None, out_option("drawing, tables, page", "results/blank")] = None,
    everything: All = False,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Estimate the blank of a formed part in one step: outline as DXF, strains, thickness.

    It is an estimate: the incremental run decides. See docs/blank.md.
    """
    from umform.flat_pattern.one_step import Blank
    from umform.flat_pattern.one_step import blank as estimated
    from umform.flat_pattern.one_step.files import FILES, write_files
    from umform.flat_pattern.one_step.reading import coarse_size
    from umform.io.staging import staging

    print_warnings_once()
    law, note = metal.law(thickness)
    friction = (0.0 if clamped else _LUBRICATED) if friction is None else friction
    case = Blank(law, thickness, rolling, holder_force, friction, bead, gap, clamped)
    place = results_folder(out, "blank", FILES, overwrite=overwrite)
    if coarse:
        size = _coarse(coarse_size(part, scale), size)
    found = estimated(part, case, scale=scale, weld=weld, size=size, offset=offset)
    with staging(place, FILES):
        with printing(f"the files of the blank are in {place}"):
            show_outcome(found, note=note, everything=everything)
        files = write_files(place, found, note)
    say_written(place, files)


def _coarse(found: float | None, size: float | None) -> float:
    """Side of coarse triangles; refused beside another one, and of a file that has its own triangles."""
    if found is None or size is not None:
        raise InvalidValue(
            "coarse triangles are those of a CAD file without a size",
            where="--coarse",
            cause="a file that has triangles" if found is None else "--size beside it",
            remedy="leave it out; --size is the largest side of a triangle",
        )
    return found
