"""``umform draw``: draw, release and measure a round cup or a U-bend."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.metal import law_of
from umform.cli.options import SHEET, SOLUTION, FlowCurve, Material, Modulus, Poisson, SwiftCurve, Yield, Young, option
from umform.cli.root import Debug, Overwrite, Verbose, app, console, printing
from umform.cli.run_checks import show_checks
from umform.cli.timing import Timed, show_timing
from umform.cli.warnings import echo_warnings, print_warnings_once
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.processes.draw.cup import Cup
    from umform.processes.draw.drawn import Drawn
    from umform.processes.draw.u_bend import UBend

_TOOLS = "Tools (mm, N)"
#: Options of diameters by the radii of a cup.
_DIAMETERS = {
    "die_radius": "half of --opening",
    "punch_radius": "half of --punch",
    "blank_radius": "half of --blank",
}

group = typer.Typer(no_args_is_help=True, help="Draw a part, open the tools and measure it: `umform draw cup`.")
app.add_typer(group, name="draw")

Out = Annotated[str | None, typer.Option(metavar="FOLDER", help="Folder for tables, pictures, fields and report.")]
LimitCurve = Annotated[Path | None, option("Forming limit: a CSV file of minor and major logarithmic strain.", SHEET)]
Coarse = Annotated[bool, typer.Option("--coarse", help="Coarse mesh, for a first result in seconds.")]
Fine = Annotated[bool, typer.Option("--fine", help="Fine mesh: smaller errors for some three times the time.")]
Turn = Annotated[float | None, option("Largest angle in degrees that an element turns over a tool radius.", SOLUTION)]
Layers = Annotated[int, option("Elements through the thickness; 0: by the rule for sharp bends.", SOLUTION)]
ThicknessPoints = Annotated[int | None, option("Thickness points per layer.", SOLUTION)]


@contextmanager
def _halves() -> Iterator[None]:
    """Name the options of the diameters where a radius is refused."""
    try:
        yield
    except InvalidValue as error:
        error.where = _DIAMETERS.get(error.where, error.where)
        raise


@group.command()
@_halves()
def cup(
    out: Out = None,
    coarse: Coarse = False,
    fine: Fine = False,
    punch: Annotated[float, option("Diameter of the punch.", _TOOLS)] = 60.0,
    punch_edge: Annotated[float, option("Edge radius of the punch.", _TOOLS)] = 5.0,
    opening: Annotated[
        float | None, option("Diameter of the opening of the die; default: punch + 2.4 t.", _TOOLS)
    ] = None,
    die_edge: Annotated[float, option("Edge radius of the die.", _TOOLS)] = 10.0,
    holder_force: Annotated[float, option("Force on the whole holder, N; 0: fixed at its gap.", _TOOLS)] = 40e3,
    holder_gap: Annotated[
        float | None, option("Smallest distance between holder and die; default 1.04 t.", _TOOLS)
    ] = None,
    friction: Annotated[float, option("Coefficient of friction.", _TOOLS)] = 0.09,
    stroke: Annotated[float | None, option("Stroke of the punch; default: the full cup.", _TOOLS)] = None,
    blank: Annotated[float, option("Diameter of the blank.", SHEET)] = 107.5,
    thickness: Annotated[float, option("Thickness of the sheet.", SHEET)] = 1.0,
    material: Material = None,
    young: Young = None,
    poisson: Poisson = None,
    yield_stress: Yield = None,
    hardening_modulus: Modulus = None,
    swift: SwiftCurve = None,
    flow_curve: FlowCurve = None,
    limit_curve: LimitCurve = None,
    element: Annotated[str, option("Element of the catalogue.", SOLUTION)] = "ANS3DEAS",
    turn: Turn = None,
    around: Annotated[int | None, option("Elements on a quarter of the rim.", SOLUTION)] = None,
    layers: Layers = 1,
    thickness_points: ThicknessPoints = None,
    contact_points: Annotated[int, option("Contact points per direction and facet.", SOLUTION)] = 2,
    penalty: Annotated[
        float | None, option("Contact pressure per penetration; default by the allowed penetration.", SOLUTION)
    ] = None,
    overwrite: Overwrite = False,
    timing: Timed = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Draw a round cup from a disc: forces, ears, thickness, strains and limits, springback.

    The defaults are the tools of the ESAFORM benchmark 2021. Each number is defined in docs/forming-results.md.
    """
    from umform.processes.draw.case import draw
    from umform.processes.draw.cup import CLEARANCE, Cup

    _one_mesh(coarse, fine)
    law, note = law_of(material, young, poisson, yield_stress, hardening_modulus, swift, flow_curve, thickness)
    case = Cup(
        thickness=thickness,
        blank_radius=0.5 * blank,
        material=law,
        punch_radius=0.5 * punch,
        punch_edge=punch_edge,
        die_radius=0.5 * punch + CLEARANCE * thickness if opening is None else 0.5 * opening,
        die_edge=die_edge,
        holder_force=holder_force or None,
        holder_gap=holder_gap,
        friction=friction,
        stroke=stroke,
        element=element,
        turn=_chosen(turn, coarse, 30.0, 9.0 if fine else 15.0),
        around=_chosen(around, coarse, 8, 24 if fine else 12),
        layers=layers or None,
        thickness_points=thickness_points,
        contact_points=contact_points,
        penalty=penalty,
    )
    _run(case, draw, out, "cup", note, limit_curve, overwrite=overwrite, timing=timing)


