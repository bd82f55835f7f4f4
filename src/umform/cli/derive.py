"""``umform derive``: derivatives of results with respect to parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.check import Changes, DeckFile, Trust, deck_errors, read_to_run
from umform.cli.folders import out_option, results_folder, say_written
from umform.cli.outcome_screen import show_annex
from umform.cli.root import Debug, Overwrite, Verbose, app, say
from umform.cli.warnings import print_warnings_once
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.studies.derivatives.rates import Rates


@app.command()
def derive(
    deck: DeckFile,
    by: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PATH",
            help="Parameter, such as tools.die.radius (see `umform paths DECK`), or its end; repeatable. Default: "
            "those of the table [derivatives] of the deck.",
        ),
    ] = None,
    of: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="A measure of the deck, such as hat.theta1.released, or a column of the history, such as "
            "punch_force:max (or last, min, peak, sum); repeatable. Default: all measures, else forces.",
        ),
    ] = None,
    hold: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=PATH", help="A result that stays constant, by a parameter that follows; repeatable."
        ),
    ] = None,
    width: Annotated[
        float | None,
        typer.Option(
            metavar="PART",
            help="Where results jump: slopes of whole runs with each parameter smaller and larger by up to this part "
            "of it (0.02), in place of derivatives.",
        ),
    ] = None,
    changes: Changes = None,
    out: Annotated[str | None, out_option("tables and picture", "results/DECK-derive")] = None,
    trust: Trust = False,
    overwrite: Overwrite = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Run a deck, and find how its results change with parameters: derivatives of this run, not differences of two.

    Each parameter costs some .5 to .6 of a run. A release ends where its force is zero for the changed parameter, too.
    """
    from umform.studies.derivatives import derivatives
    from umform.studies.derivatives.found import TABLE
    from umform.studies.derivatives.table import KEYS
    from umform.studies.slopes import slopes
    from umform.studies.slopes.found import TABLE as SLOPES

    print_warnings_once()
    said: list[str] = []
    typed = {"by": by, "of": of, "hold": hold}
    with deck_errors("width", **KEYS | {name: f"--{name}" for name, values in typed.items() if values}):
        problem = read_to_run(deck, changes or (), trust)
        table = problem.contents.derivatives
        paths, held = by or (table.by if table else []), _pairs(hold or ())
        wanted = of or (table.results or None if table else None)
        _refuse_none(paths)
        _refuse_both(held, width)
        held = held or (table.hold if table else {})
        files = (TABLE, SLOPES)
        place = results_folder(out, f"{deck.stem}-derive", files, overwrite=overwrite, say=said.append)
        found: Rates
        if width is None:
            found = derivatives(problem, paths, wanted, hold=held)
        else:
            if held:
                said.append(f"slopes of whole runs hold no result; the deck would hold {', '.join(held)}")
            found = slopes(problem, paths, wanted, width=width)
    for text in said:  # only of a run that starts
        say(text)
    show_annex(found.annex)
    say_written(place, found.write(place))


def _refuse_none(paths: Sequence[str]) -> None:
    if not paths:
        raise InvalidValue(
            "there is no parameter for derivatives",
            where="--by",
            cause="neither the option, nor a table [derivatives] in the deck",
            remedy="--by tools.die.radius, for instance; umform paths DECK lists all",
        )


def _refuse_both(held: Mapping[str, str], width: float | None) -> None:
    if held and width is not None:
        raise InvalidValue(
            "slopes of whole runs hold no result",
            where="--hold",
            value=", ".join(held),
            cause="--width beside it",
            remedy="leave one of them out",
        )


def _pairs(texts: Sequence[str]) -> dict[str, str]:
    """Paths by the results that they keep constant."""
    held: dict[str, str] = {}
    for text in texts:
        name, sign, path = (part.strip() for part in text.partition("="))
        if not (sign and name and path) or name in held:
            raise InvalidValue(
                "a result is held twice" if name in held else "this holds no result",
                where="--hold",
                value=text,
                cause="" if name in held else "the sign = is missing, or nothing stands beside it",
                remedy="write NAME=PATH once for each result, as angle=stroke",
            )
        held[name] = path
    return held
