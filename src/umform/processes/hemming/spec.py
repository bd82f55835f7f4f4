"""Hemming: its parameters, and the first bend."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, ClassVar

from annotated_types import Ge, Gt, Le

from umform.errors import InvalidValue
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.spec import Bend, BendSequence
from umform.spec import About, check_fields, parameters
from umform.spec.types import FOLLOWS, Length

#: Sizes of the tools of the first bend for a sheet of 1 mm: a V of 30 degrees.
ACUTE: dict[str, float] = {
    "opening": 8.0,
    "die_angle": 30.0,
    "die_radius": 1.0,
    "punch_angle": 30.0,
    "punch_radius": 0.5,
}


def scaled(sizes: Mapping[str, float], factor: float) -> dict[str, float]:
    """Sizes of tools with lengths times a factor; angles stay."""
    known = parameters(AirBending)
    return {name: size * factor if known[name].about.unit == "mm" else size for name, size in sizes.items()}


def acute(thickness: float = 1.0, **given: Any) -> AirBending:
    """Sheet and tools of the first bend; sizes that are not given follow from the thickness.

    Parameters
    ----------
    thickness : float
        Thickness of the sheet.
    **given : object
        Other parameters of `AirBending`.
    """
    return AirBending(thickness=thickness, **scaled(ACUTE, thickness) | given)


@dataclass(frozen=True)
class Hemming:
    """Hemming in mm, N and MPa. ::

    ======================  plate, moved down
     .-------------------   flange
    (     [=============    insert: thickness gap, or nothing
     '------------------------------  base
    ======================  table

    """

    groups: ClassVar = {"gap": "Hem", "increments": "Solution"}
    """Group of the parameters from each of these on."""
    proportions: ClassVar = {"gap": 1.0, "flange": 12.0, "base": 30.0}
    """Lengths over the thickness where none is given."""

    gap: Annotated[
        float,
        Gt(0.0),
        About(
            "mm",
            cause="a closed hem, but the sheet has no contact with itself; or a sign",
            remedy="a gap over an insert, such as half a thickness, in mm",
        ),
    ] = FOLLOWS
    """Final distance of flange and base; the plate stops at two thicknesses and the gap above the table."""
    flange: Length = FOLLOWS
    """Length of the flange, flat, from the bend line to its end."""
    base: Length = FOLLOWS
    """Length of the base, flat, from the bend line to its end."""
    insert: bool = True
    """Whether a rigid plate of the thickness gap lies on the base; without it the hem is open, and a flange that would
    touch the base is an error, because the sheet has no contact with itself."""
    insert_from: Length | None = None
    """Distance of the insert from the inner face at the bend line; without it, three thicknesses."""
    angle: Annotated[
        float,
        Ge(20.0),
        Le(70.0),
        About(
            "degrees",
            cause="the angle of bending in place of that between the legs",
            remedy="40, with a die and a punch of 30 degrees",
        ),
    ] = 40.0
    """Angle between the legs after the first bend and its springback, unless the sheet has a stroke; a larger one
    cannot be flattened between plates."""
    sheet: AirBending = field(default_factory=acute)
    """Thickness, material, mesh, and tools of the first bend; in plane strain."""
    increments: Annotated[int, Ge(6), Le(10000), About(cause="a length")] = 60
    """Increments of the travel of the plate."""

    def __post_init__(self) -> None:
        check_fields(self)
        for name, thicknesses in self.proportions.items():
            if getattr(self, name) is None:
                object.__setattr__(self, name, thicknesses * self.sheet.thickness)
        if self.base < self.flange:
            raise InvalidValue(
                "the base of a hem is longer than its flange",
                where="base",
                value=self.base,
                cause="the two exchanged",
                remedy=f"more than {self.flange:g}",
            )
        try:
            _ = self.first  # refuses a flange that is too short for the die
        except InvalidValue as error:
            error.where = error.where.removeprefix("bend 1, ")
            raise

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
        stroke = self.sheet.stroke
        bend = Bend(self.flange, self.angle) if stroke is None else Bend(self.flange, stroke=stroke)
        return BendSequence(self.flange + self.base, (bend,), replace(self.sheet, stroke=None))
