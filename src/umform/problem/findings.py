"""Findings of a check: severity, subject, text."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum

from umform.errors import InvalidValue
from umform.problem.errors import DeckError


class Implausible(InvalidValue):
    """Numbers that are certainly wrong: inconsistent units, a tool deep in the sheet."""

    id = "check"


class Level(Enum):
    """Severity of a finding."""

    OK = "ok"
    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True)
class Finding:
    """One row of the table of ``umform check``.

    Attributes
    ----------
    level : Level
        Severity.
    about : str
        Subject of the check: a contact, the element, the units.
    text : str
        Finding.
    remedy : str
        Remedy.
    cause : str
        Likely cause of an error.
    """

    level: Level
    about: str
    text: str
    remedy: str = ""
    cause: str = "another unit, or a typing error"


def ok(about: str, text: str) -> Finding:
    """Nothing to do."""
    return Finding(Level.OK, about, text)


def warning(about: str, text: str, remedy: str) -> Finding:
    """Unusual: check it."""
    return Finding(Level.WARNING, about, text, remedy)


def error(about: str, text: str, remedy: str) -> Finding:
    """It cannot be solved, or is certainly wrong."""
    return Finding(Level.ERROR, about, text, remedy)


def accept(findings: Iterable[Finding], *, force: bool | None = None) -> list[str]:
    """Warnings of findings, as text; errors among them are raised.

    Parameters
    ----------
    findings : iterable of Finding
        Findings of a check.
    force : bool, optional
        Treat errors as warnings; None where no option --force does it.

    Returns
    -------
    list of str
        One line a warning.

    Raises
    ------
    DeckError
        With all errors among the findings.
    """
    found = [finding for finding in findings if finding.level is not Level.OK]
    errors = [finding for finding in found if finding.level is Level.ERROR]
    overruled = "" if force is None else "; --force runs it all the same"
    if errors and not force:
        raise DeckError(
            Implausible(
                finding.text,
                where=finding.about,
                cause=finding.cause,
                remedy=f"{finding.remedy}{overruled}",
            )
            for finding in errors
        )
    return [f"{finding.about}: {finding.text}; remedy: {finding.remedy}" for finding in found]
