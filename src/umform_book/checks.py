"""Checks: a number that was found against what it should be, and the verdict that follows from it and nothing else."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum


class Verdict(IntEnum):
    """Green: as it should be. Amber: known to miss, by no more than is known, with the cause. Red: it misses."""

    GREEN = 0
    AMBER = 1
    RED = 2

    @property
    def mark(self) -> str:
        """The verdict as it stands in a table."""
        return ("🟢 green", "🟠 amber", "🔴 red")[self]


@dataclass(frozen=True)
class Check:
    """A number against its reference.

    Parameters
    ----------
    what : str
        What was measured, on which element and mesh.
    found, reference : float
        The number and what it should be.
    within : float
        Deviation that is expected of this element on this mesh.
    relative : bool
        Whether the deviation is relative to the reference.
    known : float
        Largest deviation that is known and explained by ``cause``; beyond it the check is red.
    cause : str
        Why it deviates more than expected.
    """

    what: str
    found: float
    reference: float
    within: float
    relative: bool = True
    known: float = 0.0
    cause: str = ""

    def __post_init__(self) -> None:
        if self.relative and self.reference == 0.0:
            raise ValueError(f"{self.what}: nothing is relative to zero, say relative=False")
        if bool(self.cause) != (self.known > 0.0):
            raise ValueError(f"{self.what}: a known deviation has a cause, and a cause a known deviation")

    @property
    def deviation(self) -> float:
        """Found minus reference, relative if so wanted."""
        difference = self.found - self.reference
        return difference / abs(self.reference) if self.relative else difference

    @property
    def verdict(self) -> Verdict:
        """The verdict; what is not a number is red."""
        size = abs(self.deviation)
        if not math.isfinite(size):
            return Verdict.RED
        if size <= self.within:
            return Verdict.GREEN
        return Verdict.AMBER if size <= self.known else Verdict.RED

    def cells(self) -> tuple[str, ...]:
        """What stands in the table of checks: what, reference, found, deviation, expected, verdict."""
        percent = round(100 * self.deviation, 2) + 0.0  # no minus before a zero
        deviation = f"{percent:+.2f} %" if self.relative else f"{self.deviation:+.2e}"
        expected = f"{100 * self.within:g} %" if self.relative else f"{self.within:.1e}"
        verdict = self.verdict.mark + (f": {self.cause}" if self.verdict is Verdict.AMBER else "")
        return self.what, f"{self.reference:.6g}", f"{self.found:.6g}", deviation, expected, verdict
