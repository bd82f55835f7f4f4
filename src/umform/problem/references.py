"""References within a deck: names of tools, contacts, controls and supports."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from umform.problem.errors import DeckKey, shortened, slip
from umform.problem.lines import Path
from umform.problem.source import Source


def unknown_names(source: Source) -> Iterator[DeckKey]:
    """All names without a target; malformed tables are ignored.

    Parameters
    ----------
    source : Source
        The deck.
    """
    for kind, name, path in references(source.data):
        known = _names(source.data, kind)
        if name not in known:
            yield DeckKey(
                f"there is no {kind[:-1]} of this name",
                where=source.place(path),
                value=shortened(name),
                cause=slip(name, known, "another name than those of the deck" if known else f"the deck has no {kind}"),
                remedy=f"{kind}: {', '.join(known)}" if known else _how_to_add(kind, shortened(name)),
            )


def references(data: dict[str, Any]) -> Iterator[tuple[str, str, Path]]:
    """Each reference: its target table, the name, and its place."""
    for name, contact in _table(data, "contacts").items():
        if isinstance(contact, dict) and isinstance(contact.get("tool"), str):
            yield "tools", contact["tool"], ("contacts", name, "tool")
    for kind in ("beads", "controls"):
        for name, part in _table(data, kind).items():
            if isinstance(part, dict) and isinstance(part.get("contact"), str):
                yield "contacts", part["contact"], (kind, name, "contact")
            if isinstance(part, dict):
                if isinstance(other := _table(part, "gap").get("to"), str):
                    yield "contacts", other, (kind, name, "gap", "to")
                yield from _listed(part, "followers", "contacts", (kind, name))
    for name, measure in _table(data, "measures").items():
        for key in ("tool", "control"):
            if isinstance(measure, dict) and isinstance(measure.get(key), str):
                yield f"{key}s", measure[key], ("measures", name, key)
    steps = data.get("steps")
    for number, step in enumerate(steps if isinstance(steps, list) else []):
        if not isinstance(step, dict):
            continue
        for key in ("to", "follow"):
            for name in _table(step, key):
                yield "controls", name, ("steps", number, key, name)
        if isinstance(step.get("control"), str):
            yield "controls", step["control"], ("steps", number, "control")
        for key in ("support", "on"):
            if isinstance(step.get(key), str):
                yield "supports", step[key], ("steps", number, key)
        yield from _listed(step, "contacts", "contacts", ("steps", number))


def _listed(part: dict[str, Any], key: str, kind: str, path: Path) -> Iterator[tuple[str, str, Path]]:
    """References in an array of names."""
    names = part.get(key)
    for number, name in enumerate(names if isinstance(names, list) else []):
        if isinstance(name, str):
            yield kind, name, (*path, key, number)


def _names(data: dict[str, Any], kind: str) -> list[str]:
    """The names of the objects of a kind; supports are a list, and some of them have a name."""
    if kind != "supports":
        more = [name] if kind == "controls" and isinstance(name := _table(data, "before").get("control"), str) else []
        return [*_table(data, kind), *more]
    supports = data.get(kind)
    named = [part.get("name") for part in supports if isinstance(part, dict)] if isinstance(supports, list) else []
    return [name for name in named if isinstance(name, str)]


def _how_to_add(kind: str, name: str) -> str:
    return f'name = "{name}" in one of the [[supports]]' if kind == "supports" else f"add [{kind}.{name}]"


def _table(data: dict[str, Any], key: str) -> dict[str, Any]:
    table = data.get(key)
    return table if isinstance(table, dict) else {}
