"""Valid ranges of the parameters of drawing."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, cast

from umform.elements import element
from umform.elements.locking import layers_for
from umform.errors import InvalidValue
from umform.materials import Material
from umform.materials.j2 import Plastic
from umform.model.through_thickness import completed, points_through
from umform.processes.rules import FRICTION, PLASTIC, contact_points, length, number, positive, whole
from umform.spec import Rule

#: Clearances beside the punch in thicknesses: less is a wrong number rather than ironing, more leaves the sheet loose.
_TIGHTEST, _LOOSEST = 0.9, 20.0

#: Thickness in mm and Young's modulus in MPa of sheet metal; beyond, another unit is meant.
_THICKNESS, _YOUNG = (0.01, 100.0), (1e3, 1e6)
#: Least pressure of a holder in MPa: one in kN is a thousandth of one in N. The largest is the yield stress.
_LEAST_PRESSURE = 0.02

#: Rules for both cups and U-bends.
COMMON: dict[str, Rule] = {
    "thickness": Rule(
        lambda value: number(value) and _THICKNESS[0] <= value <= _THICKNESS[1],
        f"the thickness of the sheet lies between {_THICKNESS[0]:g} and {_THICKNESS[1]:g} mm",
        "metres in place of millimetres, or a sign",
        "in mm, such as 1",
    ),
    "material": PLASTIC,
    "punch_edge": length("the radius of the edge of the punch", "in mm, such as 5"),
    "die_edge": length("the radius of the edge of the die", "in mm, such as 10"),
    "holder_force": Rule(
        positive,
        "the force of the holder must be positive",
        "a sign",
        "in N, such as 40e3; None (on the command line 0) for a holder of a cup that keeps its distance",
    ).optional(),
    "friction": FRICTION,
    "stroke": length("the stroke", "in mm; omit it for a whole cup or the usual U-bend").optional(),
    "turn": Rule(
        lambda value: number(value) and 1.0 <= value <= 45.0,
        "the angle that an element turns over a radius lies between 1 and 45 degrees",
        "radians, or a number of elements",
        "15 is usual, 30 for a coarse mesh",
    ),
    "penalty": length("the penalty of the contacts", "in MPa per mm of penetration, such as 3e4").optional(),
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
    order = completed(made, law, *points_through(made, law, points, None)).thickness_order
    return layers_for(order, thickness, radius, material.kappa / float(yield_stress))


def check_stiffness(material: Plastic) -> None:
    """Refuse a Young's modulus that is not in MPa."""
    if not _YOUNG[0] <= material.E <= _YOUNG[1]:
        raise InvalidValue(
            f"Young's modulus of a metal lies between {_YOUNG[0]:g} and {_YOUNG[1]:g} MPa",
            where="young",
            value=f"{material.E:.4g}",
            cause="GPa, or Pa, in place of MPa",
            remedy="in MPa: 210e3 for steel, 70e3 for aluminium",
        )


def unusual_pressure(force: float | None, flange: float, material: Plastic) -> list[str]:
    """Warning of a holder force in another unit: its pressure is far from usual.

    Parameters
    ----------
    force : float, optional
        On the whole holder.
    flange : float
        Area of the blank between holder and flat of the die.
    material : J2 or Metal
        Law of the sheet.
    """
    if force is None or not flange > 0.0:
        return []
    pressure, strength = force / flange, float(material.hardening.curve()(0.0)[0])
    if _LEAST_PRESSURE <= pressure <= strength:
        return []
    what = f"the holder force of {force:.4g} N is a pressure of {pressure:.3g} MPa on the flange"
    if pressure < _LEAST_PRESSURE:
        return [f"{what}: kN in place of N? The sheet wrinkles under a holder that is too weak; 1 to 5 MPa are usual"]
    return [f"{what}, above the yield stress {strength:.4g}; 1 to 5 MPa are usual"]


def check_clearance(air: float, thickness: float, *, where: str, value: float, remedy: str) -> None:
    """Refuse a clearance between punch and die that does not fit the sheet.

    Parameters
    ----------
    air : float
        Clearance beside the punch.
    thickness : float
        Thickness of the sheet.
    where, value : str, float
        Parameter of the die, for the message.
    remedy : str
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
        remedy=remedy,
    )


def tight(air: float, thickness: float, *, what: str, wanted: float) -> list[str]:
    """Warning of a clearance below the thickness, with the usual size of the die."""
    if air >= thickness * (1.0 - 1e-9):
        return []
    text = f"the gap of {air:.4g} between punch and die is smaller than the thickness {thickness:g}: they iron the wall"
    return [f"{text}, and the forces rise; {what} of {wanted:.4g} lets the sheet pass"]


def coarse(case: Any) -> list[str]:
    """Warn of a mesh that is coarser than the usual one: its numbers are not those of the part."""
    usual = next(field.default for field in fields(case) if field.name == "turn")
    if case.turn <= usual:
        return []
    return [
        f"coarse mesh: an element turns {case.turn:g} degrees over a radius, {usual:g} is usual. Forces, thinning, "
        "strains and springback are those of this mesh; they may be off by tens of per cent"
    ]
