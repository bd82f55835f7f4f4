"""What the page on the cup of AA6016-T4 says of its numbers."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from umform.sheet_metals import balanced, uniaxial
from umform_book.drawing.cups import WALL, Made, aa6016

#: Mean height of the measured cup over the angle, mm.
MEASURED = 34.13


def heights(by_force: Mapping[float, float], by_friction: Mapping[str, float], by_mesh: Mapping[str, float]) -> str:
    """How the height follows the force of the holder and friction, and which force the measured height asks for."""
    force, mean = (np.array(list(values)) for values in (by_force.keys(), by_force.values()))
    slope, at_zero = np.polyfit(force, mean, 1)
    frictions = ", ".join(f"{name} {height:.2f}" for name, height in by_friction.items())
    meshes = ", ".join(f"{height:.2f} mm at {name}" for name, height in by_mesh.items())
    return (
        f"The mean height rises by {10.0 * slope:.2f} mm for 10 kN of the holder: the measured {MEASURED:g} mm ask for "
        f"{(MEASURED - at_zero) / slope:.0f} kN with a friction of 0.09. At 40 kN: {frictions} mm. The force of the "
        "holder is not known, and was not fitted to the height. By mesh: "
        f"{meshes}."
    )


def forces(meshes: Mapping[str, Made]) -> str:
    """The force of drawing and that off the holder, over the meshes."""
    drawing = ", ".join(f"{cup.force.value:.1f} ± {cup.force.ripple:.1f}" for cup in meshes.values())
    ironing = ", ".join(f"{cup.after.value:.0f} ± {cup.after.ripple:.0f}" for cup in meshes.values())
    peaks = ", ".join(f"{cup.peak:.0f}" for cup in meshes.values())
    return (
        f"Punch force over {', '.join(meshes)}: the largest of the history is {peaks} kN, a peak of the mesh: the ends "
        "of a facet stand off the edge of the die, eq. (5.71), in a gap in which the thickened wall has no room. The "
        f"means over one element, with their ripple, are {drawing} kN while the holder holds. Off the holder the rim "
        f"is ironed row by row: {ironing} kN. That force is the friction of the rim, which stays pressed in a gap "
        "without an end; these meshes do not resolve it, and a real die ends below its edge."
    )


def volume(base: Made) -> str:
    """What the heights say of the thickness of the wall: the metal above its beginning stays the same."""
    thickness, rim = base.wall
    implied = thickness * (base.ears.mean - WALL) / (MEASURED - WALL)
    return (
        f"Volume: the wall from {WALL:g} mm above the bottom up has a mean thickness of {thickness:.3f} mm with the "
        f"card of NTNU; with the same metal the measured height implies {implied:.3f} mm. The rim is {rim:.3f} mm "
        "thick in a gap of 1.2 mm between punch and die, into both of which it penetrates."
    )


def capacity() -> str:
    """What the bottom of the cup carries over what the rim resists, by the yield stresses of each card."""
    ratios = []
    for name, card in (("Yld2004, NTNU", ""), ("Yld2004, Postech", "Postech"), ("Hill48", "Hill48")):
        function = aa6016(card).yield_function
        rim = float(np.mean([uniaxial(function, angle)[0] for angle in np.arange(0.0, 180.0, 7.5)]))
        ratios.append(f"{name} {balanced(function)[0] / rim:.2f}")
    return (
        "The bottom carries its biaxial yield stress, the rim resists with its yield stress in compression around the "
        f"cup. The first over the mean of the second, without hardening and friction: {'; '.join(ratios)}. Where it is "
        "low, as with Hill48 from r-values far below 1, the bottom flows in place of the flange; none of the teams in "
        "the table used Hill48."
    )


def ears(found: Mapping[str, float]) -> str:
    """Card or code: what each step adds to the ears."""
    numbers = ", ".join(f"{name} {size:+.2f}" for name, size in found.items())
    return (
        "Card or code? At a point the cards have their r-values and yield stresses; a narrow ring of elements that is "
        "compressed around itself has the ears of its r-values, to 3 % and at the angle of the rolling direction; "
        "without ironing and with a weak holder the ears of the cup stand there too, as large as those of a compressed "
        "flange. So law, elements and axes are right. Of the cup that is ironed no more is left than the mesh gives an "
        f"isotropic sheet (cos 4θ in mm: {numbers}). A flat holder bears on the thickest part of the rim, where the "
        "flange grows least, and evens most of the ears out; the gap takes the rest. The profile that NTNU published "
        "with the same card has no fourth harmonic either, and that of Postech a quarter of the measured one. What is "
        "missing of the measured ears is a matter of the cards and of how the holder was pressed."
    )
