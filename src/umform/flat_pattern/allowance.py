"""Flat length of a bend between the tangent lines of the drawing: by a K-factor, a table, or computed bends."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from umform.errors import FileProblem, InvalidValue

#: Part by which radius and thickness of a row of a table may differ from those of a bend.
_ROW = 0.01


@dataclass(frozen=True)
class Allowance:
    """Flat length of one bend.

    Attributes
    ----------
    length : float
        Flat length between the tangent lines of the drawing, in mm.
    source : str
        Where it comes from.
    radius : float
        Inside radius in mm that the bend gets; that of the drawing unless the bend was computed.
    stroke, force : float, optional
        Stroke of the punch in mm, and largest force in N per mm of bend, of a computed bend.
    """

    length: float
    source: str
    radius: float
    stroke: float | None = None
    force: float | None = None


class AllowanceProvider(Protocol):
    """Gives the flat length of a bend."""

    def __call__(self, angle: float, radius: float, thickness: float) -> Allowance:
        """The allowance of a bend.

        Parameters
        ----------
        angle : float
            Angle in degrees by which the sheet is bent: 90 for an L, 30 for a part of 150 degrees.
        radius : float
            Inside radius of the drawing in mm.
        thickness : float
            Thickness in mm.
        """
        ...


@dataclass(frozen=True)
class KFactor:
    """Allowance angle (R + K t), K by ANSI: the neutral line at K t from the inner face."""

    k: float
    """K-factor, 0 to 1."""

    def __post_init__(self) -> None:
        if not 0.0 <= self.k <= 1.0:
            raise InvalidValue(
                "a K-factor is between 0 and 1",
                where="k_factor",
                value=self.k,
                cause="the factor of DIN 6935, which is twice as large, or percent",
                remedy="K of ANSI: .5 is the middle of the sheet; half of the factor of DIN 6935",
            )

    def __call__(self, angle: float, radius: float, thickness: float) -> Allowance:
        """The allowance of a bend."""
        return Allowance(math.radians(angle) * (radius + self.k * thickness), f"K-factor {self.k:g}", radius)


@dataclass(frozen=True)
class AllowanceTable:
    """Allowances of a table, linear between its angles.

    Made by :meth:`read`.
    """

    rows: tuple[tuple[float, float, float, float], ...]
    """Bend angle in degrees, inside radius, thickness and allowance in mm of each row."""
    name: str
    """Name of the file."""

    @classmethod
    def read(cls, path: str | Path) -> AllowanceTable:
        """Read a CSV file with the columns angle, radius, thickness, allowance.

        Raises
        ------
        FileProblem
            If it cannot be read, or a column is missing.
        """
        path = Path(path)
        try:
            with path.open(newline="", encoding="utf-8-sig") as file:
                lines = csv.DictReader(line for line in file if not line.startswith("#"))
                rows = tuple(
                    (float(x["angle"]), float(x["radius"]), float(x["thickness"]), float(x["allowance"])) for x in lines
                )
        except (OSError, UnicodeDecodeError, KeyError, TypeError, ValueError) as error:
            raise FileProblem(
                "this table of bend allowances cannot be read",
                where=str(path),
                cause=f"the column {error} is missing" if isinstance(error, KeyError) else str(error),
                remedy="a CSV file with the columns angle, radius, thickness, allowance; degrees by which the sheet is "
                "bent, and mm",
            ) from error
        return cls(rows, path.name)

    def __call__(self, angle: float, radius: float, thickness: float) -> Allowance:
        """The allowance of a bend; its radius and thickness must be in the table, its angle within it."""
        fits = sorted(
            (a, length)
            for a, r, t, length in self.rows
            if abs(r - radius) <= _ROW * radius and abs(t - thickness) <= _ROW * thickness
        )
        if not fits or not fits[0][0] - 1e-6 <= angle <= fits[-1][0] + 1e-6:
            have = f"{fits[0][0]:g} to {fits[-1][0]:g} degrees" if fits else "no row of this radius and thickness"
            raise InvalidValue(
                "the table has no allowance for this bend",
                where=self.name,
                value=f"{angle:.4g} degrees, inside radius {radius:.4g}, thickness {thickness:.4g}",
                cause=f"it has {have}; nothing is extrapolated",
                remedy="add rows to the table, or --k-factor",
            )
        length = float(np.interp(angle, [a for a, _ in fits], [b for _, b in fits]))
        return Allowance(length, f"table {self.name}", radius)
