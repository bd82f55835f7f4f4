"""A file as a CAD system understands it: the flat length of a part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from umform.errors import InvalidValue


@dataclass(frozen=True)
class Reading:
    """Deductions over the angle between the legs; the radius of the part does not matter.

    Attributes
    ----------
    thickness : float
        Thickness of the sheet in mm.
    deductions : dict of float to float
        Bend deduction in mm by the angle in degrees.
    """

    thickness: float
    deductions: dict[float, float]

    def flat_length(self, angle: float, radius: float, sides: tuple[float, float]) -> float:
        """Flat length of a part.

        Parameters
        ----------
        angle : float
            Angle between the legs in degrees.
        radius : float
            Inside radius of the part in mm.
        sides : tuple of float
            Lengths of both sides in mm, to where the outer faces meet.

        Raises
        ------
        InvalidValue
            The angle is beyond the table.
        """
        known = sorted(self.deductions)
        within(angle, known, "angle")
        return sum(sides) - float(np.interp(angle, known, [self.deductions[one] for one in known]))


def within(value: float, known: list[float], name: str) -> None:
    """Refuse a value beyond a table."""
    if not known or not known[0] - 1e-6 <= value <= known[-1] + 1e-6:
        raise InvalidValue(
            "the table does not reach so far",
            where=name,
            value=value,
            cause=f"it goes from {known[0]:g} to {known[-1]:g}" if known else "it is empty",
            remedy="a table of more angles",
        )
