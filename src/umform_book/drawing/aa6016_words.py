"""What the page on the cup of AA6016-T4 says of its numbers."""

from __future__ import annotations

import numpy as np

from umform.sheet_metals import balanced, uniaxial
from umform_book.drawing.cups import WALL, Made, aa6016

#: Mean height of the measured cup, mm.
MEASURED = 34.15


def reading(found: dict[str, Made], teams: dict[str, float]) -> str:
    """What the meshes say: why they differ, and where the converged height lies."""
    fine, base, coarse = (found[label] for label in ("7.5 degrees", "10 degrees", "20 degrees"))
    means = ", ".join(f"{name} {mean:.2f}" for name, mean in teams.items())
    held = found.get("holder 60 kN")
    strong = f" (to {held.ears.mean:.2f} mm with 60 kN on 10 degrees)" if held else ""
    return (
        f"The mean height falls with the mesh to {fine.ears.mean:.2f} mm; the last refinement changed it by "
        f"{fine.ears.mean - base.ears.mean:+.2f} mm, so that {base.elements} elements are enough. The "
        f"model is {MEASURED - fine.ears.mean:.2f} mm lower than the measured cup, and lower than two teams with the "
        f"same cards ({means}). A mesh of 15 degrees with 3 x 3 "
        "contact points is near to the measured height by its errors alone: along the radius, elements that turn by "
        "a large angle over an edge need more force, which stretches the bottom; around the cup, elements are chords, "
        "which with 3 x 3 points need more room in the gap beside the punch than the sheet, eq. (4.192), and are "
        "ironed thinner. With 2 x 2 points they keep the gap, and more elements around change little. A stronger "
        f"holder{strong} and more friction make the cup higher, see the budget; the force of the holder is not known, "
        "and was not fitted to the height. "
        "The largest force of the punch, while it irons, needs the finer meshes more: "
        f"{coarse.force:.0f} kN on the coarsest, {fine.force:.0f} kN on the finest."
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
        "low, the bottom flows in place of the flange until it tears. With Hill48 from r-values far below 1 it does; "
        "none of the teams in the table used Hill48."
    )


def ears() -> str:
    """Where the ears go."""
    return (
        "Without ironing and with a weak holder the ears stand where the r-values say, as large as those of a flange "
        "compressed around the cup and nothing else. A flat holder bears on the thickest part of the rim, where "
        "the flange grows least, and evens most of the ears out; the gap takes the rest."
    )
