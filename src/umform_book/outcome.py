"""What the run of a case leaves for the pages of all cases."""

from __future__ import annotations

from dataclasses import dataclass

from umform_book.balance import BalanceRow
from umform_book.checks import Check, Verdict
from umform_book.page import StudyRecord


@dataclass(frozen=True)
class Outcome:
    """What a page leaves once it is written; can be sent between processes.

    Attributes
    ----------
    name : str
        The case.
    verdict : Verdict
        Its verdict.
    checks : tuple of Check
        Its checks.
    balances : tuple of BalanceRow
        Balance of each nonlinear run.
    studies : tuple of StudyRecord
        Numbers of each element on each mesh.
    seconds : float
        Wall time of the run.
    failure : str
        Why the run failed; empty if it did not.
    """

    name: str
    verdict: Verdict
    checks: tuple[Check, ...] = ()
    balances: tuple[BalanceRow, ...] = ()
    studies: tuple[StudyRecord, ...] = ()
    seconds: float = 0.0
    failure: str = ""
