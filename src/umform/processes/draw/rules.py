"""Valid ranges of the parameters of drawing."""

from __future__ import annotations

from typing import cast

from umform.elements import element
from umform.elements.locking import layers_for
from umform.materials import Material
from umform.materials.j2 import Plastic
from umform.model.through_thickness import completed, points_through
from umform.processes.rules import FRICTION, Rule, contact_points, length, number, plastic_material, positive, whole

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
