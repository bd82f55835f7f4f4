"""``umform flat``: the flat pattern of a part of a STEP file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.folders import out_option, results_folder, say_written
from umform.cli.metal import by_name
from umform.cli.options import SHEET, SOLUTION, is_typed, option
from umform.cli.root import Debug, Overwrite, Verbose, app, console, say
from umform.cli.spec_options import Given, given_by
from umform.cli.warnings import print_warnings_once
from umform.errors import InvalidValue
from umform.processes.air_bending.spec import AirBending

if TYPE_CHECKING:
    from umform.flat_pattern import AllowanceProvider, FlatPattern

_LENGTHS = "Flat length of bends"
#: Parameters of a bend that follow from the part, or that parts with several bends do not have.
_NONE = (
    "thickness",
    "material",
    "punch_section",
    "die_section",
    "on_top",
    "width",
    "width_elements",
    "stroke",
    "bottoming",
)
#: Options of computed bends beside those of the solution.
_COMPUTED = ("rolling", "friction", "store")


@app.command()
@given_by(
    AirBending,
    omit=_NONE,
    otherwise={"opening": "8 to 12 thicknesses, by the radius of the drawing"},
    opening=None,
)
def flat(
    context: typer.Context,
    part: Annotated[Path, typer.Argument(metavar="PART.step", help="STEP file of one bent part.")],
    given: Given,
    metal: Annotated[str | None, option("Name of `umform metal list`, or a file of a metal (.toml).", SHEET)] = None,
    k_factor: Annotated[
        float | None,
        option("K by ANSI in place of computed bends: the neutral line at K t from the inner face.", _LENGTHS),
    ] = None,
    table: Annotated[
        Path | None,
        option(
            "CSV file in place of computed bends: of `umform bend table`, or angle, radius, thickness, allowance.",
            _LENGTHS,
        ),
    ] = None,
    store: Annotated[Path | None, option("Folder of the store of computed bends.", _LENGTHS)] = None,
    bend: Annotated[
        bool, typer.Option("--bend", help="Bend the whole part by simulation: strokes, angles, forces, flanges.")
    ] = False,
    out: Annotated[str | None, out_option("drawing, numbers, sheet", "results/flat")] = None,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Unfold a part: the flat pattern of a STEP file as DXF, an order of its bends, the operator's sheet.

    Thickness, bends and radii are found. Bends are computed once and kept. See docs/flat-pattern.md.
    """
    from umform.flat_pattern import Orders, Tooling, bend_part
    from umform.flat_pattern import flat as flattened
    from umform.flat_pattern.files import RESULTS, write_files
    from umform.io.staging import staging
    from umform.io.store import Store
    from umform.problem.metal_file import metal_of
    from umform.processes.bend_sequence import Bodies

    print_warnings_once()
    allowance = _provider(metal, k_factor, table)
    if allowance is not None and not bend:
        _refuse_idle(context, "--table" if k_factor is None else "--k-factor")
    opening = given.pop("opening")
    tooling, bodies = Tooling(AirBending(**given), metal, opening), Bodies()
    if bend and metal is None:
        raise InvalidValue(
            "a part is bent of a metal",
            where="--bend",
            cause="computed bends need its law",
            remedy="--metal DC04",
        )
    place = results_folder(out, "flat", RESULTS, overwrite=overwrite)
    with by_name("--metal"):
        pattern = flattened(part, allowance=allowance, tooling=tooling, bodies=bodies, store=Store(store))
    for warning in pattern.warnings:
        say(f"warning: {warning}")
    orders = Orders(pattern, tooling, bodies)
    with staging(place, RESULTS):
        bent = bend_part(orders) if bend else None
        _show(pattern)
        note = "" if metal is None else metal_of(metal, pattern.thickness).note
        files = write_files(place, orders, bent, note)
    if pattern.order and not orders.is_prismatic:
        console().print(
            "It is checked in cuts across each bend line; flanges at the ends of the lines are not looked at."
        )
    if bent is not None:
        errors = ", ".join(f"{round(error, 3) + 0.0:+.3f}" for error in bent.errors)
        console().print(f"Flanges of the simulation less those of the drawing: {errors} mm", soft_wrap=True)
    say_written(place, dict.fromkeys(file.name if file.parent.name != "sequence" else "sequence/" for file in files))
    if bent is not None and bent.part.collisions:
        typer.secho("umform: " + "; ".join(bent.part.collisions), fg=typer.colors.RED, err=True)
        raise typer.Exit(1)


def _provider(metal: str | None, k_factor: float | None, table: Path | None) -> AllowanceProvider | None:
    """The allowance given in place of computed bends; None without one."""
    from umform.flat_pattern import AllowanceTable, KFactor

    if k_factor is not None and table is not None:
        raise InvalidValue(
            "give one source of the flat length of bends",
            where="--table",
            cause="--k-factor is given, too",
            remedy="leave one of them out",
        )
    if metal is None and k_factor is None and table is None:
        raise InvalidValue(
            "nothing says how long a bend is in the flat",
            where="--metal",
            cause="neither a metal, a K-factor nor a table",
            remedy="--metal DC04 for computed bends, --k-factor .44, or --table bends.csv",
        )
    if table is not None:
        return AllowanceTable.read(table)
    return None if k_factor is None else KFactor(k_factor)


def _refuse_idle(context: typer.Context, source: str) -> None:
    """Refuse options of computed bends beside another source of the flat lengths."""
    for one in context.command.params:
        solves = getattr(one, "rich_help_panel", None) == SOLUTION or one.name in _COMPUTED
        if solves and one.name is not None and is_typed(context, one.name):
            raise InvalidValue(
                "this option has no effect without computed bends",
                where=one.opts[0],
                value=context.params[one.name],
                cause=f"the flat lengths are those of {source}, and --bend is not given",
                remedy=f"leave it or {source} out, or add --bend",
            )


def _show(pattern: FlatPattern) -> None:
    from rich import box
    from rich.table import Table

    length, width = pattern.size.tolist()
    unit = "" if pattern.unit.startswith("milli") else f" (in {pattern.unit}, converted to mm)"
    console().print(
        f"{pattern.path.name}{unit}: sheet of {pattern.thickness:.4g} mm, flat {length:.3f} x {width:.3f} mm, "
        f"{pattern.area:.1f} mm², {len(pattern.holes)} holes",
        soft_wrap=True,
    )
    table = Table("bend", "faces", "direction", box=box.SIMPLE_HEAD)
    for name in ("bent by", "R, mm", "length, mm", "allowance, mm"):
        table.add_column(name, justify="right")
    table.add_column("from")
    for bend in pattern.bends:
        table.add_row(
            str(bend.number),
            ", ".join(map(str, bend.faces)),
            bend.direction,
            f"{bend.angle:.2f}°",
            f"{bend.allowance.radius:.3f}",
            f"{bend.length:.2f}",
            f"{bend.allowance.length:.3f}",
            bend.allowance.source,
        )
    console().print(table)
    if pattern.order:
        console().print(f"Order of the bends: {', '.join(map(str, pattern.order))}")
