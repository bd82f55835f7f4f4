"""``umform check``: check a deck without solving it."""

from __future__ import annotations

import logging
import re
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.root import Debug, Verbose, app, console, say, say_of
from umform.errors import InvalidValue, UmformError

if TYPE_CHECKING:
    from umform.problem import Problem
    from umform.problem.findings import Finding
    from umform.problem.prepared import Prepared

log = logging.getLogger("umform")

DeckFile = Annotated[Path, typer.Argument(metavar="DECK", help="Deck, a TOML file.")]
Changes = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Set a key of the deck, such as steps.0.increments=5; repeatable."),
]

Trust = Annotated[
    bool,
    typer.Option("--trust", help='Import classes that the deck names as "module:Class": code, which you trust.'),
]
Picture = Annotated[
    Path | None,
    typer.Option("--blank", metavar="FILE.png", help="Draw the mesh of a blank over the sizes that its tools ask for."),
]
Folder = Annotated[
    Path | None, typer.Option("--tools", metavar="FOLDER", help="Write each tool near the sheet as NAME.stl.")
]
Force = Annotated[bool, typer.Option("--force", help="Run despite implausible numbers: these errors become warnings.")]

#: A word, such as the name of an element; a number with a decimal comma.
_WORD, _DECIMAL_COMMA = re.compile(r"[^\W\d][\w.-]*"), re.compile(r"[-+]?\d*,\d+")


@app.command()
def check(
    deck: DeckFile,
    changes: Changes = None,
    blank: Picture = None,
    tools: Folder = None,
    trust: Trust = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Check a deck without solving it: keys, names, gaps, supports, element sizes, units, effort.

    An error ends with exit code 1; warnings do not.
    """
    from umform.problem import check as checks
    from umform.problem.findings import Level
    from umform.studies.derivatives.table import check_table

    with deck_errors():
        loaded = read(deck, changes or (), trust)
        problem = loaded.build()
        findings = [*checks.check(loaded, problem), *check_table(loaded)]
    _show(findings)
    if blank is not None:
        _draw_blank(problem, blank)
    if tools is not None:
        _write_tools(problem, tools)
    if any(finding.level is Level.ERROR for finding in findings):
        raise typer.Exit(1)


def read(path: Path, changes: Sequence[str], trust: bool) -> Problem:
    """The deck of a file with some changed values."""
    from umform.problem import load

    found: dict[str, Any] = {}
    for text in changes:
        key, value = _change(text)
        if key in found:
            say(f"--set {key} is given twice; the last value counts: {value}")
        found[key] = value
    return load(path, found, trust)


def read_to_run(path: Path, changes: Sequence[str], trust: bool) -> Problem:
    """The same, with a warning where a changed thickness leaves its tools behind."""
    from umform.problem.findings import accept
    from umform.problem.tools_that_stay import changed_thickness

    deck = read(path, changes, trust)
    for text in accept(changed_thickness(deck)):
        log.warning(text)
    return deck


@contextmanager
def deck_errors(*options: str, **others: str) -> Iterator[None]:
    """Print the mistakes in a deck in terms of its keys, those in some options by their names, and exit with code 1."""
    names = {one: f"--{one}" for one in options} | others
    try:
        yield
    except UmformError as error:
        if isinstance(error, InvalidValue):
            error.where = names.get(error.where, error.where)
        say_of(error)
        raise typer.Exit(1) from error


def _change(text: str) -> tuple[str, Any]:
    key, _, value = text.partition("=")
    try:
        found = tomllib.loads(f"value = {value}")
        if len(found) > 1:
            raise ValueError
        return key.strip(), found["value"]
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        if key.strip() and _WORD.fullmatch(value.strip()):
            return key.strip(), value.strip()  # text without quotes; a key that needs a number refuses it
        comma = _DECIMAL_COMMA.fullmatch(value.strip())
        raise InvalidValue(
            "this changes no key",
            where="--set",
            value=text,
            cause="a decimal comma" if comma else "the value is neither a number, a word, a list nor text in quotes",
            remedy=f"write {key}={value.replace(',', '.')}" if comma else "write key=value, as steps.0.increments=5",
        ) from None


def _draw_blank(problem: Prepared, path: Path) -> None:
    if problem.sizes is None:
        raise InvalidValue(
            "the sizes of this mesh do not follow the tools",
            where="--blank",
            value=path,
            remedy='in [mesh]: generator = "outline" with turn, the largest angle of an element over a radius',
        )
    from umform.processes.sizes_picture import draw_sizes

    draw_sizes(problem.sizes, path, problem.model.mesh)
    typer.echo(f"Written to {path}")


def _write_tools(problem: Prepared, folder: Path) -> None:
    """The tools in a box around the sheet, where they stand at first."""
    import numpy as np

    from umform.surfaces import write_tool

    points = problem.model.positions
    span = float(np.ptp(points, axis=0).max())
    box = points.min(axis=0) - 0.25 * span, points.max(axis=0) + 0.25 * span
    folder.mkdir(parents=True, exist_ok=True)
    for name, tool in problem.tools.items():
        typer.echo(f"Written to {write_tool(tool, folder / f'{name}.stl', box=box, chord=1e-3 * span)}")


def _show(findings: Sequence[Finding]) -> None:
    """One row per finding, the remedy in the next row."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    from umform.problem.findings import Level

    colours = {Level.OK: "green", Level.WARNING: "yellow", Level.ERROR: "red"}
    table = Table("", "about", "found", box=box.SIMPLE_HEAD)
    for finding in findings:
        text = f"{finding.text}\nremedy: {finding.remedy}" if finding.remedy else finding.text
        level = Text(finding.level.value, style=colours[finding.level])
        table.add_row(level, Text(finding.about), Text(text))
    console().print(table)
