"""The measures of a bend: label, unit, decimals, meaning; and how they are taken."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from umform.processes.air_bending.section import Floats, Section
from umform.results.quantity import FORCE_PER_LENGTH, Quantity


@dataclass(frozen=True)
class Measures:
    """Measures of one bend, under load and after unloading; NaN where a flat sheet does not define them.

    Their order is that of tables; docs/air-bending.md defines them.
    """

    stroke: Annotated[float, Quantity("stroke", "mm", 3, leading=True)]
    """Travel of the punch from first contact with the sheet."""
    below_die: Annotated[float, Quantity("punch below the top of the die", "mm", 3, hint="for the machine")]
    """Depth of the tip of the punch below the top of the die at the stroke: the stroke less the thickness."""
    force: Annotated[float, Quantity("force at the stroke", FORCE_PER_LENGTH, 1)]
    """Force of the punch per length of bend at the stroke."""
    largest_force: Annotated[float, Quantity("largest force", FORCE_PER_LENGTH, 1, leading=True)]
    """The largest force up to there."""
    loaded_angle: Annotated[float, Quantity("angle under load", "degrees", 2)]
    """Angle between the legs under load."""
    angle: Annotated[float, Quantity("angle", "degrees", 2, leading=True)]
    """The same after unloading."""
    springback: Annotated[float, Quantity("springback", "degrees", 2, leading=True)]
    """Their difference."""
    springback_ratio: Annotated[float, Quantity("springback ratio", "", 4)]
    """Bend angle (180 degrees less the angle) after unloading over that under load."""
    radius: Annotated[float, Quantity("inside radius", "mm", 3, leading=True)]
    """Inside radius after unloading, of the best-fit circle."""
    smallest_radius: Annotated[float, Quantity("smallest radius", "mm", 3)]
    """The smallest local one."""
    neutral_fibre: Annotated[float, Quantity("neutral fibre", "", 3, hint="its place in the sheet")]
    """Distance of the fibre that keeps its length from the inner face, in the flat sheet, relative to the thickness."""
    k_factor: Annotated[float, Quantity("K-factor", "", 3, hint="for the flat pattern")]
    """K in bend allowance = bend angle (radius + K thickness)."""
    bend_allowance: Annotated[float, Quantity("bend allowance", "mm", 3)]
    """Flat length less two legs."""
    bend_deduction: Annotated[float, Quantity("bend deduction", "mm", 3, leading=True)]
    """2 (leg + setback) less the flat length."""
    setback: Annotated[float, Quantity("outside setback", "mm", 3)]
    """Setback of the outer faces."""
    leg: Annotated[float, Quantity("straight leg", "mm", 3)]
    """Straight part beside the bend."""
    length_balance: Annotated[float, Quantity("length balance", "mm", 4, hint="a check: near 0")]
    """2 legs + length of the neutral fibre between them - flat length: a measure of the curvature of the legs."""
    outer_strain: Annotated[float, Quantity("outer strain", "", 4)]
    """Largest logarithmic strain of the outer face along the sheet."""
    thinning: Annotated[float, Quantity("smallest thickness ratio", "", 4)]
    """Smallest thickness relative to that of the flat sheet."""


#: Measures that only a bent section defines (`Section.is_bent`): they need its radius or its neutral fibre.
_OF_BENDS = (
    "radius",
    "smallest_radius",
    "neutral_fibre",
    "k_factor",
    "bend_allowance",
    "bend_deduction",
    "setback",
    "leg",
    "length_balance",
)


def measure(
    stroke: float, force: float, largest_force: float, loaded: Section, section: Section, height: float | None = None
) -> Measures:
    """Measures of a bend.

    Parameters
    ----------
    stroke, force, largest_force : float
        State of the punch before unloading.
    loaded : Section
        Section under load.
    section : Section
        Section after unloading.
    height : float, optional
        Thickness of all sheets that are bent at once; default: that of the section.
    """
    return Measures(
        stroke=stroke,
        below_die=stroke - (loaded.thickness if height is None else height),
        force=force,
        largest_force=largest_force,
        loaded_angle=loaded.angle,
        angle=section.angle,
        springback=section.angle - loaded.angle,
        springback_ratio=section.slope / loaded.slope if loaded.slope > 0.0 else math.nan,
        **(_of_bend(section) if section.is_bent else dict.fromkeys(_OF_BENDS, math.nan)),
        outer_strain=float(np.log(section.element_lengths(0.0) / section.element_references).max()),
        thinning=float(section.thicknesses.min()),
    )


def _of_bend(section: Section) -> dict[str, float]:
    """Measures that only a bent section defines."""
    return {
        "radius": section.radius,
        "smallest_radius": section.smallest_radius,
        "neutral_fibre": 1.0 - section.neutral_height,
        **developed(section),
    }


def developed(section: Section) -> dict[str, float]:
    """Parts of the flat length: allowance, deduction, setback, leg, balance, and K."""
    point, along = section.leg(0.0)
    apex = point - along * (point[0] / along[0])  # the extended outer faces meet in the symmetry plane
    outside = float((section.fibre(0.5)[-1] - apex) @ along)
    setback = (section.radius + section.thickness) * math.tan(section.slope)
    leg = outside - setback
    flat = 2.0 * section.half_length
    deduction = 2.0 * outside - flat
    allowance = 2.0 * setback - deduction
    return {
        "k_factor": (allowance / (2.0 * section.slope) - section.radius) / section.thickness,
        "bend_allowance": allowance,
        "bend_deduction": deduction,
        "setback": setback,
        "leg": leg,
        "length_balance": 2.0 * leg + 2.0 * _neutral_length(section, apex + setback * along, along) - flat,
    }


def _neutral_length(section: Section, tangent_point: Floats, along: Floats) -> float:
    """Length of the neutral fibre from the symmetry plane to where the bend ends, at the foot of a point of the leg."""
    way = (section.fibre(section.neutral_height)[:: section.order] - tangent_point) @ along
    grown = np.concatenate([[0.0], np.cumsum(section.element_lengths(section.neutral_height))])
    return float(np.interp(0.0, way, grown))
