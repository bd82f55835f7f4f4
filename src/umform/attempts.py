"""Statistics of the attempts of a run: strategies tried and successful, discarded evaluations.

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

#: Judgement of failed attempts.
HARMLESS = "An attempt that fails is repeated in another way: it costs time, the results are those of accepted ones."


class Attempts:
    """Counts of a run.

    Attributes
    ----------
    evaluations : int
        Evaluations of the residual, with or without a tangent.
    accepted : int
        Those that were iterations of accepted increments; the rest are line searches, passes of multipliers and
        penalties, starts, and discarded attempts.
    discarded : int
        Evaluations in discarded attempts.
    tried, won : Counter of str
        How often each strategy was tried, and succeeded.
    causes : Counter of str
        Causes of failed attempts.
    staged : int
        Material points, over all evaluations, whose return map used stages of a shrinking yield surface.
    """

    def __init__(self) -> None:
        self.evaluations = self.accepted = self.discarded = self.staged = 0
        self.tried: Counter[str] = Counter()
        self.won: Counter[str] = Counter()
        self.causes: Counter[str] = Counter()

    @property
    def share(self) -> float:
        """Fraction of discarded evaluations."""
        return self.discarded / self.evaluations if self.evaluations else 0.0

    @property
    def beside(self) -> float:
        """Fraction of evaluations that are no iterations of accepted increments."""
        return 1.0 - self.accepted / self.evaluations if self.evaluations else 0.0

    @property
    def summary(self) -> str:
        """Both fractions as text."""
        text = f"{self.evaluations} evaluations, {self.beside:.1%} beside the iterations of accepted increments"
        return f"{text} (line searches, repeats), {self.share:.1%} discarded".replace("%", " %")

    @contextmanager
    def trying(self, strategy: str) -> Iterator[None]:
        """Count an attempt; its evaluations are discarded if it ends with an exception."""
        mark = self.mark()
        self.tried[strategy] += 1
        try:
            yield
        except BaseException:
            self._discard(mark)
            raise
        self.won[strategy] += 1

    def mark(self) -> tuple[int, int]:
        """The counts before an increment, for :meth:`take_back`."""
        return self.evaluations, self.discarded

    def take_back(self, mark: tuple[int, int], cause: str) -> None:
        """Count all evaluations since a mark as discarded: a converged increment is not accepted."""
        self._discard(mark)
        self.causes[cause] += 1

    def _discard(self, mark: tuple[int, int]) -> None:
        evaluations, discarded = mark
        self.discarded = discarded + self.evaluations - evaluations

    def add(self, other: Attempts) -> None:
        """Add the counts of another run."""
        self.evaluations += other.evaluations
        self.accepted += other.accepted
        self.discarded += other.discarded
        self.staged += other.staged
        self.tried.update(other.tried)
        self.won.update(other.won)
        self.causes.update(other.causes)

    def rows(self) -> list[tuple[str, int, int]]:
        """Each tried strategy: name, number of trials, number of successes."""
        return [(name, tried, self.won[name]) for name, tried in self.tried.items()]

    def record(self) -> dict[str, object]:
        """All counts, for JSON and checkpoints."""
        counts = {name: dict(getattr(self, name)) for name in ("tried", "won", "causes")}
        numbers = {name: getattr(self, name) for name in ("evaluations", "accepted", "discarded", "staged")}
        return {**numbers, **counts}
