"""Statistics of earlier increments that select the first strategy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from umform.results.records import Cause

#: Largest number of increments for which a failing extrapolation is skipped.
_LONGEST_REST = 15
#: Failures after which an increment may exceed the allowed penetration.
_YIELDING = 3
#: Largest number of cuts for which failing softer penalties are skipped.
_LONGEST_SOFT_REST = 3


@dataclass
class StrategyStatistics:
    """Whether an increment begins with the extrapolation of the last one, and whether softer penalties are tried.

    If the extrapolation fails and another start converges, the next increment skips it; if it fails again then, the
    next three, seven, fifteen do. If softer penalties fail, the next failed increment is cut without them; if they fail
    again then, the next three are.

    Attributes
    ----------
    misses : int
        Successive failures of the extrapolation.
    rest : int
        Increments that will skip it.
    stable : bool
        Whether the last equilibrium had no negative pivots, as far as the solver reports them. If so, an indefinite
        tangent far from the next one indicates a bad increment.
    soft_misses : int
        Successive failures of softer penalties while a tool held the sheet.
    soft_rest : int
        Failed increments that will be cut without them.
    failures : int
        Increments that failed, less those that kept the allowed penetration since; zero to three.
    last : bool
        Whether the next increment will not be cut: beyond it lies a limit point, and a jump to the next stable state is
        accepted however far it is. eq. (5.102)
    """

    misses: int = 0
    rest: int = 0
    stable: bool = True
    soft_misses: int = 0
    soft_rest: int = 0
    failures: int = 0
    last: bool = False

    @property
    def extrapolates(self) -> bool:
        """Whether the next increment may begin with the extrapolation."""
        return self.rest == 0

    @property
    def softens(self) -> bool:
        """Whether softer penalties may be tried before the next cut."""
        return self.soft_rest == 0

    @property
    def yields(self) -> bool:
        """Whether the next increment may exceed the allowed penetration, rather than fail."""
        return self.last or self.failures >= _YIELDING

    def record(self, failed: Mapping[str, Cause], won: str, negative_pivots: int | None) -> None:
        """Record an increment: the strategies that failed and why, the one that converged, the pivots at the end."""
        self.stable, self.last = not negative_pivots, False
        if won == "extrapolation":
            self.misses = 0
        elif "extrapolation" in failed:
            self.misses += 1
            self.rest = min(2**self.misses - 1, _LONGEST_REST)
        elif self.rest:
            self.rest -= 1
        if won == "softer penalties":
            self.soft_misses = 0

    def record_cut(self, failed: Mapping[str, Cause]) -> None:
        """Record an increment in which all strategies failed."""
        cause = failed.get("softer penalties")
        if cause is None:
            self.soft_rest = max(self.soft_rest - 1, 0)
        elif cause is not Cause.SINGULAR:  # near loss of contact cuts do not help, but softer penalties may
            self.soft_misses += 1
            self.soft_rest = min(2**self.soft_misses - 1, _LONGEST_SOFT_REST)

    def count_penetration(self, *, kept: bool) -> None:
        """Count an increment that kept the allowed penetration, or one that failed."""
        self.failures = max(self.failures - 1, 0) if kept else min(self.failures + 1, _YIELDING)

    def begin_last_attempt(self) -> None:
        """Try softer penalties, and a jump, in an increment that will not be cut."""
        self.soft_rest, self.last = 0, True
