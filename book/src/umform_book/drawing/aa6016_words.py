"""Sentences of the page on the cup of AA6016-T4."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from umform.sheet_metals import balanced, uniaxial
from umform_book.drawing.cups import WALL, Made, aa6016

#: Mean height of the measured cup over the angle, mm.
MEASURED = 34.13


def heights(by_force: Mapping[float, float], by_friction: Mapping[str, float], by_mesh: Mapping[str, float]) -> str:
    """How the height depends on holder force and friction, and which force gives the measured height."""
    force, mean = (np.array(list(values)) for values in (by_force.keys(), by_force.values()))
    slope, at_zero = np.polyfit(force, mean, 1)
    frictions = ", ".join(f"{name} {height:.2f}" for name, height in by_friction.items())
    meshes = ", ".join(f"{height:.2f} mm at {name}" for name, height in by_mesh.items())
    return (
        f"With 10 kN more on the holder the mean height rises by {10.0 * slope:.2f} mm: the measured {MEASURED:g} mm "
        f"need {(MEASURED - at_zero) / slope:.0f} kN with a friction of 0.09. At 40 kN: {frictions} mm. The real force "
        f"of the holder is unknown; it was not fitted to the height. By mesh: {meshes}."
    )


def forces(meshes: Mapping[str, Made]) -> str:
    """Punch force by mesh: while the holder is in contact, and after."""
    drawing = ", ".join(f"{cup.force.value:.1f} ± {cup.force.ripple:.1f}" for cup in meshes.values())
    ironing = ", ".join(f"{cup.after.value:.0f} ± {cup.after.ripple:.0f}" for cup in meshes.values())
    peaks = ", ".join(f"{cup.peak:.0f}" for cup in meshes.values())
    return (
        f"Largest punch force of the runs with {', '.join(meshes)}: {peaks} kN. These peaks come from the mesh: the "
        "ends of a facet stand off the edge of the die, eq. (5.71), and the thickened wall is wider than the gap. "
        f"Averaged over the passage of one element, with the ripple, the force is {drawing} kN while the holder is in "
        f"contact. When the rim has left the holder, it is ironed row by row: {ironing} kN. This is the friction of "
        "the rim, which stays pressed, since the gap of the model has no end. These meshes do not resolve it; a real "
        "die ends below its edge."
    )


def volume(base: Made) -> str:
    """Thickness of the wall that the measured height implies at constant volume."""
    thickness, rim = base.wall
    implied = thickness * (base.ears.mean - WALL) / (MEASURED - WALL)
    return (
        f"Volume: with the card of NTNU the wall, from {WALL:g} mm above the bottom up, has a mean thickness of "
        f"{thickness:.3f} mm. With the same volume the measured height implies {implied:.3f} mm. The rim is "
        f"{rim:.3f} mm thick in a gap of 1.2 mm: it penetrates punch and die."
    )


def capacity() -> str:
    """Strength of the bottom over resistance of the rim, by the yield stresses of each card."""
    ratios = []
    for name, card in (("Yld2004, NTNU", ""), ("Yld2004, Postech", "Postech"), ("Hill48", "Hill48")):
        function = aa6016(card).yield_function
        rim = float(np.mean([uniaxial(function, angle)[0] for angle in np.arange(0.0, 180.0, 7.5)]))
        ratios.append(f"{name} {balanced(function)[0] / rim:.2f}")
    return (
        "The bottom carries its biaxial yield stress. The rim resists with its yield stress in compression around the "
        "cup. Ratio of the first to the mean of the second, without hardening and friction: "
        f"{'; '.join(ratios)}. Where the ratio is low, as with Hill48 from r-values far below 1, the bottom flows "
        "instead of the flange. No team in the table used Hill48."
    )


def ears(found: Mapping[str, float]) -> str:
    """Whether card or code makes the ears too small."""
    numbers = ", ".join(f"{name} {size:+.2f}" for name, size in found.items())
    return (
        "Does the card or the code make the ears too small? At a point the cards give their r-values and yield "
        "stresses. A narrow ring of elements, compressed along its circumference, has the ears of its r-values, within "
        "3 % and at the angle of the rolling direction. Without ironing and with a weak holder the cup has the ears of "
        "a compressed flange. So law, elements and axes are right. The ears of the ironed cup are no larger than those "
        f"that the mesh gives an isotropic sheet (cos 4θ in mm: {numbers}). A flat holder presses on the thickest part "
        "of the rim, where the flange grows least, and evens out most of the ears; the gap removes the rest. The "
        "profile that NTNU published with the same card has no fourth harmonic either; that of Postech has a quarter "
        "of the measured one. The rest of the measured ears depends on the cards and on how the holder was pressed."
    )
