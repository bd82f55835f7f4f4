"""Numbers and choices drawn from a seed, as somebody would write them down: with few digits."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")


class Drawing:
    """Draws one after the other.

    All rests on ``random()`` of the Mersenne twister, whose numbers Python promises to keep.

    Parameters
    ----------
    seed : str
        What all draws follow from.
    """

    def __init__(self, seed: str) -> None:
        self._random = random.Random(seed).random

    def chance(self, probability: float) -> bool:
        """True with a probability."""
        return self._random() < probability

    def one_of(self, values: Sequence[T]) -> T:
        """One of some values; what stands there twice comes twice as often."""
        return values[int(self._random() * len(values))]

    def between(self, low: float, high: float) -> float:
        """A number between two others, with three digits."""
        return float(f"{low + self._random() * (high - low):.3g}")

    def ratio(self, low: float, high: float) -> float:
        """A number between two positive ones whose logarithm is spread evenly, with two digits."""
        return float(f"{math.exp(math.log(low) + self._random() * math.log(high / low)):.2g}")

    def whole(self, low: int, high: int) -> int:
        """A whole number from one to another."""
        return low + int(self._random() * (high + 1 - low))
