"""Flat length of a bend between the tangent lines of the drawing: by a K-factor, a table, or computed bends."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Protocol

import numpy as np
from annotated_types import Ge, Le

from umform.errors import FileProblem, InvalidValue
from umform.sheet_metals import cards, names
from umform.spec import About, check_arguments, check_fields
from umform.studies.bend_table.formats import table_csv
from umform.studies.bend_table.formats.reading import Reading
from umform.studies.calibration.columns import has_column, number, read_rows

#: Part by which radius and thickness of a row of a table may differ from those of a bend.
_ROW = 0.01
_COLUMNS = ("angle", "radius", "thickness", "allowance")
_EXAMPLE = f"{','.join(_COLUMNS)}: degrees by which the sheet is bent, mm; or bends.csv of `umform bend table`"


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
        Stroke of the punch in mm, and largest force in kN/m, of a computed bend.
    notes : tuple of str
        Remarks on its run, such as a coarse mesh.
    """

    length: float
    source: str
    radius: float
    stroke: float | None = None
    force: float | None = None
    notes: tuple[str, ...] = ()


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

    k: Annotated[
        float,
        Ge(0.0),
        Le(1.0),
        About(
            cause="the factor of DIN 6935, which is twice as large, or percent",
            remedy="K of ANSI: .5 is the middle of the sheet; half of the factor of DIN 6935",
        ),
    ]
    """K-factor."""

    def __post_init__(self) -> None:
        try:
            check_fields(self)
        except InvalidValue as error:
            error.where = "k_factor"  # of the command, and of a file of bends
            raise

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
    def read(cls, path: str | Path) -> AllowanceTable | DeductionTable:
        """Read a CSV file with the columns angle, radius, thickness, allowance, or bends.csv of `umform bend table`.

        Raises
        ------
        FileProblem
            If it cannot be read, a column is missing, or a cell is no number.
        InvalidValue
            If a number is negative, or a bend has two allowances.
        """
        check_arguments(AllowanceTable.read, cls.__name__, path=path)
        path = Path(path)
        if has_column(path, "bend_deduction mm"):
            return _of_bend_table(path)
        found: dict[tuple[float, float, float], float] = {}
        for row in read_rows(path, _COLUMNS, _EXAMPLE):
            a, r, t, length = (number(path, row, name) or 0.0 for name in _COLUMNS)
            if min(a, r, t, length) < 0.0 or found.setdefault((a, r, t), length) != length:
                raise InvalidValue(
                    "a table of bend allowances has each bend once, and no negative numbers",
                    where=f"{path}, line {row[0]}",
                    value=f"{length:g} mm, {_named(a, r, t)}",
                    cause="a sign, a deduction in place of an allowance, or bends of two metals or dies",
                    remedy="flat lengths between the tangent lines; a table for each metal and die",
                )
        return cls(tuple((a, r, t, length) for (a, r, t), length in found.items()), path.name)

    def __call__(self, angle: float, radius: float, thickness: float) -> Allowance:
        """The allowance of a bend; its radius and thickness must be in the table, its angle within it."""
        nearest_last = sorted(self.rows, key=lambda row: -abs(row[1] - radius) - abs(row[2] - thickness))
        near = {
            a: length
            for a, r, t, length in nearest_last
            if abs(r - radius) <= _ROW * radius and abs(t - thickness) <= _ROW * thickness
        }
        fits = sorted(near.items())
        if not fits or not fits[0][0] - 1e-6 <= angle <= fits[-1][0] + 1e-6:
            have = (
                f"it has {fits[0][0]:g} to {fits[-1][0]:g} degrees" if fits else "no row of this radius and thickness"
            )
            raise _not_in_table(self.name, angle, radius, thickness, have)
        length = float(np.interp(angle, [a for a, _ in fits], [b for _, b in fits]))
        return Allowance(length, f"table {self.name}", radius)


@dataclass(frozen=True)
class DeductionTable:
    """Bend deductions of `umform bend table`, linear between its angles; the radius of the drawing does not matter.

    Made by :meth:`AllowanceTable.read`.
    """

    readings: Mapping[table_csv.Sizes, Reading]
    """Deductions over the angle between the legs, for each sheet and tools."""
    name: str
    """Name of the file."""

    def of(self, metal: str, opening: float | None) -> DeductionTable:
        """The table without the bends of other metals of the library and of other dies.

        Parameters
        ----------
        metal : str
            Name; one that the library does not know is no other metal.
        opening : float, optional
            Opening of the die in mm, if it is known.

        Raises
        ------
        InvalidValue
            Nothing is left.
        """
        known = {*names(), *cards()}
        others = known - {metal} if metal in known else set()
        kept = {
            setup: one
            for setup, one in self.readings.items()
            if setup[0] not in others and (opening is None or math.isclose(setup[2], opening))
        }
        if kept or not self.readings:
            return replace(self, readings=kept)
        setups = dict.fromkeys(f"{name} with V {V:g}" for name, _, V, _, _ in self.readings)
        raise InvalidValue(
            "the table is that of another metal or die",
            where=self.name,
            value=" with ".join(filter(None, (metal, "" if opening is None else f"V {opening:g}"))),
            cause=f"it has {', '.join(setups)}",
            remedy="metal and opening of the table, or a table of these; without a table the bends are computed",
        )

    def __call__(self, angle: float, radius: float, thickness: float) -> Allowance:
        """The allowance of a bend; the table must have one set of tools for its thickness, and reach its angle."""
        fits = [one for one in self.readings.values() if abs(one.thickness - thickness) <= _ROW * thickness]
        if len(fits) != 1:
            have = (
                f"{len(fits)} metals and tools have this thickness; give a table of one of them"
                if fits
                else f"it has thicknesses of {', '.join(f'{t:g}' for t in sorted({key[1] for key in self.readings}))}"
            )
            raise _not_in_table(self.name, angle, radius, thickness, have)
        known = sorted(fits[0].deductions)
        if not known[0] - 1e-6 <= 180.0 - angle <= known[-1] + 1e-6:
            have = f"it has angles between the legs from {known[0]:g} to {known[-1]:g} degrees"
            raise _not_in_table(self.name, angle, radius, thickness, have)
        length = fits[0].flat_length(180.0 - angle, radius, (outside(angle, radius, thickness),) * 2)
        return Allowance(length, f"table {self.name}", radius)


def _of_bend_table(path: Path) -> DeductionTable:
    try:
        return DeductionTable(table_csv.read(path), path.name)
    except (KeyError, TypeError, ValueError) as error:
        raise FileProblem(
            "this is no bends.csv of `umform bend table`",
            where=str(path),
            cause=f"the column {error} is missing" if isinstance(error, KeyError) else str(error),
            remedy="the file as the command has written it, with commas and decimal points",
        ) from error


def outside(angle: float, radius: float, thickness: float) -> float:
    """Outside setback (R + t) tan(angle / 2) of a bend, in mm."""
    return (radius + thickness) * math.tan(math.radians(0.5 * angle))


def _not_in_table(name: str, angle: float, radius: float, thickness: float, have: str) -> InvalidValue:
    return InvalidValue(
        "the table has no allowance for this bend",
        where=name,
        value=_named(angle, radius, thickness),
        cause=f"{have}; nothing is extrapolated",
        remedy="add rows to the table, or --k-factor",
    )


def _named(angle: float, radius: float, thickness: float) -> str:
    return f"bent by {angle:.4g} degrees, inside radius {radius:.4g}, thickness {thickness:.4g}"
