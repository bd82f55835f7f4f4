"""Result of hemming."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.problem.problem import Problem
from umform.processes.air_bending.remarks import coarse_mesh, extrapolated, of_this_mesh, tools_text
from umform.processes.air_bending.section import Section
from umform.processes.air_bending.sheet import studied_mesh
from umform.processes.bend_sequence.part import Part, after
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming.spec import Hemming, acute
from umform.results.outcome import Outcome
from umform.results.quantity import FORCE_PER_LENGTH, GIVEN, Quantity, quantities_of
from umform.results.studies import StudiedMesh
from umform.sheet_metals import sheet_text

Floats = NDArray[np.float64]

#: Gap that is left in a closed hem under load, or height beyond the wanted one, over the thickness.
_CLOSED = 0.01
#: Parameters of files and pages.
_IN_FILES = ("form", "gap", "force", "flange", "base", "insert_edge", "loop_length", "angle")
#: Measures that a force of the plate gives.
_PRESSED = ("force", "largest_force")


@dataclass(frozen=True)
class HemMeasures:
    """Measures of a hem; their order is that of tables, docs/bending-operations.md defines them."""

    force: Annotated[float, Quantity("force", FORCE_PER_LENGTH, 1)]
    """Force of the plate per length of hem at the end of its travel."""
    largest_force: Annotated[float, Quantity("largest force", FORCE_PER_LENGTH, 1, leading=True)]
    """Largest force of the plate per length of hem."""
    loaded_height: Annotated[float, Quantity("height under load", "mm", 3)]
    """Outer height of the hem with the plate on it."""
    height: Annotated[float, Quantity("height", "mm", 3, leading=True)]
    """The same after unloading."""
    springback: Annotated[float, Quantity("springback", "mm", 3, leading=True)]
    """Height after unloading less that under load."""
    left: Annotated[float, Quantity("gap left under load", "mm", 3, leading=True)]
    """Largest gap under the outer half of the flange, with the plate on it: to the base, the inner sheet or the insert;
    in a rope hem the smallest gap to the base."""
    tip_gap: Annotated[float, Quantity("gap at the tip", "mm", 3, leading=True)]
    """Gap between flange and base at the tip of the flange, after unloading."""
    loop_gap: Annotated[float, Quantity("largest gap", "mm", 3, leading=True)]
    """Largest gap between flange and base, after unloading."""
    angle: Annotated[float, Quantity("angle of the flange", "degrees", 2)]
    """Angle between flange and base after unloading; positive: it opens towards the tip."""
    roll_in: Annotated[float, Quantity("roll-in", "mm", 3, leading=True)]
    """How far the outermost point of the fold lies within the bend line of the flat sheet, after unloading; negative:
    beyond it (roll-out)."""
    creep: Annotated[float, Quantity("creep", "mm", 3)]
    """How far the outermost point has moved towards the base since the first bend; negative: away from it."""
    outer_strain: Annotated[float, Quantity("outer strain", "", 4, leading=True)]
    """Largest mean logarithmic strain of an element along the outer face."""
    inner_strain: Annotated[float, Quantity("inner strain", "", 4)]
    """Smallest mean logarithmic strain of an element along the inner face."""
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
        Travel of the plate and its force per length of hem in kN/m, all converged increments.
    loaded, strip : Strip
        The section under load and after unloading, the base on z = 0.
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
    loaded: Strip
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
        gap = "" if case.form in ("flat", "rope") else f", gap {case.gap:g} mm"
        pressed = "" if case.force is None else f", {case.force:g} {FORCE_PER_LENGTH}"
        return f"Hem: {sheet}, {case.form}{gap}{pressed}"

    @property
    def given(self) -> dict[str, object]:
        """Parameters of the hem beside those of its sheet."""
        return {name: getattr(self.case, name) for name in _IN_FILES}

    @property
    def with_stroke(self) -> Hemming:
        """The case with the stroke of its first bend in place of its angle."""
        return replace(self.case, sheet=replace(self.case.sheet, stroke=self.first.bends[0].measures.stroke))

    @property
    def strokes(self) -> dict[str, str]:
        """Path of the stroke that was found for the angle of the first bend, by the name of this angle."""
        return self.case.strokes

    @property
    def quantities(self) -> list[Quantity]:
        """The measures, and the angle of the first bend: a goal, unless the sheet has a stroke."""
        first = Quantity("angle of the first bend", "degrees", 2, name="first_angle")
        angle = replace(first, value=self.first.bends[0].measures.angle)
        wanted = self.case.sheet.stroke is None
        found = self.banded([*quantities_of(self.measures), *[angle] * wanted])
        found = of_this_mesh(self.case.sheet, found, acute())
        if self.case.force is not None:
            found = [replace(one, band=GIVEN) if one.name in _PRESSED else one for one in found]
        return found if wanted else [*found, replace(angle, band=self._band(angle, None), of_mesh=True)]

    @property
    def studied(self) -> StudiedMesh | None:
        """Mesh beside those of the studies of such hems."""
        sheet = self.case.sheet
        found = studied_mesh(sheet, process=self.case.study, like=acute())
        return None if found is None else replace(found, length=sheet.thickness)

    @property
    def is_closed(self) -> bool:
        """Whether at most a hundredth of the thickness is left under load."""
        return self.measures.left <= _CLOSED * self.case.sheet.thickness

    @property
    def main(self) -> list[str]:
        """The springback of the height."""
        return ["springback"]

    @property
    def warnings(self) -> list[str]:
        """Warnings of the first bend and of the flattening, and a hem that is not closed, or not to its gap."""
        return [*self.first.warnings, *self.result.warnings, *self._about_the_gap()]

    def _about_the_gap(self) -> list[str]:
        left, above = self.measures.left, self.measures.loaded_height - self.case.height
        if self.case.is_closed:
            open_ = f"the hem is not closed: {left:.3f} mm are left between the flange and what it lies on, under load"
            return [] if self.is_closed else [open_]
        if self.case.force is None or above <= _CLOSED * self.case.sheet.thickness:
            return []
        return [
            f"the force stops the plate {above:.3f} mm above the wanted height: {left:.3f} mm are left between the "
            "flange and what it lies on, under load"
        ]

    @property
    def notes(self) -> list[str]:
        """Whether it closed, tools of the first bend, mesh, extrapolated flow curve."""
        sheet, closed = self.case.sheet, self.case.is_closed and self.is_closed
        said = [f"closed under load, to {_CLOSED:g} of the thickness"] if closed else []
        mesh, curve = coarse_mesh(sheet, acute()), extrapolated(sheet, self.measures.outer_strain)
        return [*said, tools_text(sheet), *mesh, *curve]

    @property
    def gaps(self) -> list[list[float]]:
        """Rows of flat distance from the tip of the flange, gap to the base under load, and after unloading."""
        pressed, free = (gap_along(self.case, strip) for strip in (self.loaded, self.strip))
        count = min(len(pressed), len(free))
        rows: list[list[float]] = np.column_stack([pressed[:count], free[:count, 1]]).round(5).tolist()
        return rows

    @property
    def stages(self) -> dict[str, Result]:
        """The first bend and the flattening."""
        return {"first bend": self.first.bends[0].result, "flattening": self.result}

    @property
    def profile(self) -> Floats:
        """Outline (n, 2): the outer face from the tip of the flange to the end of the base, then the inner face."""
        return self.strip.outline

    @property
    def beside(self) -> list[Floats]:
        """Outline (n, 2) of the inner sheet, if there is one."""
        inner = "y0 of inner"
        model = self.result.model
        return [Strip.of(model.mesh, model.u, inner).outline] if inner in model.mesh.sets else []


def measured(case: Hemming, force: Floats, start: Strip, loaded: Strip, released: Strip) -> HemMeasures:
    """Measures from the force, and the section before flattening, under load, and after unloading."""
    gaps, pressed = clearances(case, released), clearances(case, loaded)
    section = Section(released.reference, released.current, released.order)
    x = released.middle[released.reference[:, 0, 0] <= 0.5 * case.flange]
    along = np.linalg.svd(x - x.mean(axis=0))[2][0]
    heights = [_height(case, strip) for strip in (loaded, released)]
    filled = case.gap if case.form in ("inner", "insert") else 0.0
    outer = pressed[: max(1, int((released.reference[:, 0, 0] <= 0.5 * case.flange).sum()))]
    outer_strains, inner_strains = (
        np.log(section.element_lengths(height) / section.element_references) for height in (0.0, 1.0)
    )
    inside = [_inside(case, strip) for strip in (start, released)]
    return HemMeasures(
        force=float(force[-1]),
        largest_force=float(force.max()),
        loaded_height=heights[0],
        height=heights[1],
        springback=heights[1] - heights[0],
        left=float(outer.min() if case.form == "rope" else outer.max()) - filled,
        tip_gap=float(gaps[0]),
        loop_gap=float(gaps.max()),
        angle=math.degrees(math.atan(along[1] / along[0])),
        roll_in=inside[1],
        creep=inside[1] - inside[0],
        outer_strain=float(outer_strains.max()),
        inner_strain=float(inner_strains.min()),
        thinning=float(section.thicknesses[1:-1].min()),
    )


def _inside(case: Hemming, strip: Strip) -> float:
    """Distance of the outermost point of the outer face from the bend line, which is the base from its end."""
    return float(strip.current[:, 0, 0].min() - (strip.current[-1, :, 0].mean() - case.base))


def clearances(case: Hemming, strip: Strip) -> Floats:
    """Distance of the inner face of the flange from that of the base at lines of nodes, from the tip to the bend."""
    return gap_along(case, strip)[:, 1]


def gap_along(case: Hemming, strip: Strip) -> Floats:
    """Rows of flat distance from the tip and gap, at lines of nodes of the flange that lie above the base."""
    s = strip.reference[:, 0, 0]
    flange, base = strip.current[s < case.flange, -1], strip.current[s > case.flange, -1]
    over = flange[:, 0] >= base[0, 0]
    gap = flange[over, 1] - np.interp(flange[over, 0], base[:, 0], base[:, 1])
    return np.column_stack([s[s < case.flange][over], gap])


def _height(case: Hemming, strip: Strip) -> float:
    """Largest height of the flange above the outer face of the base below it."""
    s = strip.reference[:, 0, 0]
    base = strip.current[s > case.flange, 0]
    return float(strip.current[s <= case.flange, 0, 1].max() - base[:, 1].min())
