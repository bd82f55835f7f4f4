"""A foil under the tools: which one is squeezed out from under the punch or over the shoulders."""

from __future__ import annotations

import math
from itertools import pairwise

from umform.errors import InvalidValue
from umform.processes.air_bending.formulas import shop_forces
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import name_of

#: Plastic strain of a foil that is squeezed to a third of its thickness.
_SQUEEZED = 1.0
#: Width of the contact below the tip where the force is largest, in radii of the tip. Below a tip of 1.5 mm on 1 mm of
#: DC04, without friction, foils that bear 41 MPa stay until 100 degrees, and those that bear 25 MPa are squeezed out.
_WIDE = 0.7


def tip_pressure(case: AirBending) -> float:
    """Pressure below the tip in MPa: the force by the rule of the shop on the contact."""
    return shop_forces(case)[0] / (_WIDE * max(case.punch_radius, case.height))


def refuse_squeezed(case: AirBending) -> None:
    """Refuse a foil that slides freely on a face and bears less than the pressure of the tip.

    Between smooth plates a wide foil bears its flow stress in plane strain, however wide it is. Friction on both
    faces holds it, or a bond on one.

    Raises
    ------
    InvalidValue
    """
    rubs = [case.friction, *(math.inf if sheet.bonded else sheet.friction for sheet in case.on_top), case.friction]
    pressure = tip_pressure(case)
    for number, (sheet, faces) in enumerate(zip(case.sheets, pairwise(rubs), strict=True)):
        bears = 2.0 / math.sqrt(3.0) * sheet.material.hardening.curve()(_SQUEEZED)[0]
        if case.on_top and bears < pressure and min(faces) == 0.0 and max(faces) < math.inf:
            raise InvalidValue(
                f"{name_of(number)} would be squeezed out between tool and sheet: it is too soft to slide freely",
                where="friction",
                value=f"{faces[0]:g} below it, {faces[1]:g} above",
                cause=f"squeezed to a third it bears {bears:.3g} MPa, the tip presses with about {pressure:.3g} MPa",
                remedy="friction on both of its faces, of tools and sheets (such as 0.3); bonded, if it sticks to its "
                "sheet; or a curve that hardens more",
            )
