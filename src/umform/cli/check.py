"""``umform check``: check a deck without solving it."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from umform.cli.root import Debug, Verbose, app, console, say_of
from umform.errors import InvalidValue, UmformError

if TYPE_CHECKING:
    from umform.deck import Deck
    from umform.deck.findings import Finding

DeckFile = Annotated[Path, typer.Argument(metavar="DECK", help="Deck, a TOML file.")]
Changes = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Set a key of the deck, such as steps.0.increments=5; repeatable."),
]

#: A word, such as the name of an element; a number with a decimal comma.
_WORD, _DECIMAL_COMMA = re.compile(r"[^\W\d][\w.-]*"), re.compile(r"[-+]?\d*,\d+")

Force = Annotated[bool, typer.Option("--force", help="Run despite implausible numbers: these errors become warnings.")]


@app.command("check")
def check_deck(deck: DeckFile, changes: Changes = None, verbose: Verbose = 0, debug: Debug = False) -> None:
    """Check a deck without solving it: keys, names, gaps, supports, element sizes, units, effort.

    An error ends with exit code 1; warnings do not.
    """
    from umform.deck.check import check
    from umform.deck.findings import Level

    with deck_errors():
        loaded = read(deck, changes or ())
        problem = loaded.build()
        findings = list(check(loaded, problem))
    _show(findings)
    if any(finding.level is Level.ERROR for finding in findings):
        raise typer.Exit(1)


def read(path: Path, changes: Sequence[str]) -> Deck:
    """The deck of a file with some changed values."""
    from umform.deck import load

    return load(path, dict(_change(text) for text in changes))


@contextmanager
def deck_errors() -> Iterator[None]:
    """Print the mistakes in a deck in terms of its keys, and exit with code 1."""
    try:
        yield
    except UmformError as error:
        say_of(error)
        raise typer.Exit(1) from error


def _change(text: str) -> tuple[str, Any]:
    key, _, value = text.partition("=")
    try:
        return key.strip(), tomllib.loads(f"value = {value}")["value"]
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


def _show(findings: Sequence[Finding]) -> None:
    """One row per finding, the remedy in the next row."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    from umform.deck.findings import Level

    colours = {Level.OK: "green", Level.WARNING: "yellow", Level.ERROR: "red"}
    table = Table("", "about", "found", box=box.SIMPLE_HEAD)
    for finding in findings:
        text = f"{finding.text}\nremedy: {finding.remedy}" if finding.remedy else finding.text
        level = Text(finding.level.value, style=colours[finding.level])
        table.add_row(level, Text(finding.about), Text(text))
    console().print(table)
