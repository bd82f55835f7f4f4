"""Plausibility of the sheet of a process before its runs."""

from __future__ import annotations

from typing import Any

from umform.cli.root import say


def refuse_implausible(*cases: Any, force: bool | None = None) -> None:
    """Refuse numbers that are certainly wrong, and warn of unusual ones.

    Parameters
    ----------
    *cases : Spec
        Parameters of processes.
    force : bool, optional
        Warn only; None where no option --force does it.

    Raises
    ------
    DeckError
        With what to change.
    """
    from umform.processes.plausible import accepted

    for warning in dict.fromkeys(text for case in cases for text in accepted(case, force=force)):
        say(warning)
