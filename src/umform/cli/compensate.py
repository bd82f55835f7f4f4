"""``umform compensate``: parameters for wanted results."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.check import Changes, DeckFile, Trust, deck_errors, read_to_run
from umform.cli.folders import out_option, results_folder, say_written
from umform.cli.outcome_screen import show_annex
from umform.cli.root import Debug, Overwrite, Verbose, app, say
from umform.cli.warnings import print_warnings_once
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.studies.goals import Wanted

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
    out: Annotated[str | None, out_option("table and deck", "results/DECK-compensated")] = None,
    trust: Trust = False,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Find parameters for which results of a deck are the wanted ones, such as tools that compensate springback.

    The first run has derivatives, so that few more are needed. For a shape, offset fields of tools follow the deviation
    of the released part.
    """
    from umform.studies.goals import compensate as find
    from umform.studies.goals import compensate_shape as find_shape
    from umform.studies.goals.found import TABLE

    print_warnings_once()
    said: list[str] = []
    with deck_errors("by", "want", "within"):
        problem = read_to_run(deck, changes or (), trust)
        place = results_folder(out, f"{deck.stem}-compensated", (TABLE,), overwrite=overwrite, say=said.append)
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
        say(text)
    show_annex(found.annex)
    say_written(place, found.write(place))
    if not found.reached:
        raise typer.Exit(1)


def check_wanted(want: Sequence[str] | None, by: Sequence[str] | None, searched: bool = False) -> None:
    """Refuse wanted results that are wrong before a run.

    Parameters
    ----------
    want, by : sequence of str, optional
        Those of the command line.
    searched : bool
        Whether the stroke, which is the start, is not known.
    """
    if not want and not by:
        return
    if not want or not by:
        raise InvalidValue(
            "a wanted result needs a parameter that follows, and a parameter a wanted result",
            where="--want and --by",
            remedy="both, such as --want NAME=VALUE+-TOLERANCE --by PATH",
        )
    if searched:
        raise InvalidValue(
            "a search for wanted results begins with a stroke",
            where="--want",
            value=", ".join(want),
            cause="--angle, --angles or a force beside it, which look for a stroke of their own",
            remedy="--stroke beside it, and --by stroke where the stroke follows",
        )
    wanted(want)
    bounded(by)


def wanted(texts: Sequence[str]) -> dict[str, Wanted]:
    """Wanted results of the command line."""
    from umform.studies.goals import Wanted

    found: dict[str, Wanted] = {}
    for text in texts:
        parts = _WANT.fullmatch(text)
        if parts is None:
            raise InvalidValue(
                "this is no wanted result",
                where="--want",
                value=text,
                cause="a name, a value or a tolerance is missing",
                remedy="write NAME=VALUE+-TOLERANCE, as springback=2+-0.05",
            )
        name = parts["name"].strip()
        if name in found:
            raise InvalidValue("a result is wanted twice", where="--want", value=text, remedy="once")
        found[name] = Wanted(float(parts["value"]), float(parts["tolerance"]))
    return found


def bounded(texts: Sequence[str]) -> tuple[list[str], dict[str, tuple[float, float]]]:
    """Paths of the command line, and the bounds of some."""
    paths: list[str] = []
    bounds: dict[str, tuple[float, float]] = {}
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
