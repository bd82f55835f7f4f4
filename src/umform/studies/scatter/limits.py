"""Limits of a result, and how capable a process is of keeping them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from umform.errors import InvalidValue
from umform.processes.rules import number


@dataclass(frozen=True)
class Limits:
    """Smallest and largest allowed value of a result; None: no limit on this side.

    Examples
    --------
    >>> from umform.studies.scatter import Limits
    >>> round(Limits.of("89:91").cpk(90.2, 0.2), 2)
    1.33
    """

    low: float | None = None
    high: float | None = None

    def __post_init__(self) -> None:
        ends = [one for one in (self.low, self.high) if one is not None]
        if not ends or not all(map(number, ends)) or ends[0] > ends[-1] or (len(ends) == 2 and ends[0] == ends[1]):
            raise InvalidValue(
                "limits are a smaller and a larger number",
                where="limits",
                value=":".join("" if one is None else str(one) for one in (self.low, self.high)),
                remedy="write low:high, such as 89:91; low: or :high for one limit",
            )

    @classmethod
    def of(cls, given: Limits | tuple[float | None, float | None] | str) -> Limits:
        """The limits of a pair, or of a text such as ``89:91``, ``89:`` or ``:91``.

        Raises
        ------
        InvalidValue
            They are no numbers, or the first one is not below the second one.
        """
        if isinstance(given, Limits):
            return given
        if not isinstance(given, str):
            if not isinstance(given, tuple | list) or len(given) != 2:
                raise InvalidValue(
                    "limits are two numbers", where="limits", value=given, remedy="(89.0, 91.0), or (None, 91.0)"
                )
            return cls(*given)
        low, colon, high = given.partition(":")
        try:
            ends = [float(one) if one.strip() else None for one in (low, high if colon else "nan")]
        except ValueError:
            raise InvalidValue(
                "limits are two numbers",
                where="limits",
                value=given,
                cause="a decimal comma" if "," in given else "",
                remedy="write low:high, such as 89:91; low: or :high for one limit",
            ) from None
        return cls(*ends)

    @property
    def text(self) -> str:
        """Both limits as they are written."""
        return ":".join("" if one is None else f"{one:g}" for one in (self.low, self.high))

    def cp(self, deviation: float) -> float | None:
        """Width of the limits over six standard deviations; None for one limit."""
        if self.low is None or self.high is None or not deviation:
            return None
        return (self.high - self.low) / (6.0 * deviation)

    def cpk(self, mean: float, deviation: float) -> float | None:
        """Distance of the mean from the nearer limit over three standard deviations."""
        gaps = [*([] if self.low is None else [mean - self.low]), *([] if self.high is None else [self.high - mean])]
        return min(gaps) / (3.0 * deviation) if deviation else None

    def outside(self, mean: float, deviation: float) -> float | None:
        """Part of a normal distribution beyond the limits."""
        if not deviation:
            return None
        below = 0.0 if self.low is None else _beyond((mean - self.low) / deviation)
        return below + (0.0 if self.high is None else _beyond((self.high - mean) / deviation))


def _beyond(distance: float) -> float:
    """Part of a normal distribution beyond a distance from its mean, in standard deviations."""
    return 0.5 * math.erfc(distance / math.sqrt(2.0))
