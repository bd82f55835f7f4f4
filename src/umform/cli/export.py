"""``umform export``: the state of a formed part for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from umform.cli.check import Trust, deck_errors
from umform.cli.root import Debug, Overwrite, app

#: Formats of fields of all states, or of the last one.
_FIELDS = ("vtu", "pvd", "xdmf")
#: Points through shells and layers of solids, unless others are asked for.
_POINTS, _LAYERS = 9, 6


@app.command()
def export(
    run: Annotated[
        Path,
        typer.Argument(
            metavar="RUN",
            help="Folder of a run with state = true under [output], its state.h5, or a checkpoint; for vtu, pvd and "
            "xdmf a folder with fields, or a .vtkhdf file.",
        ),
    ],
    to: Annotated[
        str,
        typer.Option(
            metavar="PROGRAM",
            help="dynain (LS-DYNA), radioss (OpenRadioss), abaqus or calculix; or vtu, pvd, xdmf for the fields.",
        ),
    ] = "dynain",
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            metavar="FILE",
            help="The file; default: the name of the deck, with .k, .sta or .inp; or of the fields.",
        ),
    ] = None,
    stage: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Deck of an earlier operation of the same part; default: the run itself."),
    ] = None,
    mesh: Annotated[
        str | None,
        typer.Option(
            metavar="shells|solids", help="Middle surface, or layers of solids; default: what the format has."
        ),
    ] = None,
    points: Annotated[int, typer.Option(help="Points through the thickness of shells.")] = _POINTS,
    layers: Annotated[int, typer.Option(help="Layers of solids through each element.")] = _LAYERS,
    mirror: Annotated[
        bool, typer.Option("--mirror", help="Add the mirror images of a modelled half or quarter.")
    ] = False,
    units: Annotated[
        str | None, typer.Option(metavar="TEXT", help="Units in the head of the file; default: those of the deck.")
    ] = None,
    overwrite: Overwrite = False,
    trust: Trust = False,
    debug: Debug = False,
) -> None:
    """Write the state of a formed part for LS-DYNA, OpenRadioss, Abaqus or CalculiX: mesh, thickness, stresses.

    The state is that at the end of a run. Keywords, order of points and limits: docs/other-programs.md. The formats
    vtu, pvd and xdmf have the fields of a .vtkhdf file, for programs that do not read it.
    """
    from umform.errors import InvalidValue
    from umform.problem.finished import finished
    from umform.report.state_files import PROGRAMS, export_state

    if to in _FIELDS:
        of_states = {
            "--stage": stage,
            "--mesh": mesh,
            "--points": points != _POINTS,
            "--layers": layers != _LAYERS,
            "--mirror": mirror,
            "--units": units,
        }
        typed = [name for name, value in of_states.items() if value]
        if typed:
            raise InvalidValue(
                "the fields of a run are written as they are",
                where=", ".join(typed),
                value=f"--to {to}",
                cause="an option of the state of a part",
                remedy=f"leave it out, or --to {', '.join(PROGRAMS)}",
            )
        _export_fields(run, to, out, overwrite)
        return
    if to not in PROGRAMS:
        known = ", ".join([*PROGRAMS, *_FIELDS])
        raise InvalidValue("unknown program", where="to", value=to, remedy=f"one of {known}")
    wanted = mesh or PROGRAMS[to].meshes[0]
    if wanted == "solids" and points != _POINTS:
        raise InvalidValue("solids have layers in place of points", where="--points", value=points, remedy="--layers")
    if wanted == "shells" and layers != _LAYERS:
        raise InvalidValue("shells have points in place of layers", where="--layers", value=layers, remedy="--points")
    with deck_errors():
        part = finished(run, stage, trust)
    path = out or Path(part.name).with_suffix(PROGRAMS[to].suffix)
    _check_free(path, overwrite)
    state = export_state(
        part.model,
        path,
        to,
        mesh=mesh,
        points=points,
        layers=layers,
        mirror=mirror,
        units=part.units if units is None else units,
    )
    kind = "shells" if state.shells else "solids"
    typer.echo(f"Written to {path}: {len(state.points)} nodes, {len(state.cells)} {kind}")


def _export_fields(run: Path, to: str, out: Path | None, overwrite: bool) -> None:
    """Write the fields of a run in another format."""
    from umform.cli.field_files import file_of_fields
    from umform.errors import InvalidValue
    from umform.io.series import convert

    fields = file_of_fields(run)
    path = out or Path(fields.name).with_suffix(f".{to}")
    if path.suffix != f".{to}":
        raise InvalidValue(
            "the name does not fit the format", where="--out", value=str(path), remedy=f"end it in .{to}"
        )
    _check_free(path, overwrite)
    count = convert(fields, path)
    typer.echo(f"Written to {path}: {count} {'state' if count == 1 else 'states'}")


def _check_free(path: Path, overwrite: bool) -> None:
    """Refuse to overwrite a file unasked."""
    from umform.errors import FileProblem

    if path.exists() and not overwrite:
        raise FileProblem(
            "the file exists",
            where=str(path),
            cause="an earlier export",
            remedy="--out another file, or --overwrite",
        )
