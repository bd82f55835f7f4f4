"""Results of a case for the pages of all cases."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from umform_book.checks import Check, Verdict
from umform_book.page import Comparison, StudyRecord


@dataclass(frozen=True)
class CheckRecord:
    """A check as its page prints it.

    Attributes
    ----------
    what, reference, found, deviation, limit : str
        Its row in the table of checks.
    verdict : Verdict
        Its verdict.
    share : float
        Deviation over the largest one that passes, in four digits; infinite for a miss of what must be exact.
    note : str
        Why it is not green.
    """

    what: str
    reference: str
    found: str
    deviation: str
    limit: str
    verdict: Verdict
    share: float
    note: str = ""

    @classmethod
    def of(cls, check: Check) -> CheckRecord:
        """The record of a check."""
        share = float(f"{round(check.share, 4):.4g}") if math.isfinite(check.share) else math.inf
        what, reference, found, deviation, limit, _ = check.cells()
        return cls(what, reference, found, deviation, limit, check.verdict, share, check.note)

    @property
    def miss(self) -> str:
        """The deviation as it is printed: from zero, the number itself."""
        return self.found if self.deviation == "-" else self.deviation


@dataclass(frozen=True)
class Outcome:
    """Results of a page; can be sent between processes.

    Attributes
    ----------
    name : str
        The case.
    verdict : Verdict
        Its verdict.
    checks : tuple of CheckRecord
        Its checks.
    balance : dict of str to str, optional
        The worst balance of its nonlinear runs, by column of the page of all balances.
    studies : tuple of StudyRecord
        Numbers of each element on each mesh.
    comparisons : tuple of Comparison
        Its numbers beside measurements.
    failure : str
        Why the run failed; empty if it did not.
    versions : str
        Software that made it.
    seconds : float
        Wall time of the run; not stored.
    """

    name: str
    verdict: Verdict
    checks: tuple[CheckRecord, ...] = ()
    balance: Mapping[str, str] | None = None
    studies: tuple[StudyRecord, ...] = ()
    comparisons: tuple[Comparison, ...] = ()
    failure: str = ""
    versions: str = ""
    seconds: float = 0.0
