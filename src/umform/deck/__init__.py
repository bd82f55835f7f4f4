"""Decks: one TOML file that describes a problem; read, checked, built, run.

``load("deck.toml").build().solve()`` does all of it; ``umform check`` and ``umform run`` do it on the command line.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from umform.deck.contents import Contents
    from umform.deck.deck import Deck, load
    from umform.deck.errors import DeckError
    from umform.deck.problem import Problem
    from umform.deck.templates import deck_of

__all__ = ["Contents", "Deck", "DeckError", "Problem", "deck_of", "load"]

_HOME = {
    "Contents": "contents",
    "Deck": "deck",
    "DeckError": "errors",
    "Problem": "problem",
    "deck_of": "templates",
    "load": "deck",
}


def __getattr__(name: str) -> object:
    """Import a name when it is first used, so that the command line starts quickly."""
    if name not in _HOME:
        raise AttributeError(f"module 'umform.deck' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"umform.deck.{_HOME[name]}"), name)
    globals()[name] = value
    return value
