"""Public names of the release before that are gone, and what they are now called: each has an error for one release."""

from __future__ import annotations

#: Old name: new name, and how a call changes.
RENAMED = {
    "Term": ("Mode", "modes=(Mode(...), Mode(...) + Mode(...)) in place of tuples of terms"),
}


def message(name: str) -> str:
    """What the error for an old name says; empty for others."""
    if name not in RENAMED:
        return ""
    new, remedy = RENAMED[name]
    return f"umform.{name} is now called umform.{new}: {remedy}"
