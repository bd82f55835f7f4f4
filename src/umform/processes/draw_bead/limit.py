"""Forces of two meshes extrapolated to elements of zero length, and the error of the finer mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self


@dataclass(frozen=True)
class Limit:
    """A number extrapolated to elements of zero length; its error falls with the square of their length.

    Attributes
    ----------
    value : float
        The limit.
    off : float
        Distance of the finer mesh from it, over the limit: the estimate of its error.
    """

    value: float
    off: float

    @classmethod
    def of(cls, coarse: float, fine: float, refined: float) -> Self:
        """From the numbers of two meshes and the ratio of the lengths of their elements, above 1."""
        value = fine + (fine - coarse) / (refined**2 - 1.0)
        return cls(value, fine / value - 1.0)


@dataclass(frozen=True)
class Limits:
    """Both forces of a bead, extrapolated to elements of zero length."""

    restraint: Limit
    uplift: Limit
