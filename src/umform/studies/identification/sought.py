"""An unknown number: bounds, start, and its standard deviation before the measurements."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Self

from umform.errors import InvalidValue
from umform.processes.rules import bound


@dataclass(frozen=True)
class Sought:
    """A number that is looked for.

    Attributes
    ----------
    low, high : float
        Bounds; default: none.
    start : float, optional
        First value; default: that of the problem if it lies between the bounds, else their middle.
    deviation : float, optional
        Standard deviation of what was known of it before: the start is then a measurement, too.

    Examples
    --------
    >>> import umform as uf
    >>> strength = uf.Sought(400.0, 700.0, start=520.0, deviation=30.0)
    >>> strength.high
    700.0
    """

    low: float = -math.inf
    high: float = math.inf
    start: float | None = None
    deviation: float | None = None

    @classmethod
    def of(cls, given: Any, path: str) -> Self:
        """From bounds, a first value, or None, checked.

        Raises
        ------
        InvalidValue
            Bounds, first value and deviation contradict each other.
        """
        if isinstance(given, cls):
            made = given
        elif given is None:
            made = cls()
        elif isinstance(given, int | float):
            made = cls(start=float(given))
        else:
            try:
                low, high = given
                made = cls(float(low), float(high))
            except (TypeError, ValueError):
                raise _wrong(path, given, "neither bounds nor a first value") from None
        made = replace(made, low=bound(made.low), high=bound(made.high))
        if not made.low < made.high:
            raise _wrong(path, f"{made.low:g}:{made.high:g}", "the lower bound is not below the upper one")
        if made.start is not None and not made.low <= made.start <= made.high:
            raise _wrong(path, f"{made.start:g} for {made.low:g}:{made.high:g}", "a first value beyond the bounds")
        if made.deviation is not None and not 0.0 < made.deviation < math.inf:
            raise _wrong(path, made.deviation, "a standard deviation that is not positive")
        return made

    def begin(self, present: float | None, path: str) -> float:
        """First value, from that of the problem."""
        for value in (self.start, present):
            if value is not None and self.low <= value <= self.high:
                return value
        if math.isinf(self.low) or math.isinf(self.high):
            raise _wrong(path, f"{self.low:g}:{self.high:g}", "no first value between the bounds")
        return 0.5 * (self.low + self.high)

    def scale(self, start: float) -> float:
        """Size of a step of the search."""
        if self.deviation is not None:
            return self.deviation
        if math.isfinite(self.high - self.low):
            return 0.5 * (self.high - self.low)
        return abs(start) or 1.0

    @property
    def size(self) -> float:
        """Standard deviation of all values between bounds of both signs; 0 for other bounds."""
        both = self.low < 0.0 < self.high and math.isfinite(self.high - self.low)
        return (self.high - self.low) / math.sqrt(12.0) if both else 0.0


def _wrong(path: str, value: Any, cause: str) -> InvalidValue:
    return InvalidValue(
        "an unknown number needs bounds or a first value",
        where=path,
        value=value,
        cause=cause,
        remedy="--find KEY=400:700@520+-30, of which bounds, @START and +-DEVIATION may be left out; "
        "in Python Sought(400.0, 700.0, start=520.0, deviation=30.0)",
    )
