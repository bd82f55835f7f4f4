"""What becomes of the attempts of a run: which strategy was tried, which one won, and what was given up.

>>> attempts = Attempts()
>>> with attempts.trying("tangent"):
...     attempts.evaluations += 5
>>> attempts.share
0.0
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager


class Attempts:
    """Counts of a run.

    Attributes
    ----------
    evaluations : int
        Of residuals, with a tangent or without.
    thrown : int
        Those of attempts that were given up.
    tried, won : Counter of str
        How often each strategy was tried, and led to the equilibrium that was taken.
    causes : Counter of str
        Why attempts were given up.
    staged : int
        Points of the material, over all evaluations, whose return map went through stages of a shrinking yield surface.
    """

    def __init__(self) -> None:
        self.evaluations = self.thrown = self.staged = 0
        self.tried: Counter[str] = Counter()
        self.won: Counter[str] = Counter()
        self.causes: Counter[str] = Counter()

    @property
    def share(self) -> float:
        """Share of the evaluations that was thrown away."""
        return self.thrown / self.evaluations if self.evaluations else 0.0

    @contextmanager
    def trying(self, strategy: str) -> Iterator[None]:
        """Count an attempt; what is evaluated inside is thrown away if it ends with an exception."""
        mark = self.mark()
        self.tried[strategy] += 1
        try:
            yield
        except BaseException:
            self._throw(mark)
            raise
        self.won[strategy] += 1

    def mark(self) -> tuple[int, int]:
        """Where the counts stand before an increment, for :meth:`take_back`."""
        return self.evaluations, self.thrown

    def take_back(self, mark: tuple[int, int], cause: str) -> None:
        """Count all that came since a mark as thrown away: an increment that had converged is not taken."""
        self._throw(mark)
        self.causes[cause] += 1

    def _throw(self, mark: tuple[int, int]) -> None:
        evaluations, thrown = mark
        self.thrown = thrown + self.evaluations - evaluations

    def add(self, other: Attempts) -> None:
        """Add the counts of another run."""
        self.evaluations += other.evaluations
        self.thrown += other.thrown
        self.staged += other.staged
        self.tried.update(other.tried)
        self.won.update(other.won)
        self.causes.update(other.causes)

    def rows(self) -> list[tuple[str, int, int]]:
        """Each strategy that was tried: name, how often, and how often it won."""
        return [(name, tried, self.won[name]) for name, tried in self.tried.items()]

    def record(self) -> dict[str, object]:
        """All counts, for JSON and checkpoints."""
        counts = {name: dict(getattr(self, name)) for name in ("tried", "won", "causes")}
        return {"evaluations": self.evaluations, "thrown": self.thrown, "staged": self.staged, **counts}
