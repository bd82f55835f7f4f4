"""``umform compensate``, and ``--want`` of processes: parameters for wanted results."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.check import Changes, DeckFile, Trust, deck_errors, read
from umform.cli.outcome_screen import print_table
from umform.cli.root import Debug, Overwrite, Verbose, app, console
from umform.cli.warnings import echo_warnings, print_warnings_once
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.studies.goals import Compensated, CompensatedShape, Wanted

Want = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME=VALUE+-TOLERANCE",
        help="A wanted result, such as angle=90+-0.05; parameters --by follow; repeatable, see `umform compensate`.",
    ),
]
By = Annotated[
    list[str] | None,
    typer.Option(
        metavar="PATH",
        help="A parameter that follows a wanted result, with bounds as `holder_force=2000:8000`; repeatable.",
    ),
]

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_WANT = re.compile(rf"(?P<name>.+)=\s*(?P<value>{_NUMBER})\s*(?:\+-|±)\s*(?P<tolerance>{_NUMBER})\s*")
_BOUNDS = re.compile(rf"(?P<path>[^=]+)=\s*(?P<low>{_NUMBER})\s*:\s*(?P<high>{_NUMBER})\s*")


@app.command()
def compensate(
    deck: DeckFile,
    by: Annotated[
        list[str],
        typer.Option(
            metavar="PATH",
            help="A parameter that follows, with bounds as tools.punch.angle=80:90; for --shape a tool with an offset "
            "field; repeatable.",
        ),
    ],
    want: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE+-TOLERANCE",
            help="A measure of the deck, such as hat.theta1.released=90+-0.05, or a column of the history, such as "
            "punch_force:max; repeatable.",
        ),
    ] = None,
    shape: Annotated[
        str | None,
        typer.Option(
            metavar="FACES",
            help="Instead: these faces, lower or upper, have the released shape that they have in the tools at first.",
        ),
    ] = None,
    within: Annotated[
        float | None,
        typer.Option(
            metavar="LENGTH", help="Largest deviation of the shape; default: a tenth of that of the first run."
        ),
    ] = None,
    runs: Annotated[int | None, typer.Option(min=1, help="Largest number of runs; default: 8, for a shape 4.")] = None,
    changes: Changes = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Folder for table and deck; default: results/DECK-compensated."),
    ] = None,
    trust: Trust = False,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Find parameters for which results of a deck are the wanted ones, such as tools that compensate springback.

    The first run has derivatives, so that few more are needed. For a shape, offset fields of tools follow the deviation
    of the released part.
    """
    from umform.io.folders import folder_for
    from umform.studies.goals import compensate as find
    from umform.studies.goals import compensate_shape as find_shape
    from umform.studies.goals.compensate import TABLE

    print_warnings_once()
    said: list[str] = []
    with deck_errors():
        problem = read(deck, changes or (), trust)
        default = Path("results") / f"{deck.stem}-compensated"
        place = folder_for(out, default, (TABLE,), overwrite=overwrite, say=said.append)
        if bool(want) == bool(shape) or (within is not None and not shape):
            raise InvalidValue(
                "either results or a shape are wanted",
                where="--want, --shape",
                remedy="--want NAME=VALUE+-TOLERANCE --by PATH, or --shape upper --by die --by punch [--within 0.1]",
            )
        most: dict[str, Any] = {} if runs is None else {"most": runs}
        found: Any
        if shape:
            found = find_shape(problem, shape, by, within=within, **most)
        else:
            paths, bounds = bounded(by)
            found = find(problem, wanted(want or ()), paths, bounds=bounds, **most)
    for text in said:
        typer.echo(f"umform: {text}", err=True)
    if shape:
        show_shape(found)
    else:
        show(found)
    files = found.write(place)
    console().print(f"Written to {place}: {', '.join(file.name for file in files)}", soft_wrap=True, markup=False)
    if not found.reached:
        raise typer.Exit(1)


def compensated(case: Any, want: Sequence[str] | None, by: Sequence[str] | None) -> Any:
    """The case of a process with parameters for wanted results; the case itself without any."""
    from umform.studies.goals import compensate as find

    if not want and not by:
        return case
    if not want or not by:
        raise InvalidValue(
            "a wanted result needs a parameter that follows, and a parameter a wanted result",
            where="--want and --by",
            remedy="both, such as --want angle=90+-0.05 --by stroke",
        )
    paths, bounds = bounded(by)
    found = find(case, wanted(want), paths, bounds=bounds)
    show(found)
    return found.subject


def show(found: Compensated) -> None:
    """Print the runs, and whether the results were reached."""
    print_table(found.table, "Compensation")
    values = ", ".join(f"{path} = {one.value:.6g} {one.unit}".rstrip() for path, one in found.parameters.items())
    console().print(values, soft_wrap=True, markup=False)
    if not found.reached:
        echo_warnings(["the wanted results are not reached: more runs, wider bounds, or other parameters"])


def show_shape(found: CompensatedShape) -> None:
    """Print the runs, and whether the shape was reached."""
    print_table(found.table, "Compensation")
    if found.stopped:
        echo_warnings([f"the next run failed: {found.stopped}"])
    if not found.reached:
        echo_warnings(
            [f"the largest deviation is {found.best.largest:.4g}, wanted {found.within:.4g}: more runs or coefficients"]
        )


def wanted(texts: Sequence[str]) -> dict[str, Wanted]:
    """Wanted results of the command line."""
    from umform.studies.goals import Wanted

    found = {}
    for text in texts:
        parts = _WANT.fullmatch(text)
        if parts is None:
            raise InvalidValue(
                "this is no wanted result",
                where="--want",
                value=text,
                cause="a name, a value or a tolerance is missing",
                remedy="write NAME=VALUE+-TOLERANCE, as angle=90+-0.05",
            )
        found[parts["name"].strip()] = Wanted(float(parts["value"]), float(parts["tolerance"]))
    return found


def bounded(texts: Sequence[str]) -> tuple[list[str], dict[str, tuple[float, float]]]:
    """Paths of the command line, and the bounds of some."""
    paths, bounds = [], {}
    for text in texts:
        parts = _BOUNDS.fullmatch(text)
        if parts is None and "=" in text:
            raise InvalidValue(
                "these are no bounds", where="--by", value=text, remedy="write PATH=LOW:HIGH, as holder_force=2000:8000"
            )
        paths.append(text.strip() if parts is None else parts["path"].strip())
        if parts is not None:
            bounds[paths[-1]] = (float(parts["low"]), float(parts["high"]))
    return paths, bounds
