"""A case of the book, and a chapter of cases."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Case:
    """A problem with a known answer.

    Attributes
    ----------
    name : str
        Its name on the command line and of its page: small letters and hyphens.
    title : str
        Heading of the page.
    problem : str
        What is computed: geometry, material, supports, loads, units (Markdown).
    reference : str
        Where the reference comes from, with its citation and its own uncertainty (Markdown).
    run : callable
        Computes, and enters into a :class:`umform_book.page.Page` what came out.
    cost : float
        Approximate seconds of the whole case on one core; the longest cases start first.
    own : str
        The part of the reference that umform itself computed; empty if none.
    picture : str
        Name of the picture that stands first on the page; default: the first one.
    """

    name: str
    title: str
    problem: str
    reference: str
    run: Callable[[Any], None]
    cost: float = 10.0
    own: str = ""
    picture: str = ""


@dataclass(frozen=True)
class Chapter:
    """Cases that belong together."""

    title: str
    about: str
    cases: tuple[Case, ...]
