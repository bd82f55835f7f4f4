"""Result of hemming."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.problem.problem import Problem
from umform.processes.air_bending.remarks import coarse_mesh, extrapolated, tools_text
from umform.processes.air_bending.section import Section
from umform.processes.bend_sequence.part import Part, after
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming.spec import Hemming
from umform.results.outcome import Outcome
from umform.results.quantity import Quantity, quantities_of
from umform.sheet_metals import sheet_text

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class HemMeasures:
    """Measures of a hem; their order is that of tables, docs/bending-operations.md defines them."""

    force: Annotated[float, Quantity("force", "N/mm", 1)]
    """Force of the plate per length of hem at the end of its travel."""
    largest_force: Annotated[float, Quantity("largest force", "N/mm", 1, leading=True)]
    """The largest one."""
    loaded_height: Annotated[float, Quantity("height under load", "mm", 3)]
    """Outer height of the hem with the plate on it."""
    height: Annotated[float, Quantity("height", "mm", 3, leading=True)]
    """The same after unloading."""
    springback: Annotated[float, Quantity("springback", "mm", 3, leading=True)]
    """Their difference."""
    tip_gap: Annotated[float, Quantity("gap at the tip", "mm", 3, leading=True)]
    """Gap between flange and base at the tip of the flange, after unloading."""
    loop_gap: Annotated[float, Quantity("largest gap", "mm", 3, leading=True)]
    """The largest one."""
    angle: Annotated[float, Quantity("angle of the flange", "degrees", 2)]
    """Angle between flange and base after unloading; positive: it opens towards the tip."""
    outer_strain: Annotated[float, Quantity("outer strain", "", 4, leading=True)]
    """Largest mean logarithmic strain of an element along the outer face."""
    thinning: Annotated[float, Quantity("smallest thickness ratio", "", 4)]
    """Smallest thickness relative to that of the flat sheet."""


@dataclass(frozen=True, repr=False)
class Hem(Outcome):
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
    result: Result
    problem: Problem

    def decks(self) -> dict[str, str]:
        """Decks of bend and flattening by the names of their files: `umform run` of both repeats the runs."""
        decks = self.first.decks()
        return decks | {"hem.toml": self.problem.toml(after(*decks))}

    @property
    def title(self) -> str:
        """Heading of tables and pages."""
        case = self.case
        sheet = sheet_text(case.sheet.material, case.sheet.thickness)
        return f"Hem: {sheet}, gap {case.gap:g} mm, {'insert' if case.insert else 'open'}"

    @property
    def with_stroke(self) -> Hemming:
        """The case with the stroke of its first bend in place of its angle."""
        return replace(self.case, sheet=replace(self.case.sheet, stroke=self.first.bends[0].measures.stroke))

    @property
    def strokes(self) -> dict[str, str]:
        """Path of the stroke that was found for the angle of the first bend, by the name of this angle."""
        return {} if self.case.sheet.stroke is not None else {"first_angle": "sheet.stroke"}

    @property
    def quantities(self) -> list[Quantity]:
        """The measures, and the angle of the first bend."""
        first = Quantity("angle of the first bend", "degrees", 2, name="first_angle")
        return [*quantities_of(self.measures), replace(first, value=self.first.bends[0].measures.angle)]

    @property
    def main(self) -> list[str]:
        """The springback of the height."""
        return ["springback"]

    @property
    def warnings(self) -> list[str]:
        """Warnings of the first bend and of the flattening."""
        return [*self.first.warnings, *self.result.warnings]

    @property
    def notes(self) -> list[str]:
        """Tools of the first bend, mesh, extrapolated flow curve."""
        sheet = self.case.sheet
        return [tools_text(sheet), *coarse_mesh(sheet), *extrapolated(sheet, self.measures.outer_strain)]

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
