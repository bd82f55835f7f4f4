"""What earlier increments have taught the next one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from umform.solution.records import Cause

#: An extrapolation that goes too far again and again is left out for so many increments at most.
_LONGEST_REST = 15
#: Softer penalties that lead nowhere again and again are left out for so many cuts at most.
_LONGEST_SOFT_REST = 3


@dataclass
class Habits:
    """Whether an increment begins with the extrapolation of the last one, and whether softer penalties are worth it.

    Where the extrapolation has gone too far and another start has won, it is left out in the next increment; if it
    fails again then, in the next three, seven, fifteen. Where softer penalties have led nowhere, the next increment
    that fails is cut without them; if they fail again then, the next three are.

    Attributes
    ----------
    misses : int
        Extrapolations in a row that went too far.
    rest : int
        Increments that do without.
    stable : bool
        Whether the last equilibrium had no negative pivots, as far as the solver knows. If so, an indefinite tangent
        far from the next one is a sign of an increment that leads astray.
    soft_misses : int
        Softer penalties in a row that led nowhere, while a tool held the sheet.
    soft_rest : int
        Increments that are cut without them.
    """

    misses: int = 0
    rest: int = 0
    stable: bool = True
    soft_misses: int = 0
    soft_rest: int = 0

    @property
    def extrapolates(self) -> bool:
        """Whether the next increment may begin with it."""
        return self.rest == 0

    @property
    def softens(self) -> bool:
        """Whether softer penalties may be tried before the next cut."""
        return self.soft_rest == 0

    def learn(self, failed: Mapping[str, Cause], won: str, negative_pivots: int | None) -> None:
        """Learn from an increment: the strategies that failed and why, the one that won, the pivots at the end."""
        self.stable = not negative_pivots
        if won == "extrapolation":
            self.misses = 0
        elif "extrapolation" in failed:
            self.misses += 1
            self.rest = min(2**self.misses - 1, _LONGEST_REST)
        elif self.rest:
            self.rest -= 1
        if won == "softer penalties":
            self.soft_misses = 0

    def learn_of_cut(self, failed: Mapping[str, Cause]) -> None:
        """Learn from an increment that all strategies failed in."""
        cause = failed.get("softer penalties")
        if cause is None:
            self.soft_rest = max(self.soft_rest - 1, 0)
        elif cause is not Cause.SINGULAR:  # near lift-off cuts do not help, and softer penalties may
            self.soft_misses += 1
            self.soft_rest = min(2**self.soft_misses - 1, _LONGEST_SOFT_REST)

    def last_chance(self) -> None:
        """Have softer penalties tried in an increment that will not be cut."""
        self.soft_rest = 0
