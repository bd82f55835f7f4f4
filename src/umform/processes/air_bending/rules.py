"""What each parameter of air bending may be."""

from __future__ import annotations

from umform.processes.rules import ROLLING, Rule, length, number, plastic_material, positive, whole

#: The most contact points per direction, and the most layers.
MOST_POINTS, MOST_LAYERS = 10, 8
#: A larger increment jumps over the first contact; a run of smaller ones does not end.
_LARGEST_INCREMENT, _SMALLEST_INCREMENT = 0.05, 1e-5
#: More elements on a thickness than any mesh study needs.
_MOST_ELEMENTS = 100


def angle_rule(what: str, mixed_up: str, usual: str) -> Rule:
    """An angle between 0 and 180 degrees."""
    return Rule(
        lambda value: number(value) and 0.0 < value < 180.0,
        f"{what} lies between 0 and 180 degrees",
        f"radians, a sign, or {mixed_up}",
        f"in degrees, such as {usual}",
    )


def _of_flanks(tool: str) -> Rule:
    return angle_rule(f"the angle between the flanks of the {tool}", "the angle of bending in place of it", "85")


def _count(what: str, least: int, most: int, usual: str) -> Rule:
    return Rule(
        lambda value: whole(value, least, most),
        f"{what} must be a whole number from {least} to {most}",
        "zero, a sign, a fraction, or more than there are rules for",
        f"such as {usual}",
    )


#: One rule a parameter; the element is looked up where the catalogue is.
RULES: dict[str, Rule] = {
    "thickness": length("the thickness of the sheet", "in mm, such as 2"),
    "opening": length("the opening of the die", "in mm, such as 8 times the thickness"),
    "die_angle": _of_flanks("die"),
    "die_radius": length("the radius of the shoulders", "in mm, such as 2"),
    "punch_angle": _of_flanks("punch"),
    "punch_radius": length("the radius of the tip", "in mm, such as 1.5"),
    "width": length("the length of the bend", "in mm, such as 50; omit it for plane strain").optional(),
    "stroke": length("the way of the punch", "in mm, downwards, such as 6").optional(),
    "bottoming": Rule(
        lambda value: isinstance(value, bool),
        "bottoming is true or false",
        "a force or a way in its place",
        "bottoming=True; the force is that of press_to_force",
    ),
    "punch_width": length(
        "the width of the body of the punch", "in mm, such as 16; omit it for flanks without an end"
    ).optional(),
    "material": plastic_material("air bending"),
    "rolling": ROLLING,
    "layers": _count("the number of layers", 1, MOST_LAYERS, "2"),
    "thickness_points": _count("the number of thickness points", 2, 15, "6"),
    "elements_per_thickness": Rule(
        lambda value: positive(value) and value <= _MOST_ELEMENTS,
        f"the number of elements on a thickness must be positive and at most {_MOST_ELEMENTS}",
        "the number of all elements in place of that on a thickness, or a sign",
        "such as 3",
    ),
    "width_elements": _count("the number of elements over half of the width", 1, 1000, "3"),
    "contact_points": Rule(
        lambda value: value == "auto" if isinstance(value, str) else whole(value, 1, MOST_POINTS),
        f"contact points per direction must be a whole number from 1 to {MOST_POINTS}, or auto",
        "more points than there are rules for, or all points of a facet instead of those of one direction",
        "auto, or such as 5",
    ),
    "penalty": length("the penalty", "pressure per penetration; omit it: it follows from the penetration").optional(),
    "penetration": length("the penetration", "such as thickness / 500; omit it for thickness / 200").optional(),
    "increment": Rule(
        lambda value: number(value) and _SMALLEST_INCREMENT <= value <= _LARGEST_INCREMENT,
        f"an increment is {_SMALLEST_INCREMENT:g} to {_LARGEST_INCREMENT:g} of the opening",
        "a length in mm instead of a part of the opening, or a sign",
        "0.00625 is usual",
    ),
}
