"""What a form says of a strip that is bent more than once, and the sequence or hem that it means."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from annotated_types import Le
from pydantic import BaseModel, ConfigDict, Field

from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence import Bend, BendSequence
from umform.processes.hemming import Hemming
from umform.spec.types import Degrees, Length

#: A longer strip is no part of a press brake, and would take the memory of the server, in mm.
_LONGEST = 4000.0
_STRICT = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, strict=True)


class WantedBend(BaseModel):
    """One bend of a part.

    Attributes
    ----------
    position : float
        Distance of the bend line from the left end of the flat strip in mm.
    angle : float
        Wanted angle in degrees.
    over : bool
        Whether the part is turned over for it: the legs go down.
    """

    model_config = _STRICT

    position: Length
    angle: Degrees = 90.0
    over: bool = False


class WantedStrip(BaseModel):
    """Lengths of a strip, its bends in their order, and its hem.

    Attributes
    ----------
    strip_length : float
        Length of the flat strip.
    bends : list of WantedBend
        In the order in which they are bent.
    gap, flange, base, first_angle : float
        Of a hem: see `Hemming`.
    insert : bool
        Whether a plate of the thickness gap lies in the hem.
    """

    model_config = _STRICT

    strip_length: Annotated[Length, Le(_LONGEST)] = 80.0
    bends: Annotated[list[WantedBend], Field(min_length=1, max_length=20)] = [
        WantedBend(position=20.0),
        WantedBend(position=60.0),
    ]
    gap: Length = Hemming.gap
    flange: Annotated[Length, Le(_LONGEST)] = Hemming.flange
    base: Annotated[Length, Le(_LONGEST)] = Hemming.base
    first_angle: Degrees = Hemming.angle
    insert: bool = True

    def sequence(self, sheet: AirBending) -> BendSequence:
        """The bends in one part."""
        bends = tuple(Bend(one.position, one.angle, direction="down" if one.over else "up") for one in self.bends)
        return BendSequence(self.strip_length, bends, replace(sheet, stroke=None))

    def hem(self, sheet: AirBending) -> Hemming:
        """The hem."""
        return Hemming(
            gap=self.gap,
            flange=self.flange,
            base=self.base,
            insert=self.insert,
            angle=self.first_angle,
            sheet=replace(sheet, stroke=None),
        )
