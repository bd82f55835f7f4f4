"""Show repeated warnings once, with their number."""

from __future__ import annotations

import re
from collections.abc import Iterable

#: Step and time at the beginning of a warning; the rest is its text.
_PLACE = re.compile(r"^(step \d+, time [^:]*): ")


def counted(warnings: Iterable[str]) -> list[str]:
    """Warnings in the order of their first occurrence; those that differ only in step and time are merged.

    Parameters
    ----------
    warnings : iterable of str
        Warnings of a run.

    Returns
    -------
    list of str
        Each warning once; a repeated one has its number, and its first and last occurrence.
    """
    groups: dict[str, list[str]] = {}
    for warning in warnings:
        groups.setdefault(without_place(warning), []).append(warning)
    return [_line(text, group) for text, group in groups.items()]


def without_place(warning: str) -> str:
    """Text of a warning, without its step and time."""
    return _PLACE.sub("", warning)


def _line(text: str, group: list[str]) -> str:
    if len(group) == 1:
        return group[0]
    first, last = _PLACE.match(group[0]), _PLACE.match(group[-1])
    span = f", first at {first[1]}, last at {last[1]}" if first and last else ""
    return f"{text} ({len(group)} times{span})"
