"""Forces of two or three meshes extrapolated to elements of zero length, and the errors of mesh and limit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

#: Two limits may agree by chance: no error is taken as smaller than this part of what was extrapolated.
_LEAST = 0.2


@dataclass(frozen=True)
class Limit:
    """A number extrapolated to elements of zero length; its error falls with the square of their length.

    Attributes
    ----------
    value : float
        The limit.
    off : float
        Distance of the finer mesh from it, over the limit: the estimate of the error of that mesh.
    error : float, optional
        Estimate of its own error: the distance from the limit of the two coarser ones of three meshes, or a fifth of
        what was extrapolated if that is more.
    """

    value: float
    off: float
    error: float | None = None

    @classmethod
    def of(cls, coarse: float, fine: float, refined: float) -> Self:
        """From the numbers of two meshes and the ratio of the lengths of their elements, above 1."""
        value = fine + (fine - coarse) / (refined**2 - 1.0)
        return cls(value, fine / value - 1.0)

    @classmethod
    def of_three(cls, numbers: Sequence[float], refined: float) -> Self:
        """From the numbers of three meshes, each finer by the same ratio, and how far the first two miss it."""
        before, last = cls.of(numbers[0], numbers[1], refined), cls.of(numbers[1], numbers[2], refined)
        return cls(last.value, last.off, max(abs(last.value - before.value), _LEAST * abs(numbers[2] - last.value)))


@dataclass(frozen=True)
class Limits:
    """Both forces of a bead, extrapolated to elements of zero length."""

    restraint: Limit
    uplift: Limit