@group.command()
def u(
    out: Out = None,
    coarse: Coarse = False,
    fine: Fine = False,
    punch: Annotated[float, option("Width of the punch.", _TOOLS)] = 50.0,
    punch_edge: Annotated[float, option("Edge radius of the punch.", _TOOLS)] = 5.0,
    opening: Annotated[float | None, option("Opening of the die; default: punch + 2.56 t.", _TOOLS)] = None,
    die_edge: Annotated[float, option("Edge radius of the die.", _TOOLS)] = 5.0,
    holder_force: Annotated[
        float, option("Force on the whole holder, N: both sides, all of the width.", _TOOLS)
    ] = 2450.0,
    friction: Annotated[float, option("Coefficient of friction.", _TOOLS)] = 0.144,
    stroke: Annotated[float | None, option("Stroke of the punch; default: a fifth of the blank.", _TOOLS)] = None,
    length: Annotated[float, option("Length of the blank.", SHEET)] = 350.0,
    width: Annotated[float, option("Width of the blank.", SHEET)] = 35.0,
    thickness: Annotated[float, option("Thickness of the sheet.", SHEET)] = 0.78,
    material: Material = None,
    young: Young = None,
    poisson: Poisson = None,
    yield_stress: Yield = None,
    hardening_modulus: Modulus = None,
    swift: SwiftCurve = None,
    flow_curve: FlowCurve = None,
    limit_curve: LimitCurve = None,
    element: Annotated[
        str | None, option("Element of the catalogue; default BEND18, with --coarse BEND8.", SOLUTION)
    ] = None,
    turn: Turn = None,
    layers: Layers = 1,
    thickness_points: ThicknessPoints = None,
    contact_points: Annotated[int | None, option("Contact points per direction and facet.", SOLUTION)] = None,
    penalty: Annotated[
        float | None, option("Contact pressure per penetration; default by the allowed penetration.", SOLUTION)
    ] = None,
    extrapolate: Annotated[
        bool | None,
        option(
            "Also run two coarser meshes: springback and forces with their errors; default, but not with --coarse.",
            SOLUTION,
            "--extrapolate/--no-extrapolate",
        ),
    ] = None,
    overwrite: Overwrite = False,
    timing: Timed = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Draw a U-bend from a strip in plane strain: forces, springback angles, strains and limits.

    The defaults are the tools of the NUMISHEET benchmark 93. Each number is defined in docs/forming-results.md.
    """
    from umform.processes.draw.case import draw
    from umform.processes.draw.three_meshes import extrapolated
    from umform.processes.draw.u_bend import CLEARANCE, UBend

    _one_mesh(coarse, fine)
    law, note = law_of(material, young, poisson, yield_stress, hardening_modulus, swift, flow_curve, thickness)
    case = UBend(
        thickness=thickness,
        length=length,
        width=width,
        material=law,
        punch_width=punch,
        punch_edge=punch_edge,
        opening=punch + 2.0 * CLEARANCE * thickness if opening is None else opening,
        die_edge=die_edge,
        holder_force=holder_force,
        friction=friction,
        stroke=stroke,
        element=_chosen(element, coarse, "BEND8", "BEND18"),
        turn=_chosen(turn, coarse, 20.0, 12.0 if fine else 17.0),
        layers=layers or None,
        thickness_points=thickness_points,
        contact_points=_chosen(contact_points, coarse, 3, 4),
        penalty=penalty,
    )
    how = extrapolated if _chosen(extrapolate, coarse, False, True) else draw
    _run(case, how, out, "u-bend", note, limit_curve, overwrite=overwrite, timing=timing)


def _one_mesh(coarse: bool, fine: bool) -> None:
    if coarse and fine:
        raise InvalidValue("two meshes are asked for", where="--coarse and --fine", remedy="one of them, or neither")


def _chosen(given: Any, coarse: bool, first: Any, usual: Any) -> Any:
    """The given value, or the default for a coarse or the usual mesh."""
    return given if given is not None else first if coarse else usual


def _limit(file: Path | None) -> Any:
    """The forming limit of a CSV file; lines that are no numbers, such as a heading, are left out."""
    if file is None:
        return None
    import numpy as np

    from umform.errors import FileProblem, InvalidValue
    from umform.results.forming import LimitTable

    try:
        rows = np.genfromtxt(file, delimiter=",", comments="#")
        rows = rows[np.isfinite(rows).all(axis=-1)] if rows.ndim == 2 else rows
        return LimitTable(*(rows.T if rows.ndim == 2 and rows.shape[1] == 2 else (rows, rows)))
    except (OSError, ValueError, InvalidValue) as error:
        raise FileProblem(
            "the forming limit cannot be read",
            where=str(file),
            value=getattr(error, "value", None),
            cause=_why(error),
            remedy="a CSV file with two columns, a comma between them, decimal points: minor and major logarithmic "
            "strain, the minor ones ascending",
        ) from error


def _why(error: Exception) -> str:
    """The cause in a line: NumPy lists each line of a file whose columns differ in number."""
    return str(getattr(error, "what", "")) or ", ".join(line.strip() for line in str(error).splitlines()[:3])


def _run(
    case: Cup | UBend,
    how: Callable[..., Drawn],
    out: str | None,
    name: str,
    note: str,
    limit: Path | None,
    *,
    overwrite: bool,
    timing: bool,
) -> None:
    """Draw, print, write."""
    from umform.io.folders import folder_for
    from umform.io.staging import staging
    from umform.processes.draw.files import FILES, draw_blank, write_files
    from umform.processes.draw.words import before_the_run

    print_warnings_once()
    curve = _limit(limit)
    say = partial(typer.echo, err=True)
    place = folder_for(out, Path("results") / name, FILES, overwrite=overwrite, say=lambda text: say(f"umform: {text}"))
    say(f"umform: {before_the_run(case)}")
    with staging(place, FILES):
        picture, blank = draw_blank(place, case)
        say(f"umform: the mesh of the blank is drawn in {picture}")
        drawn = how(case, limit=curve)
        try:
            with printing(f"the files of the part are in {place}"):
                _show(drawn, note)
        finally:  # even if the table cannot be printed
            with drawn.result.timing.files:
                files = write_files(place, drawn, note, blank)
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True)
    if timing:
        show_timing(drawn.result.timing)
    if drawn.released is None:
        raise typer.Exit(1)


def _show(drawn: Drawn, note: str) -> None:
    """Print the measures."""
    from rich import box
    from rich.table import Table

    from umform.processes.draw.words import about_errors, summary, title

    columns, *rows = summary(drawn)
    table = Table(title=title(drawn), box=box.SIMPLE_HEAD)
    for name in columns:
        table.add_column(name, justify="left" if name in ("quantity", "unit") else "right")
    for row in rows:
        table.add_row(*row)
    screen = console()
    screen.print(table)
    show_checks(screen, drawn.stages)
    if remark := about_errors(drawn):
        screen.print(remark, soft_wrap=True)
    if note:
        screen.print(note, soft_wrap=True)
    echo_warnings(drawn.warnings)
