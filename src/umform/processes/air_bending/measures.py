"""The measures of a bend: name, unit and meaning."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from umform.processes.air_bending.section import Floats, Section


@dataclass(frozen=True)
class Quantity:
    """Presentation of a measure: label, unit, decimals, and what it is for."""

    label: str
    unit: str
    decimals: int
    hint: str = ""


#: The measures in the order of tables, defined in docs/air-bending.md.
QUANTITIES = {
    "stroke": Quantity("stroke", "mm", 3),
    "force": Quantity("force at the stroke", "N/mm", 1),
    "largest_force": Quantity("largest force", "N/mm", 1, "choose the press by it"),
    "loaded_angle": Quantity("angle under load", "deg", 2),
    "angle": Quantity("angle", "deg", 2),
    "springback": Quantity("springback", "deg", 2),
    "springback_ratio": Quantity("springback ratio", "", 4),
    "radius": Quantity("inside radius", "mm", 3),
    "smallest_radius": Quantity("smallest radius", "mm", 3),
    "neutral_fibre": Quantity("neutral fibre", "", 3, "its place in the sheet"),
    "k_factor": Quantity("K-factor", "", 3, "for the flat pattern"),
    "bend_allowance": Quantity("bend allowance", "mm", 3),
    "bend_deduction": Quantity("bend deduction", "mm", 3),
    "setback": Quantity("outside setback", "mm", 3),
    "leg": Quantity("straight leg", "mm", 3),
    "length_balance": Quantity("length balance", "mm", 4, "a check: near 0"),
    "outer_strain": Quantity("outer strain", "", 4),
    "thinning": Quantity("smallest thickness ratio", "", 4),
}


@dataclass(frozen=True)
class Measures:
    """Measures of one bend, under load and after unloading; NaN where a flat sheet does not define them.

    Attributes
    ----------
    stroke : float
        Travel of the punch from first contact with the sheet.
    force, largest_force : float
        Force of the punch per length of bend at the stroke, and its largest value up to there.
    loaded_angle, angle : float
        Angle between the legs in degrees under load, and after unloading.
    springback, springback_ratio : float
        Their difference; bend angle (180 degrees less the angle) after unloading over that under load.
    radius, smallest_radius : float
        Inside radius after unloading: of the best-fit circle, and the smallest local one.
    neutral_fibre : float
        Distance of the fibre that keeps its length from the inner face, in the flat sheet, relative to the thickness.
    k_factor : float
        K in bend allowance = bend angle (radius + K thickness).
    bend_allowance, bend_deduction, setback, leg : float
        Flat length = 2 legs + bend allowance = 2 (leg + setback) - bend deduction; setback is that of the outer faces.
    length_balance : float
        2 legs + length of the neutral fibre between them - flat length: a measure of the curvature of the legs.
    outer_strain : float
        Largest logarithmic strain of the outer face along the sheet.
    thinning : float
        Smallest thickness relative to that of the flat sheet.
    """

    stroke: float
    force: float
    largest_force: float
    loaded_angle: float
    angle: float
    springback: float
    springback_ratio: float
    radius: float
    smallest_radius: float
    neutral_fibre: float
    k_factor: float
    bend_allowance: float
    bend_deduction: float
    setback: float
    leg: float
    length_balance: float
    outer_strain: float
    thinning: float


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


def measure(stroke: float, force: float, largest_force: float, loaded: Section, section: Section) -> Measures:
    """Measures of a bend.

    Parameters
    ----------
    stroke, force, largest_force : float
        State of the punch before unloading.
    loaded : Section
        Section under load.
    section : Section
        Section after unloading.
    """
    return Measures(
        stroke=stroke,
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
