"""Decks on the page: templates, schema, and the check in a separate process with a time limit."""

from __future__ import annotations

import tempfile
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from umform.bench.jobs import LONGEST_DECK
from umform.bench.subprocess_json import NoAnswer, json_of_module
from umform.errors import InvalidValue
from umform.problem import templates

#: Seconds that a check may take.
_LONGEST_CHECK = 60.0


def known_templates() -> list[dict[str, str]]:
    """Names and titles of the decks to start from."""
    return [{"name": name, "title": title} for name, title in templates.templates().items()]


@cache
def schema_text() -> str:
    """The JSON schema of decks."""
    from umform.problem.contents import json_schema

    return json_schema()


def title_of(text: str) -> str:
    """The title of a deck, which may be invalid."""
    try:
        title = tomllib.loads(text[:LONGEST_DECK]).get("title")
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        title = None
    return str(title)[:80] if title else "deck"


def checked_deck(text: str, folder: Path) -> dict[str, Any]:
    """What `umform check` finds in a deck.

    Parameters
    ----------
    text : str
        The deck.
    folder : Path
        Folder of the files that it names.

    Returns
    -------
    dict
        ``findings``: level, about, text, remedy of each.
    """
    if len(text) > LONGEST_DECK:
        raise InvalidValue(f"a deck has at most {LONGEST_DECK} letters here", where="deck", remedy="umform check")
    with tempfile.TemporaryDirectory(prefix="umform-bench-") as place:
        path = Path(place) / "deck.toml"
        path.write_text(text, encoding="utf-8")
        try:
            arguments = ["umform.bench.check_deck", str(path), str(folder)]
            findings = json_of_module(arguments, _LONGEST_CHECK, "the check")
        except NoAnswer as error:
            text = "; ".join(part for part in (error.what, error.cause) if part)
            findings = [{"level": "error", "about": "check", "text": text, "remedy": error.remedy}]
    return {"findings": findings}
