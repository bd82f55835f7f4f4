"""Decks: one TOML file that describes a problem; read, checked, built, run.

``load("deck.toml").build().solve()`` does all of it; ``umform check`` and ``umform run`` do it on the command line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.problem.contents import Contents
    from umform.problem.errors import DeckError
    from umform.problem.prepared import Prepared
    from umform.problem.problem import Problem, load

__all__ = ["Contents", "DeckError", "Prepared", "Problem", "load"]

_HOME = {
    "Contents": "contents",
    "Problem": "problem",
    "DeckError": "errors",
    "Prepared": "prepared",
    "load": "problem",
}

# The command line starts quickly.
__getattr__ = at_first_use(__name__, _HOME)
