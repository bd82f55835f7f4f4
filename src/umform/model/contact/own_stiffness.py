"""Stiffness of a contact law of the user, and the options that it excludes."""

from __future__ import annotations

import numpy as np

from umform.errors import InvalidValue
from umform.model.contact.own_law import AnyContactLaw


def measured(law: AnyContactLaw, depth: float, where: str) -> float:
    """Pressure per way of a law from its reach to a penetration: what a penalty would be there. eq. (4.282)

    Raises
    ------
    InvalidValue
        If there is no pressure at that penetration.
    """
    pressure = float(law.called(f"{where}, {law.name}").kernel().pressures(np.array([-depth]))[0][0])
    if not pressure > 0.0:
        raise InvalidValue(
            "a contact law must press where the sheet is in the tool",
            where=f"{where}, {law.name}",
            value=f"pressure {pressure:g} at the gap {-depth:g}",
            cause="a pressure of the penetration in place of the gap, which is negative there",
            remedy="pressure = stiffness * -gap, or penetration= deep enough that the law presses",
        )
    return pressure / max(law.reach + depth, depth)


def refuse_beside(
    law: AnyContactLaw | None, penalty: float | None, augmented: bool, points: object, cells: object
) -> None:
    """Refuse options that a contact law of the user excludes.

    Raises
    ------
    InvalidValue
        Beside a penalty, multipliers, or a number of points that is to follow from a penalty.
    """
    if law is None:
        return
    if penalty is not None:
        raise InvalidValue(
            "give a penalty or a contact law, and not both",
            where="penalty",
            value=f"penalty {penalty:g}, law {law.name}",
            cause="the law has the stiffness of the contact",
            remedy="leave the penalty out",
        )
    if augmented:
        raise InvalidValue(
            "a contact law of one's own has no multipliers",
            where="augmented",
            value=f"law {law.name}",
            cause="multipliers remove the penetration, from which the law gives the pressure",
            remedy="leave out augmented; a stiffer law enters less",
        )
    if "auto" in (points, cells):
        raise InvalidValue(
            "a number of contact points does not follow from a contact law of one's own",
            where="cells" if cells == "auto" else "points",
            value="auto",
            cause="the length of the contact is estimated from a penalty",
            remedy="a number: points=3 or more where the contact is short, cells=3",
        )
