"""``umform identify``: numbers of a deck from measurements of what it simulates."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.check import Changes, DeckFile, Trust, deck_errors, read_to_run
from umform.cli.folders import out_option, results_folder, say_written
from umform.cli.outcome_screen import print_table
from umform.cli.root import Debug, Overwrite, Verbose, app, console, printing, say
from umform.cli.warnings import print_warnings_once
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.studies.identification import MeasuredCurve, MeasuredNumber, Sought
    from umform.studies.identification.data import Measured

#: Largest number of trials.
MOST = 30
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_FIND = re.compile(
    rf"(?P<path>[^=\s]+)(?:=(?:(?P<low>{_NUMBER}):(?P<high>{_NUMBER}))?(?:@(?P<start>{_NUMBER}))?"
    rf"(?:\+-(?P<deviation>{_NUMBER}))?)?"
)
_BEHIND = rf"(?:\+-(?P<deviation>{_NUMBER}))?(?P<at>(?:@[^=@\s]+={_NUMBER})*)"
_CURVE = re.compile(rf"(?P<x>[^,=@]+),(?P<y>[^,=@]+)(?:@(?P<step>\d+))?=(?P<file>.+?){_BEHIND}")
_QUANTITY = re.compile(rf"(?P<name>[^=]+)=(?P<value>{_NUMBER}){_BEHIND}")


Find = typer.Option(
    metavar="KEY=LOW:HIGH@START+-DEVIATION",
    help="Number to find from measurements, with bounds, first value, and the standard deviation of what was known "
    "before; all but the key may be left out; repeatable, see `umform identify`.",
)
Quantities = typer.Option(
    metavar="NAME=VALUE+-DEVIATION@KEY=VALUE",
    help="Measured number: a quantity such as angle, or a column of the history such as `punch_force:max`, with its "
    "standard deviation, and where other numbers held for it, such as @stroke=5.2; repeatable.",
)


@app.command()
def identify(
    deck: DeckFile,
    find: Annotated[list[str], Find],
    curve: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X,Y@STEP=FILE+-DEVIATION@KEY=VALUE",
            help="Measured curve: two columns of the history, and a CSV file with columns of these names, and perhaps "
            "deviation; the rest as for --quantity; repeatable.",
        ),
    ] = None,
    quantity: Annotated[list[str] | None, Quantities] = None,
    changes: Changes = None,
    most: Annotated[int, typer.Option(min=1, help="Largest number of trials.")] = MOST,
    out: Annotated[str | None, out_option("the files", "results/DECK-identified")] = None,
    overwrite: Overwrite = False,
    trust: Trust = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Find numbers of a deck from measured curves and numbers, by least squares with the derivatives of its runs.

    Prints each number with its standard error, and what the measurements do not determine; writes the deck with the
    numbers.
    """
    print_warnings_once()
    with deck_errors():
        problem = read_to_run(deck, changes or (), trust)
    identify_case(problem, find, curve, quantity, out, f"{deck.stem}-identified", most, overwrite)


def identify_case(
    subject: Any,
    find: Sequence[str],
    curve: Sequence[str] | None,
    quantity: Sequence[str] | None,
    out: str | None,
    name: str,
    most: int,
    overwrite: bool,
) -> None:
    """Print and write what is found of a problem, or of a case of a process."""
    from umform.studies.identification import identify as search
    from umform.studies.identification.found import FILES

    sought = dict(_sought(text) for text in find)
    if len(sought) < len(find):
        raise InvalidValue("a number is looked for twice", where="--find", value=", ".join(find), remedy="once")
    data: list[Measured] = [*(_curve(text) for text in curve or []), *(_quantity(text) for text in quantity or [])]
    if not data:
        raise InvalidValue(
            "nothing was measured",
            where="--quantity, --curve",
            cause="numbers are found from measurements",
            remedy="--quantity angle=90.5+-0.2, or --curve stroke,stroke_force=measured.csv of a deck",
        )
    place = results_folder(out, name, FILES, overwrite=overwrite)
    found = search(
        subject, sought, data, most=most, on_run=lambda count, misfit: say(f"run {count}: misfit {misfit:.3g}")
    )
    try:
        with printing(f"the files are in {place}"):
            print_table(found.table)
            for remark in found.remarks:
                console().print(remark, soft_wrap=True, markup=False)
    finally:  # even if the table cannot be printed
        files = found.write(place)
    say_written(place, files)


def _sought(text: str) -> tuple[str, Sought]:
    from umform.studies.identification import Sought

    parts = _parts(_FIND, text, "--find", "KEY=400:700@520+-30, of which all but the key may be left out")
    bounds = {
        name: value for name in ("low", "high", "start", "deviation") if (value := _number(parts[name])) is not None
    }
    return parts["path"], Sought(**bounds)


def _curve(text: str) -> MeasuredCurve:
    from umform.studies.identification import MeasuredCurve

    parts = _parts(_CURVE, text, "--curve", "stroke,punch_force=measured.csv, or stroke,punch_force@1=measured.csv+-5")
    step = parts["step"]
    return MeasuredCurve.read(
        parts["file"],
        parts["x"].strip(),
        parts["y"].strip(),
        _number(parts["deviation"]),
        None if step is None else int(step),
        _at(parts["at"]),
    )


def _quantity(text: str) -> MeasuredNumber:
    from umform.studies.identification import MeasuredNumber

    parts = _parts(_QUANTITY, text, "--quantity", "angle=91.3+-.2")
    return MeasuredNumber(parts["name"].strip(), float(parts["value"]), _number(parts["deviation"]), _at(parts["at"]))


def _at(text: str) -> dict[str, float]:
    pairs = (pair.split("=") for pair in text.split("@")[1:])
    return {name: int(value) if value.isdigit() else float(value) for name, value in pairs}


def _parts(form: re.Pattern[str], text: str, option: str, remedy: str) -> dict[str, Any]:
    found = form.fullmatch(text.strip())
    if found is None:
        raise InvalidValue(
            "this option cannot be read",
            where=option,
            value=text,
            cause="a sign that is missing, a decimal comma, or a unit behind a number",
            remedy=remedy,
        )
    return found.groupdict()


def _number(text: str | None) -> float | None:
    return None if text is None else float(text)
