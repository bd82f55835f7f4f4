"""Element sizes for bending over tool radii: each element turns by at most a given angle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.spec import check_arguments
from umform.spec.types import ElementTurn

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Bent:
    """A part of the undeformed sheet that goes over a radius of a tool.

    Attributes
    ----------
    start, end : float
        Range along the sheet.
    radius : float
        Radius of the mid-surface on the tool: that of the tool plus half of the thickness.
    name : str
        Name of the radius, for printed output.
    """

    start: float
    end: float
    radius: float
    name: str = ""


@dataclass(frozen=True)
class Sizes:
    """Ends of the elements along a line of the sheet.

    Attributes
    ----------
    ends : ndarray, shape (n + 1,)
        Ascending.
    bent : tuple of Bent
        The radii that determine them.
    """

    ends: Floats
    bent: tuple[Bent, ...]

    def largest_turn(self, part: Bent) -> float:
        """Largest angle in degrees that an element turns over a radius."""
        inside = (self.ends[1:] > part.start + 1e-9) & (self.ends[:-1] < part.end - 1e-9)
        return float(np.degrees(np.diff(self.ends)[inside].max(initial=0.0) / part.radius))

    def __str__(self) -> str:
        turns = [f"{self.largest_turn(part):.3g} degrees over {part.name or f'{part.radius:g}'}" for part in self.bent]
        return f"{len(self.ends) - 1} elements, which turn by up to {', '.join(turns)}"


def bending_sizes(
    start: float, end: float, bent: Sequence[Bent], *, turn: ElementTurn, largest: float, growth: float = 1.5
) -> Sizes:
    """Ends of elements along a line that turn by at most an angle over the radii of tools. eq. (5.69)

    Parameters
    ----------
    start, end : float
        Ends of the line.
    bent : sequence of Bent
        Parts of the line that bend over radii.
    turn : float
        Largest angle in degrees.
    largest : float
        Largest size of an element.
    growth : float
        Largest ratio of the sizes of neighbours.

    Returns
    -------
    Sizes

    Raises
    ------
    InvalidValue
        If a number is out of range.
    """
    check_arguments(bending_sizes, turn=turn)
    if not (start < end and largest > 0.0 and growth > 1.0):
        raise InvalidValue(
            "sizes need a line, a largest size, and a growth of more than one",
            where="bending_sizes",
            value=f"{start:g} to {end:g}, largest {largest:g}, growth {growth:g}",
            cause="a sign, or the ends exchanged",
            remedy="growth=1.5",
        )
    at = np.linspace(start, end, 2001)
    size = np.full(at.shape, largest)
    for part in bent:
        allowed = math.radians(turn) * part.radius
        away = np.maximum(np.maximum(part.start - at, at - part.end), 0.0)
        size = np.minimum(size, allowed + math.log(growth) * away)
    number = np.concatenate([[0.0], np.cumsum(np.diff(at) * 0.5 * (1.0 / size[1:] + 1.0 / size[:-1]))])
    count = max(math.ceil(number[-1] - 1e-9), 1)
    ends = np.interp(np.linspace(0.0, number[-1], count + 1), number, at)
    ends[[0, -1]] = start, end
    return Sizes(ends, tuple(bent))
