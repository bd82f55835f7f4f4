"""Valid ranges of the parameters of drawing."""

from __future__ import annotations

from typing import cast

from umform.elements import element
from umform.elements.locking import layers_for
from umform.errors import InvalidValue
from umform.materials import Material
from umform.materials.j2 import Plastic
from umform.model.through_thickness import completed, points_through
from umform.processes.rules import FRICTION, Rule, contact_points, length, number, plastic_material, positive, whole

#: Clearances beside the punch in thicknesses: less is a wrong number rather than ironing, more leaves the sheet loose.
_TIGHTEST, _LOOSEST = 0.9, 20.0

#: Rules for both cups and U-bends.
COMMON: dict[str, Rule] = {
    "thickness": length("the thickness of the sheet", "in mm, such as 1"),
    "material": plastic_material("drawing"),
    "punch_edge": length("the radius of the edge of the punch", "in mm, such as 5"),
    "die_edge": length("the radius of the edge of the die", "in mm, such as 10"),
    "holder_force": Rule(
        positive,
        "the force of the holder must be positive",
        "a sign",
        "in N, such as 40e3; omit it for a holder that keeps its distance",
    ).optional(),
    "friction": FRICTION,
    "stroke": length("the stroke", "in mm; omit it for a whole cup or the usual U-bend").optional(),
    "turn": Rule(
        lambda value: number(value) and 1.0 <= value <= 45.0,
        "the angle that an element turns over a radius lies between 1 and 45 degrees",
        "radians, or a number of elements",
        "15 is usual, 30 for a coarse mesh",
    ),
    "penalty": length("the penalty of the contacts", "in MPa per mm of penetration, such as 3e4"),
    "contact_points": contact_points("2 for cells of 8 nodes, 3 for those of 18"),
    "thickness_points": Rule(
        lambda value: whole(value, 2, 20),
        "points through the thickness must be a whole number from 2 to 20",
        "zero, or the number of layers",
        "5",
    ).optional(),
    "layers": Rule(
        lambda value: whole(value, 1, 10),
        "layers through the thickness must be a whole number from 1 to 10",
        "a thickness",
        "1, or 2; None follows the rule for sharp bends",
    ).optional(),
}


def layers_by_rule(name: str, material: Plastic, points: int | None, thickness: float, radius: float) -> int:
    """Layers of an element, with so many thickness points, that follow the sharpest radius of the tools, eq. (2.29)."""
    yield_stress, _ = material.hardening.curve()(0.0)
    made, law = element(name), cast(Material, material)
    order = completed(made, law, points_through(made, law, points, None)[0]).thickness_order
    return layers_for(order, thickness, radius, material.kappa / float(yield_stress))


def check_clearance(air: float, thickness: float, *, where: str, value: float, wanted: float) -> None:
    """Refuse a clearance between punch and die that does not fit the sheet.

    Parameters
    ----------
    air : float
        Clearance beside the punch.
    thickness : float
        Thickness of the sheet.
    where, value : str, float
        Parameter of the die, for the message.
    wanted : float
        Its usual value.
    """
    if _TIGHTEST * thickness <= air < _LOOSEST * thickness:
        return
    raise InvalidValue(
        "the gap between punch and die does not fit the sheet",
        where=where,
        value=value,
        cause=f"a gap of {air:.4g} beside the punch for a sheet of {thickness:g}; "
        + ("tools of a thinner sheet" if air < thickness else "a diameter for a radius"),
        remedy=f"about {wanted:.4g}",
    )


def tight(air: float, thickness: float, *, what: str, wanted: float) -> list[str]:
    """Warning of a clearance below the thickness, with the usual size of the die."""
    if air >= thickness * (1.0 - 1e-9):
        return []
    text = f"the gap of {air:.4g} between punch and die is smaller than the thickness {thickness:g}: they iron the wall"
    return [f"{text}, and the forces rise; {what} of {wanted:.4g} lets the sheet pass"]
