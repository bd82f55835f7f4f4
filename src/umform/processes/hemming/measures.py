"""Result of hemming."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.problem.problem import Problem
from umform.processes.air_bending.section import Section
from umform.processes.bend_sequence.part import Part, after
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming.spec import Hemming
from umform.run import Result

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class HemMeasures:
    """Measures of a hem; lengths in mm, forces per length of hem in N/mm.

    Attributes
    ----------
    force, largest_force : float
        Force of the plate at the end of its travel, and the largest one.
    loaded_height, height : float
        Outer height of the hem with the plate on it, and after unloading.
    springback : float
        Their difference.
    tip_gap, loop_gap : float
        After unloading: gap between flange and base at the tip of the flange, and the largest one.
    angle : float
        Angle between flange and base after unloading in degrees; positive: it opens towards the tip.
    outer_strain : float
        Largest mean logarithmic strain of an element along the outer face.
    thinning : float
        Smallest thickness relative to that of the flat sheet.
    """

    force: float
    largest_force: float
    loaded_height: float
    height: float
    springback: float
    tip_gap: float
    loop_gap: float
    angle: float
    outer_strain: float
    thinning: float


@dataclass(frozen=True)
class Hem:
    """A hem.

    Attributes
    ----------
    case : Hemming
        The parameters.
    first : Part
        The first bend.
    measures : HemMeasures
        The measures.
    stroke, force : ndarray, shape (n,)
        Travel of the plate and its force per length of hem in N/mm, all converged increments.
    strip : Strip
        The section after unloading, the base on z = 0.
    warnings : tuple of str
        Warnings.
    result : Result
        History and frames of the flattening.
    problem : Problem
        The flattening as a problem of its own.
    """

    case: Hemming
    first: Part
    measures: HemMeasures
    stroke: Floats
    force: Floats
    strip: Strip
    warnings: tuple[str, ...]
    result: Result
    problem: Problem

    def decks(self) -> dict[str, str]:
        """Decks of bend and flattening by the names of their files: `umform run` of both repeats the runs."""
        decks = self.first.decks()
        return decks | {"hem.toml": self.problem.toml(after(*decks))}

    @property
    def stages(self) -> dict[str, Result]:
        """The first bend and the flattening."""
        return {"first bend": self.first.bends[0].result, "flattening": self.result}

    @property
    def profile(self) -> Floats:
        """Outline (n, 2): the outer face from the tip of the flange to the end of the base, then the inner face."""
        return self.strip.outline


def measured(case: Hemming, force: Floats, loaded: Strip, released: Strip) -> HemMeasures:
    """Measures from the force, and the section under load and after unloading."""
    gaps = clearances(case, released)
    section = Section(released.reference, released.current, released.order)
    x = released.middle[released.reference[:, 0, 0] <= 0.5 * case.flange]
    along = np.linalg.svd(x - x.mean(axis=0))[2][0]
    heights = [_height(case, strip) for strip in (loaded, released)]
    return HemMeasures(
        force=float(force[-1]),
        largest_force=float(force.max()),
        loaded_height=heights[0],
        height=heights[1],
        springback=heights[1] - heights[0],
        tip_gap=float(gaps[0]),
        loop_gap=float(gaps.max()),
        angle=math.degrees(math.atan(along[1] / along[0])),
        outer_strain=float(np.log(section.element_lengths(0.0) / section.element_references).max()),
        thinning=float(section.thicknesses[1:-1].min()),
    )


def clearances(case: Hemming, strip: Strip) -> Floats:
    """Distance of the inner face of the flange from that of the base at lines of nodes, from the tip to the bend."""
    s = strip.reference[:, 0, 0]
    flange, base = strip.current[s < case.flange, -1], strip.current[s > case.flange, -1]
    over = flange[:, 0] >= base[0, 0]
    found: Floats = flange[over, 1] - np.interp(flange[over, 0], base[:, 0], base[:, 1])
    return found


def _height(case: Hemming, strip: Strip) -> float:
    """Largest height of the flange above the outer face of the base below it."""
    s = strip.reference[:, 0, 0]
    base = strip.current[s > case.flange, 0]
    return float(strip.current[s <= case.flange, 0, 1].max() - base[:, 1].min())
