"""What a look at a problem finds: how bad it is, about what, in which words."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Level(Enum):
    """How bad a finding is."""

    OK = "ok"
    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True)
class Finding:
    """One row of the table of ``umform check``.

    Attributes
    ----------
    level : Level
        How bad it is.
    about : str
        What was looked at: a contact, the element, the units.
    text : str
        What was found.
    remedy : str
        What to do about it.
    """

    level: Level
    about: str
    text: str
    remedy: str = ""


def ok(about: str, text: str) -> Finding:
    """Nothing to do."""
    return Finding(Level.OK, about, text)


def warning(about: str, text: str, remedy: str) -> Finding:
    """Look at it once more."""
    return Finding(Level.WARNING, about, text, remedy)


def error(about: str, text: str, remedy: str) -> Finding:
    """It cannot be solved."""
    return Finding(Level.ERROR, about, text, remedy)
