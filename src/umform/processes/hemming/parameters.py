"""Parameters of hemming."""

from __future__ import annotations

from dataclasses import dataclass, replace

from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.parameters import Bend, BendSequence
from umform.processes.hemming.checks import check_hemming

#: Tools for 1 mm: a V of 30 degrees.
ACUTE = AirBending(thickness=1.0, opening=8.0, die_angle=30.0, die_radius=1.0, punch_angle=30.0, punch_radius=0.5)


@dataclass(frozen=True)
class Hemming:
    r"""Parameters of hemming in mm, N and MPa. ::

        ======================  plate, moved down
         .-------------------   flange
        (     [=============    insert: thickness gap, or nothing
         '------------------------------  base
        ======================  table

    Parameters
    ----------
    gap : float
        Final distance of flange and base: the plate stops at two thicknesses and the gap above the table.
    flange, base : float
        Lengths of the flat strip from the bend line to its ends.
    insert : bool
        Whether a rigid plate of the thickness gap lies on the base. Without it the hem is open; it is an error if the
        flange would touch the base, because the sheet has no contact with itself.
    insert_from : float, optional
        Where the insert begins: distance from the inner face at the bend line; default three thicknesses.
    angle : float
        Angle between the legs after the first bend and its springback, in degrees.
    sheet : AirBending
        Thickness, material, mesh, and tools of the first bend; in plane strain.
    increments : int
        Increments of the travel of the plate.
    """

    gap: float = 1.0
    flange: float = 12.0
    base: float = 30.0
    insert: bool = True
    insert_from: float | None = None
    angle: float = 40.0
    sheet: AirBending = ACUTE
    increments: int = 60

    def __post_init__(self) -> None:
        check_hemming(self)

    @property
    def height(self) -> float:
        """Final distance of plate and table."""
        return 2.0 * self.sheet.thickness + self.gap

    @property
    def insert_edge(self) -> float:
        """Distance of the insert from the inner face at the bend line."""
        return 3.0 * self.sheet.thickness if self.insert_from is None else self.insert_from

    @property
    def first(self) -> BendSequence:
        """The first bend."""
        bend = Bend(self.flange, self.angle)
        return BendSequence(self.flange + self.base, (bend,), replace(self.sheet, stroke=None))
