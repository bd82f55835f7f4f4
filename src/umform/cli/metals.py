"""``umform metal``: the library of sheet metals, and laws from measurements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.folders import results_folder, say_written
from umform.cli.metal import by_name
from umform.cli.options import is_typed
from umform.cli.root import Debug, Overwrite, app, console, printing
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.sheet_metals import SheetMetal
    from umform.studies.calibration import Calibration

metals = typer.Typer(no_args_is_help=True, rich_markup_mode="markdown")
app.add_typer(metals, name="metal")


@metals.callback()
def metal() -> None:
    """Sheet metals with sources, and laws from measurements."""


#: Columns of measurements.
_COLUMNS = ("angle", "stress", "r", "strain", "plastic_strain", "modulus")
#: Measurements that an option is for.
_USED_BY = {
    "column": ("angles", "tension", "cycles", "unloading"),
    "engineering": ("tension", "cycles"),
    "percent": ("tension", "cycles", "unloading"),
    "yield_function": ("angles",),
    "exponent": ("angles",),
    "hardening": ("tension",),
    "back_stress": ("cycles",),
    "largest_step": ("cycles",),
}
_MEASURED, _LAW, _FILES = "Measurements (CSV)", "Law", "Files"


def _option(help_text: str, panel: str, *names: str, **more: Any) -> Any:
    return typer.Option(*names, help=help_text, rich_help_panel=panel, **more)


@metals.command("list")
def list_metals() -> None:
    """Show the sheet metals of the library."""
    from rich import box
    from rich.table import Table

    from umform import sheet_metals

    table = Table("name", box=box.SIMPLE_HEAD)
    for name in ("E, GPa", "R, MPa", "Rm, MPa", "Ag, %"):
        table.add_column(name, justify="right")
    table.add_column("law")
    for name in (*sheet_metals.names(), *sheet_metals.cards()):
        metal = sheet_metals.get(name)
        numbers = (metal.young / 1e3, metal.yield_stress, metal.tensile_strength, 100 * metal.uniform_elongation)
        table.add_row(
            name, *(f"{value:.{digits}f}" for value, digits in zip(numbers, (0, 0, 0, 1), strict=True)), _kind(metal)
        )
    console().print(table)
    typer.echo("R, Rm and Ag: `umform metal show NAME` says where they come from.")


def _kind(metal: SheetMetal) -> str:
    """Yield function, hardening and back stress as short text."""
    from umform.materials import Hill48, Metal, Mises, YoshidaUemori

    law = metal.law
    if not isinstance(law, Metal):
        return f"J2, {_curve(law.hardening)}"
    function = law.yield_function
    shape = "von Mises" if isinstance(function, Mises) else "Hill48" if isinstance(function, Hill48) else "Yld2004"
    if shape == "Yld2004" and not law.directional:
        shape = "Hosford"
    if isinstance(law.back_stress, YoshidaUemori):
        motion = "Yoshida-Uemori"
    else:
        motion = _curve(law.hardening) + (", Chaboche" if law.back_stress else "")
    return f"{shape}, {motion}" + (", falling modulus" if law.modulus else "")


def _curve(hardening: object) -> str:
    return type(hardening).__name__.replace("LinearVoce", "Voce")


@metals.command()
def show(name: Annotated[str, typer.Argument(help="Name of a sheet metal: see `umform metal list`.")]) -> None:
    """Show a sheet metal: numbers, source, deck and Python."""
    from umform import sheet_metals
    from umform.materials import Metal
    from umform.studies.calibration.code import deck_block, python_code

    with by_name("umform metal show"):
        metal = sheet_metals.get(name)
    typer.echo(metal)
    if isinstance(metal.law, Metal):
        _print_directions(metal)
    typer.echo(f'\nIn a deck, by name: material = {{ library = "{metal.name}"{_rolling(metal)} }}, or\n')
    typer.echo(deck_block(metal.law))
    typer.echo(f'In Python, by name: umform.sheet_metals.get("{metal.name}").law, or\n')
    typer.echo(python_code(metal.law))


def _rolling(metal: SheetMetal) -> str:
    return ', rolling = "x"' if getattr(metal.law, "directional", False) else ""


def _print_directions(metal: SheetMetal) -> None:
    """Yield stress and r over the angle, beside the measured values."""
    from rich import box
    from rich.table import Table

    from umform.materials import Metal
    from umform.sheet_metals import Directions, balanced, uniaxial

    assert isinstance(metal.law, Metal)
    function, measured = metal.law.yield_function, metal.measured or Directions({}, {})
    table = Table("angle", title="Yield stress over that of the curve, and r-value", box=box.SIMPLE_HEAD)
    for column in ("stress", "measured", "r", "measured"):
        table.add_column(column, justify="right")
    for angle in range(0, 91, 15):
        stress, r = uniaxial(function, angle)
        table.add_row(
            str(angle), f"{stress:.3f}", _shown(measured.stress.get(angle)), f"{r:.3f}", _shown(measured.r.get(angle))
        )
    stress, r = balanced(function)
    table.add_row("biaxial", f"{stress:.3f}", _shown(measured.biaxial), f"{r:.3f}", _shown(measured.r_biaxial))
    console().print(table)


def _shown(value: float | None) -> str:
    return "" if value is None else f"{value:.3f}"


@metals.command()
def fit(
    context: typer.Context,
    young: Annotated[float, _option("Young's modulus in MPa.", _LAW)],
    poisson: Annotated[float, _option("Poisson's ratio.", _LAW)] = 0.3,
    angles: Annotated[
        Path | None, _option("Columns angle, stress, r; the row biaxial has the biaxial stress.", _MEASURED)
    ] = None,
    tension: Annotated[
        Path | None, _option("Columns strain (or plastic_strain) and stress, up to the largest force.", _MEASURED)
    ] = None,
    cycles: Annotated[Path | None, _option("Columns strain and stress, in the order of time.", _MEASURED)] = None,
    unloading: Annotated[
        Path | None, _option("Columns plastic_strain and modulus: slopes of unloading in MPa.", _MEASURED)
    ] = None,
    column: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=OTHER",
            help="Another name of a column in the files, such as stress=sigma; repeatable.",
            rich_help_panel=_MEASURED,
        ),
    ] = None,
    engineering: Annotated[
        bool, typer.Option("--engineering", help="Engineering strain and stress.", rich_help_panel=_MEASURED)
    ] = False,
    percent: Annotated[bool, typer.Option("--percent", help="Strains in per cent.", rich_help_panel=_MEASURED)] = False,
    yield_function: Annotated[str, _option("hill48 or yld2004, fitted to --angles.", _LAW)] = "hill48",
    exponent: Annotated[
        float | None, _option("Exponent of Yld2004: 6 for steel, 8 for aluminium; default: that of the law.", _LAW)
    ] = None,
    hardening: Annotated[
        str, _option("swift, voce, linear-voce, linear, perfect, table, or auto: the best of the first three.", _LAW)
    ] = "auto",
    back_stress: Annotated[
        str, _option("chaboche1 to chaboche4, or yoshida-uemori, fitted to --cycles.", _LAW)
    ] = "chaboche2",
    largest_step: Annotated[float, _option("Largest strain of a step through the cycles.", _LAW)] = 1e-3,
    out: Annotated[
        str | None,
        _option("Folder for deck, Python, constants and pictures; default: results/metal.", _FILES, "--out", "-o"),
    ] = None,
    overwrite: Overwrite = False,
    debug: Debug = False,
) -> None:
    """Fit a law to measurements, with the error of each constant.

    The files and the law are described in docs/materials.md.
    """
    from umform.studies.calibration import (
        Measurements,
        calibrate,
        read_cycles,
        read_directions,
        read_tension,
        read_unloading,
    )
    from umform.studies.calibration.files import FILES, write_files

    names = dict(_renamed(text) for text in column or ())
    given = {"angles": angles, "tension": tension, "cycles": cycles, "unloading": unloading}
    _refuse_idle(context, [name for name, file in given.items() if file is not None])
    measured = Measurements(
        None if angles is None else read_directions(angles, names),
        None
        if tension is None
        else read_tension(tension, young, engineering=engineering, percent=percent, names=names),
        None if cycles is None else read_cycles(cycles, young, engineering=engineering, percent=percent, names=names),
        None if unloading is None else read_unloading(unloading, young, percent=percent, names=names),
    )
    _refuse_missing(names, [file for file in given.values() if file is not None])
    found = calibrate(
        measured,
        young,
        poisson,
        yield_function=yield_function,
        **({} if exponent is None else {"exponent": exponent}),
        hardening=hardening,
        back_stress=back_stress,
        largest_step=largest_step,
    )
    place = results_folder(out, "metal", FILES, overwrite=overwrite)
    try:
        with printing(f"the files of the fit are in {place}"):
            _show(found)
    finally:  # even if the table cannot be printed
        files = write_files(place, found)
    say_written(place, files)


def _refuse_idle(context: typer.Context, given: Sequence[str]) -> None:
    """Refuse options of measurements that are not given, and constants of another law."""
    for name, measured in _USED_BY.items():
        if is_typed(context, name) and not set(measured) & set(given):
            raise InvalidValue(
                "this option has no effect without its measurements",
                where=f"--{name.replace('_', '-')}",
                value=context.params[name],
                cause=f"{' or '.join(f'--{one}' for one in measured)} is missing",
                remedy=f"--{measured[0]} FILE.csv beside it, or leave it out",
            )
    if is_typed(context, "exponent") and context.params["yield_function"] != "yld2004":
        raise InvalidValue(
            "only Yld2004 has an exponent",
            where="--exponent",
            value=context.params["exponent"],
            cause=f"--yield-function {context.params['yield_function']}",
            remedy="--yield-function yld2004, or leave it out",
        )
    if is_typed(context, "hardening") and "cycles" in given:
        raise InvalidValue(
            "the hardening of cycles is that of their back stress",
            where="--hardening",
            value=context.params["hardening"],
            cause="--cycles beside it",
            remedy="leave one of them out",
        )


def _refuse_missing(names: Mapping[str, str], files: Sequence[Path]) -> None:
    """Refuse another name of a column that no file has."""
    from umform.studies.calibration.columns import has_column

    for name, other in names.items():
        if not any(has_column(file, other) for file in files):
            raise InvalidValue(
                "no file has a column of this name",
                where="--column",
                value=f"{name}={other}",
                cause="a typing mistake, or a file that is not given",
                remedy="a name of the first row of a file",
            )


def _renamed(text: str) -> tuple[str, str]:
    """One of our columns, and its name in the files."""
    name, sign, other = (part.strip() for part in text.partition("="))
    if name not in _COLUMNS or not other:
        raise InvalidValue(
            "this renames no column",
            where="--column",
            value=text,
            cause="the sign = is missing" if not sign else "another name before the sign, or nothing behind it",
            remedy=f"NAME=OTHER, where NAME is one of {', '.join(_COLUMNS)}",
        )
    return name, other


def _show(found: Calibration) -> None:
    """Print constants with their errors, remarks, deck and Python."""
    from rich import box
    from rich.table import Table

    from umform.studies.calibration.files import texts
    from umform.studies.calibration.words import HEADER, remarks, rows

    table = Table(*HEADER, box=box.SIMPLE_HEAD)
    for row in rows(found):
        table.add_row(*row)
    console().print(table)
    for remark in remarks(found):
        typer.echo(remark)
    deck, python = texts(found)
    typer.echo(f"\n{deck}\n{python}")
