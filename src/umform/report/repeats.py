"""Warnings that come again and again are shown once, with their number."""

from __future__ import annotations

import re
from collections.abc import Iterable

#: Where in a run a warning was given; what follows is what it says.
_PLACE = re.compile(r"^(step \d+, time [^:]*): ")


def counted(warnings: Iterable[str]) -> list[str]:
    """Warnings in the order in which they came first, those that differ only in their step and time as one.

    Parameters
    ----------
    warnings : iterable of str
        Warnings of a run.

    Returns
    -------
    list of str
        Each warning once; one that came more often says how often, and where first and last.
    """
    groups: dict[str, list[str]] = {}
    for warning in warnings:
        groups.setdefault(without_place(warning), []).append(warning)
    return [_line(text, group) for text, group in groups.items()]


def without_place(warning: str) -> str:
    """What a warning says, without the step and time at which it was given."""
    return _PLACE.sub("", warning)


def _line(text: str, group: list[str]) -> str:
    if len(group) == 1:
        return group[0]
    first, last = _PLACE.match(group[0]), _PLACE.match(group[-1])
    span = f", first at {first[1]}, last at {last[1]}" if first and last else ""
    return f"{text} ({len(group)} times{span})"
