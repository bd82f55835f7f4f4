"""Decks: one TOML file that describes a problem; read, checked, built, run.

``load("deck.toml").build().solve()`` does all of it; ``umform check`` and ``umform run`` do it on the command line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

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

# The command line starts quickly.
__getattr__ = at_first_use(__name__, _HOME)
