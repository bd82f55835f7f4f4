"""Richardson extrapolation of a number to zero element size from two or three meshes, and its error."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

from umform.results.quantity import Band

#: Ratio of the element sizes of successive meshes.
FINER = math.sqrt(2.0)
#: Two limits may agree by chance: the error is at least this part of the extrapolated difference.
_LEAST = 0.2
_SOURCE = "extrapolation to zero element size; numbers without an error, and all pictures, are from the finest mesh"


@dataclass(frozen=True)
class Limit:
    """A number extrapolated to zero element size; its error falls with the square of the element size.

    Attributes
    ----------
    value : float
        The limit.
    off : float
        Distance of the finer mesh from the limit, relative to the limit: estimated error of that mesh.
    error : float, optional
        Estimated error of the limit: the distance from the limit of the two coarser meshes of three, or a fifth of the
        extrapolated difference if that is larger.
    """

    value: float
    off: float
    error: float | None = None

    @classmethod
    def of(cls, coarse: float, fine: float, refined: float) -> Self:
        """From the numbers on two meshes and the ratio of their element sizes, above 1."""
        value = fine + (fine - coarse) / (refined**2 - 1.0)
        return cls(value, fine / value - 1.0)

    @classmethod
    def of_three(cls, numbers: Sequence[float], refined: float, *, least: float = _LEAST) -> Self:
        """From the numbers on three meshes with one ratio of element sizes; the coarser two give the error.

        The error is at least a part ``least`` of the extrapolated difference: 1 if the order of convergence is not
        known to be 2, so that it reaches the number on the finest mesh.
        """
        before, last = cls.of(numbers[0], numbers[1], refined), cls.of(numbers[1], numbers[2], refined)
        return cls(last.value, last.off, max(abs(last.value - before.value), least * abs(numbers[2] - last.value)))

    @property
    def band(self) -> Band:
        """The limit with its error, as the band of the number on the finer mesh."""
        return Band(math.nan if self.error is None else self.error, _SOURCE, middle=self.value)

    @property
    def inverse(self) -> Limit:
        """The same for one over the number: the radius of a curvature."""
        error = None if self.error is None else self.error / self.value**2
        return Limit(1.0 / self.value, -self.off / (1.0 + self.off), error)


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
