"""``umform draw``: draw, release and measure a round cup or a U-bend."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.folders import results_folder, say_written
from umform.cli.metal import SheetMetal, with_metal
from umform.cli.options import (
    SHEET,
    SOLUTION,
    All,
    PrintDeck,
    option,
    print_deck,
)
from umform.cli.outcome_screen import show_outcome
from umform.cli.plausible import refuse_implausible
from umform.cli.root import Csv, Debug, Overwrite, Verbose, app, printing, say
from umform.cli.spec_options import Given, given_by
from umform.cli.studies import Studies, with_studies
from umform.cli.timing import Timed, show_timing
from umform.cli.warnings import print_warnings_once
from umform.errors import InvalidValue
from umform.processes.draw.cup import CLEARANCE, ESAFORM, Cup
from umform.processes.draw.u_bend import NUMISHEET, UBend
from umform.processes.early_end import what_was_reached
from umform.spec import parameters

if TYPE_CHECKING:
    from umform.processes.draw.drawn import Drawn

_TOOLS = "Tools"
_COARSE = "Coarse mesh, for a first result in seconds"
_FINE = "Fine mesh: smaller errors for some three times the time"
#: Fields that no option gives.
_NOT_TYPED = ("material", "newton", "pace")
#: Diameters of the benchmark by the names of their options.
_DIAMETERS = {name: 2.0 * ESAFORM[radius] for radius, name in Cup.diameters.items() if radius in ESAFORM}

group = typer.Typer(no_args_is_help=True)
app.add_typer(group, name="draw")


@group.callback()
def draw() -> None:
    """Draw a part, open the tools and measure it: `umform draw cup`, `umform draw u`."""


Out = Annotated[
    str | None, typer.Option("--out", "-o", metavar="FOLDER", help="Folder for tables, pictures, fields and report.")
]
LimitCurve = Annotated[Path | None, option("Forming limit: a CSV file of minor and major logarithmic strain.", SHEET)]


def _varied(spec: type[Cup | UBend]) -> dict[str, None]:
    """Options that depend on the mesh, without defaults."""
    return dict.fromkeys(name for mesh in spec.meshes.values() for name in mesh)


def _mesh(spec: type[Cup | UBend], name: str, text: str) -> Any:
    """The option of a mesh: its help says what the mesh has, and what it has otherwise."""
    kind: type = spec
    usual, mesh = parameters(kind), spec.meshes[name].items()
    parts = [f"--{field.replace('_', '-')} {value} instead of {usual[field].default}" for field, value in mesh]
    return typer.Option(f"--{name}", help=f"{text}: {', '.join(parts)}.")


@contextmanager
def _halves() -> Iterator[None]:
    """Name the options of the diameters where a radius is refused."""
    try:
        yield
    except InvalidValue as error:
        if error.where in Cup.diameters:
            error.where = f"half of --{Cup.diameters[error.where]}"
        raise


@group.command()
@given_by(Cup, omit=(*_NOT_TYPED, *Cup.diameters), **ESAFORM | _varied(Cup))
@_halves()
@with_metal
@with_studies()
def cup(
    given: Given,
    *,
    out: Out = None,
    coarse: Annotated[bool, _mesh(Cup, "coarse", _COARSE)] = False,
    fine: Annotated[bool, _mesh(Cup, "fine", _FINE)] = False,
    punch: Annotated[float, option("Diameter of the punch in mm.", _TOOLS)] = _DIAMETERS["punch"],
    opening: Annotated[
        float | None,
        option(f"Diameter of the die opening in mm; default: punch + {2.0 * CLEARANCE:g} t.", _TOOLS),
    ] = None,
    blank: Annotated[float, option("Diameter of the blank in mm.", SHEET)] = _DIAMETERS["blank"],
    metal: SheetMetal,
    limit_curve: LimitCurve = None,
    studies: Studies,
    deck: PrintDeck = False,
    everything: All = False,
    csv: Csv = "plain",
    overwrite: Overwrite = False,
    timing: Timed = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Draw a round cup from a disc: forces, ears, thickness, strains and limits, springback.

    The defaults are the tools of the ESAFORM benchmark 2021. Each number is defined in docs/forming-results.md.
    """
    from umform.processes.draw.case import draw

    given = _on_mesh(Cup, given, coarse, fine)
    law, note = metal.law(given["thickness"])
    typed: dict[str, Any] = {"punch": punch, "opening": opening, "blank": blank}
    radii = {radius: typed[name] and 0.5 * typed[name] for radius, name in Cup.diameters.items()}
    case = Cup(**given | radii | {"holder_force": given["holder_force"] or None}, material=law)
    if deck:
        print_deck(studies.in_deck(case))
        return
    _run(
        case,
        draw,
        out,
        "cup",
        note,
        limit_curve,
        studies,
        overwrite=overwrite,
        timing=timing,
        everything=everything,
    )


