"""Names in a deck that stand for something else in it: tools of contacts, contacts of drives, controls of steps."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from umform.deck.errors import DeckKey, shortened, slip
from umform.deck.lines import Path
from umform.deck.source import Source


def unknown_names(source: Source) -> Iterator[DeckKey]:
    """All names that stand for nothing; of tables that are malformed in another way nothing is said.

    Parameters
    ----------
    source : Source
        The deck.
    """
    for kind, name, path in references(source.data):
        known = list(_table(source.data, kind))
        if name not in known:
            yield DeckKey(
                f"there is no {kind[:-1]} of this name",
                where=source.place(path),
                value=shortened(name),
                cause=slip(name, known, "another name than those of the deck" if known else f"the deck has no {kind}"),
                remedy=f"{kind}: {', '.join(known)}" if known else f"add [{kind}.{shortened(name)}]",
            )


def references(data: dict[str, Any]) -> Iterator[tuple[str, str, Path]]:
    """Each reference: the table that it goes to, the name, and where it stands."""
    for name, contact in _table(data, "contacts").items():
        if isinstance(contact, dict) and isinstance(contact.get("tool"), str):
            yield "tools", contact["tool"], ("contacts", name, "tool")
    for name, control in _table(data, "controls").items():
        if isinstance(control, dict) and isinstance(control.get("contact"), str):
            yield "contacts", control["contact"], ("controls", name, "contact")
    steps = data.get("steps")
    for number, step in enumerate(steps if isinstance(steps, list) else []):
        if not isinstance(step, dict):
            continue
        if isinstance(step.get("to"), dict):
            for name in step["to"]:
                yield "controls", name, ("steps", number, "to", name)
        if isinstance(step.get("control"), str):
            yield "controls", step["control"], ("steps", number, "control")


def _table(data: dict[str, Any], key: str) -> dict[str, Any]:
    table = data.get(key)
    return table if isinstance(table, dict) else {}
