"""Checks: a number against its reference, and the verdict that follows from these numbers alone."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum

from umform_book.printed import bounded


class Verdict(IntEnum):
    """Verdict of a check or a page, best first.

    Green: within what is expected. Expected: a failure that the theory of the element predicts. Amber: a miss with a
    known size and cause. Red: a miss without one.
    """

    GREEN = 0
    EXPECTED = 1
    AMBER = 2
    RED = 3

    @property
    def mark(self) -> str:
        """The verdict as it stands in a table."""
        return ("🟢 green", "⚪ expected failure", "🟠 amber", "🔴 red")[self]


@dataclass(frozen=True)
class Check:
    """A number against its reference.

    Parameters
    ----------
    what : str
        What was measured, on which element and mesh.
    found, reference : float
        The number and its reference.
    within : float
        Largest deviation that passes.
    relative : bool
        Whether the deviation is relative to the reference.
    known : float
        Largest deviation that is known and explained by ``cause``; beyond it the check is red.
    cause : str
        Why it deviates more than ``within``.
    theory : str
        Source that predicts the miss for this element: the failure is then expected, and a pass is amber.
    """

    what: str
    found: float
    reference: float
    within: float
    relative: bool = True
    known: float = 0.0
    cause: str = ""
    theory: str = ""

    def __post_init__(self) -> None:
        if self.relative and self.reference == 0.0:
            raise ValueError(f"{self.what}: nothing is relative to zero, say relative=False")
        if bool(self.cause) != (self.known > 0.0):
            raise ValueError(f"{self.what}: a known deviation has a cause, and a cause a known deviation")
        if self.theory and not self.cause:
            raise ValueError(f"{self.what}: an expected failure has a cause and a known deviation")

    @property
    def deviation(self) -> float:
        """Found minus reference, relative if ``relative`` is set."""
        difference = self.found - self.reference
        return difference / abs(self.reference) if self.relative else difference

    @property
    def passes(self) -> bool:
        """Whether the deviation is within what is expected of a sound element."""
        return abs(self.deviation) <= self.within

    @property
    def verdict(self) -> Verdict:
        """The verdict; NaN is red."""
        size = abs(self.deviation)
        if not math.isfinite(size):
            return Verdict.RED
        if size <= self.within:
            return Verdict.AMBER if self.theory else Verdict.GREEN
        if size > self.known:
            return Verdict.RED
        return Verdict.EXPECTED if self.theory else Verdict.AMBER

    @property
    def note(self) -> str:
        """Why the check is not green; empty if it is, or if the cause is unknown."""
        if self.verdict in (Verdict.GREEN, Verdict.RED):
            return ""
        if not self.theory:
            return self.cause
        return f"passes, but theory predicts a failure: {self._reason}" if self.passes else self._reason

    @property
    def _reason(self) -> str:
        return f"{self.cause} ({self.theory})"

    @property
    def share(self) -> float:
        """Deviation over the largest one that passes; 0 at round-off, infinite for a miss of what must be exact."""
        if not self.relative and bounded(self.deviation, self.within):
            return 0.0
        size = abs(self.deviation)
        if self.within > 0.0:
            return size / self.within
        return math.inf if size else 0.0

    @property
    def miss(self) -> str:
        """The deviation as it is printed."""
        if self.relative:
            return f"{round(100 * self.deviation, 2) + 0.0:+.2f} %"  # no minus before a zero
        sign = "+" if self.reference else ""
        return bounded(self.deviation, self.within) or f"{self.deviation + 0.0:{sign}.4g}"

    @property
    def limit(self) -> str:
        """The largest deviation that passes as it is printed."""
        return f"{100 * self.within:.4g} %" if self.relative else f"{self.within:.4g}"

    def cells(self) -> tuple[str, ...]:
        """The cells of the table of checks: what, reference, found, deviation, limit, verdict."""
        if self.reference == 0.0:  # found and deviation are the same
            found, deviation = self.miss, "-"
        else:
            found, deviation = f"{self.found:.6g}", self.miss
        return self.what, f"{self.reference:.6g}", found, deviation, self.limit, self.verdict.mark
