"""What earlier increments have taught the next one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

#: An extrapolation that goes too far again and again is left out for so many increments at most.
_LONGEST_REST = 15


@dataclass
class Habits:
    """Whether an increment begins with the extrapolation of the last one.

    Where the extrapolation has gone too far and another start has won, it is left out in the next increment; if it
    fails again then, in the next three, seven, fifteen.

    Attributes
    ----------
    misses : int
        Extrapolations in a row that went too far.
    rest : int
        Increments that do without.
    stable : bool
        Whether the last equilibrium had no negative pivots, as far as the solver knows. If so, an indefinite tangent
        far from the next one is a sign of an increment that leads astray.
    """

    misses: int = 0
    rest: int = 0
    stable: bool = True

    @property
    def extrapolates(self) -> bool:
        """Whether the next increment may begin with it."""
        return self.rest == 0

    def learn(self, failed: Sequence[str], won: str, negative_pivots: int | None) -> None:
        """Learn from an increment: the strategies that failed, the one that won, the pivots at the end."""
        self.stable = not negative_pivots
        if won == "extrapolation":
            self.misses = 0
        elif "extrapolation" in failed:
            self.misses += 1
            self.rest = min(2**self.misses - 1, _LONGEST_REST)
        elif self.rest:
            self.rest -= 1