@group.command()
@given_by(UBend, omit=_NOT_TYPED, called={"punch_width": "--punch"}, **NUMISHEET | _varied(UBend))
@with_metal
@with_studies()
def u(
    given: Given,
    *,
    out: Out = None,
    coarse: Annotated[bool, _mesh(UBend, "coarse", _COARSE)] = False,
    fine: Annotated[bool, _mesh(UBend, "fine", _FINE)] = False,
    metal: SheetMetal,
    limit_curve: LimitCurve = None,
    extrapolate: Annotated[
        bool | None,
        option(
            "Also run a coarser mesh: springback and forces with their errors; default, but not with --coarse, --want, "
            "--derive or --scatter.",
            SOLUTION,
            "--extrapolate/--no-extrapolate",
        ),
    ] = None,
    studies: Studies,
    deck: PrintDeck = False,
    everything: All = False,
    csv: Csv = "plain",
    overwrite: Overwrite = False,
    timing: Timed = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Draw a U-bend from a strip in plane strain: forces, springback angles, strains and limits.

    The defaults are the tools of the NUMISHEET benchmark 93. Each number is defined in docs/forming-results.md.
    """
    from umform.processes.draw.case import draw
    from umform.processes.draw.two_meshes import extrapolated

    given = _on_mesh(UBend, given, coarse, fine)
    law, note = metal.law(given["thickness"])
    case = UBend(**given, material=law)
    if deck:
        print_deck(studies.in_deck(case))
        return
    several = studies.extrapolates(extrapolate, usual=not coarse)
    how = extrapolated if several else draw
    _run(
        case,
        how,
        out,
        "u-bend",
        note,
        limit_curve,
        studies,
        overwrite=overwrite,
        timing=timing,
        everything=everything,
    )


def _on_mesh(spec: type[Cup | UBend], given: Given, coarse: bool, fine: bool) -> Given:
    """The given values, and those of the mesh for what is not given; no layers are those of the rule."""
    if coarse and fine:
        raise InvalidValue("two meshes are asked for", where="--coarse and --fine", remedy="one of them, or neither")
    mesh = spec.meshes["coarse"] if coarse else spec.meshes["fine"] if fine else {}
    typed = {name: value for name, value in given.items() if value is not None}
    return mesh | typed | {"layers": given["layers"] or None}


def _limit(file: Path | None) -> Any:
    """The forming limit of a CSV file; its first row may be a heading."""
    if file is None:
        return None
    import warnings

    import numpy as np

    from umform.errors import FileProblem, InvalidValue
    from umform.results.forming import LimitTable

    try:
        with warnings.catch_warnings(action="ignore"):  # of an empty file
            rows = np.genfromtxt(file, delimiter=",", comments="#")
        if rows.ndim == 2:
            known = np.isfinite(rows).all(axis=1)
            if not known[1:].all():
                raise ValueError(f"row {int(np.argmin(known[1:])) + 2} is no pair of numbers")
            rows = rows[known]
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
    studies: Studies,
    *,
    overwrite: bool,
    timing: bool,
    everything: bool,
) -> None:
    """Draw, print, write."""
    from umform.io.staging import staging
    from umform.processes.draw.files import FILES, RESULTS, draw_blank, write_files
    from umform.processes.draw.words import before_the_run

    print_warnings_once()
    studies.check(case)
    refuse_implausible(case)
    curve = _limit(limit)
    place = results_folder(out, name, RESULTS, overwrite=overwrite)
    case = studies.compensated(case)
    say(before_the_run(case))
    with staging(place, FILES):
        picture, blank = draw_blank(place, case)
        say(f"the mesh of the blank is drawn in {picture}")
        with what_was_reached(place, "draw.vtkhdf"):
            drawn = how(case, limit=curve)
        more: list[Path] = []
        try:
            for one, written in studies.added_to(drawn, case, place, finished=bool(drawn.released)):
                drawn = one
                more += written
            with printing(f"the files of the part are in {place}"):
                show_outcome(drawn, note=note, everything=everything)
        finally:  # even if the table cannot be printed
            with drawn.result.timing.files:
                files = [*write_files(place, drawn, note, blank), *more]
    say_written(place, files)
    if timing:
        show_timing(drawn.result.timing)
    if drawn.released is None:
        raise typer.Exit(1)
    studies.end()
