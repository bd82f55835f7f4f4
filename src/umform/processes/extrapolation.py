"""Richardson extrapolation of a number to zero element size from two or three meshes, and its error."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Self

from umform.results.quantity import Band

#: Ratio of the element sizes of successive meshes.
FINER = math.sqrt(2.0)
#: Two limits may agree by chance: the error is at least this part of the extrapolated difference.
_LEAST = 0.2
#: Order of convergence of elements with straight sides, and with mid-side nodes.
ORDER, _QUADRATIC = 2.0, 3.0
_SOURCE = "extrapolation to zero element size; numbers without an error, and all pictures, are from the finest mesh"


@dataclass(frozen=True)
class Limit:
    """A number extrapolated to zero element size.

    Attributes
    ----------
    value : float
        The limit.
    off : float
        Distance of the finer mesh from the limit, relative to the limit: estimated error of that mesh.
    error : float, optional
        Estimated error of the limit. Of two meshes: the shift from the finer one at order 2. Of three: its distance
        from the limit of the coarser two, or a fifth of the extrapolated difference if that is larger.
    """

    value: float
    off: float
    error: float | None = None

    @classmethod
    def of(cls, coarse: float, fine: float, refined: float, order: float = ORDER) -> Self:
        """From the numbers on two meshes, the ratio of their element sizes, above 1, and the order of convergence."""
        value = fine + (fine - coarse) / (refined**order - 1.0)
        return cls(value, fine / value - 1.0)

    @classmethod
    def of_two(cls, coarse: float, fine: float, refined: float) -> Self:
        """From the numbers on two meshes of elements with mid-side nodes, order 3; the error is the shift at order 2.

        It contains the number on the finer mesh, and what any order from 1.7 on gives.
        """
        last = cls.of(coarse, fine, refined, _QUADRATIC)
        return cls(last.value, last.off, abs(cls.of(coarse, fine, refined).value - fine))

    @classmethod
    def of_three(cls, numbers: Sequence[float], refined: float, order: float = ORDER) -> Self:
        """From the numbers on three meshes with one ratio of element sizes; the coarser two give the error."""
        before, last = (cls.of(*pair, refined, order) for pair in pairwise(numbers))
        return cls(last.value, last.off, max(abs(last.value - before.value), _LEAST * abs(numbers[2] - last.value)))

    @property
    def band(self) -> Band:
        """The limit with its error, as the band of the number on the finer mesh."""
        return Band(math.nan if self.error is None else self.error, _SOURCE, middle=self.value)


def allowed_penetration(length: float, radius: float, thickness: float) -> float:
    """Penetration whose error vanishes with the mesh as that of the elements does. eq. (4.190)

    Parameters
    ----------
    length : float
        Between neighbouring nodes.
    radius : float
        Sharpest radius of the tools.
    thickness : float
        Of the sheet: 1/200 of it at least.
    """
    return max(length**2 / (16.0 * radius), thickness / 200.0)
