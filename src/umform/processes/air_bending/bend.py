"""Result of a bend: measures, curve, sections, and the run."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.processes.air_bending.formulas import RULE, shop_forces
from umform.processes.air_bending.loading import force_per_width, loading
from umform.processes.air_bending.measures import Measures, measure
from umform.processes.air_bending.remarks import STROKES, depth_text, of_this_mesh, remarks, tools_text, total_force
from umform.processes.air_bending.section import Section
from umform.processes.air_bending.sheet import studied_mesh
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import edges_of
from umform.processes.air_bending.stacked import SheetOfStack, quantities_of_stack, stack_of, table_of_stack
from umform.results.budget import Budget
from umform.results.outcome import Outcome
from umform.results.quantity import FORCE_PER_LENGTH, GIVEN, Band, Quantity, in_rows, quantities_of
from umform.results.studies import StudiedMesh
from umform.sheet_metals import sheet_text

Floats = NDArray[np.float64]
#: Penetration, relative to the thickness, that is reported.
_DEEP = 0.02
_STROKE = "for the stroke, that of the angle over its change with the stroke"
#: Columns of a bending table.
_TABLE = ("stroke", "loaded_angle", "angle", "springback", "force", "radius", "k_factor", "bend_deduction")


@dataclass(frozen=True)
class Loaded:
    """State under load.

    Attributes
    ----------
    stroke, force, largest_force : float
        Stroke of the punch in mm, its force per length of bend in kN/m, and the largest force so far.
    section : Section
        The bent section.
    against : str
        Tool whose flank touches the sheet: "die", "punch" or none.
    """

    stroke: float
    force: float
    largest_force: float
    section: Section
    against: str

    @property
    def angle(self) -> float:
        """Angle between the legs in degrees."""
        return self.section.angle

    def measured(self, released: Section, height: float) -> Measures:
        """Measures with the section after unloading, of sheets that are so thick together."""
        return measure(self.stroke, self.force, self.largest_force, self.section, released, height)


@dataclass(frozen=True, repr=False)
class AirBend(Outcome):
    """A bend.

    Attributes
    ----------
    case : AirBending
        The parameters.
    measures : Measures
        What is measured.
    step : ndarray of int, shape (n,)
        1 loading, 2 unloading; 0 the start.
    stroke, force : ndarray, shape (n,)
        Stroke of the punch in mm and its force per length of bend in kN/m, all converged increments.
    loaded, released : Section
        The section under load and after unloading.
    path : ndarray, shape (m, 2)
        Stroke and angle under load.
    against : str
        Tool whose flank touches the sheet at the stroke: "die", "punch" or none. With a contact it is no air bending.
    result : Result
        History, frames and iterations.
    table : tuple of Measures
        Bending table: other strokes, if they were asked for.
    budget : Budget, optional
        Error budget, if it was asked for.
    bend_length : float, optional
        Length of the bend in mm for the total force; the model does not know it.
    searched : str
        Result for which the stroke was found, such as "angle"; empty if it was given.
    stack : tuple of SheetOfStack
        Each of several sheets, from the die upwards; measures and sections are those of the first.
    """

    case: AirBending
    measures: Measures
    step: NDArray[np.int64]
    stroke: Floats
    force: Floats
    loaded: Section
    released: Section
    path: Floats
    against: str
    result: Result
    table: tuple[Measures, ...] = ()
    budget: Budget | None = None
    bend_length: float | None = None
    searched: str = ""
    stack: tuple[SheetOfStack, ...] = ()

    @classmethod
    def of(cls, case: AirBending, result: Result, loaded: Loaded, measures: Measures) -> Self:
        """The bend of a case from its run: the steps of the loading, then the unloading."""
        number = result["step"].astype(np.int64)
        step = np.where(number > len(loading(case, loaded.stroke)), 2, np.minimum(number, 1))
        stroke, model = result["stroke"], result.model
        under_load = [frame for frame in result.frames if step[frame.number] < 2]
        edges = edges_of(case)
        sections = Section.each(model.mesh, (frame.points["displacement"] for frame in under_load), edges)
        angles = [section.angle for section in sections]
        return cls(
            case=case,
            measures=measures,
            step=step,
            stroke=stroke,
            force=force_per_width(case, result["stroke_force"]),
            loaded=loaded.section,
            released=Section.of(model.mesh, model.u, edges),
            path=np.array([[stroke[frame.number], angle] for frame, angle in zip(under_load, angles, strict=True)]),
            against=loaded.against,
            result=result,
            stack=stack_of(case, result, under_load[-1].points["displacement"]) if case.on_top else (),
        )

    @property
    def total_force(self) -> float | None:
        """Largest force in N on the length of the bend, or on the whole width; None without either."""
        length = self.case.width if self.bend_length is None else self.bend_length
        return None if length is None else self.measures.largest_force * length

    @property
    def title(self) -> str:
        """Heading of tables and pages."""
        case = self.case
        sheet = " + ".join(sheet_text(one.material, one.thickness) for one in case.sheets)
        long = "" if self.bend_length is None else f", {self.bend_length:g} mm long"
        return f"Air bending: {sheet}{long}, {case.opening:g} mm opening, {self['angle'].full_text}"

    @property
    def quantities(self) -> list[Quantity]:
        """The measures, and the force on the length of the bend or on the width."""
        bands = None if self.budget is None else self.budget.bands
        found = quantities_of(self.measures, bands)
        if self.total_force is not None:
            wide = self.bend_length is None
            label, name = ("force on the width", "force_on_width") if wide else ("total force", "total_force")
            found.insert(3, Quantity(label, "kN", 2, name=name, value=self.total_force / 1e3, leading=True))
        found = self._with_strokes(self.banded(found))
        return of_this_mesh(self.case, [*found, *quantities_of_stack(self.stack, bands)])

    def _with_strokes(self, found: list[Quantity]) -> list[Quantity]:
        """The same with the error of a stroke found for an angle: that of the angle over its change with the stroke."""
        if not self.searched:
            given = self.case.stroke is not None
            return [replace(one, band=GIVEN) if given and one.name in STROKES else one for one in found]
        angle = next(one for one in found if one.name == "angle").band
        way, turned = np.diff(self.path[-2:], axis=0)[0] if len(self.path) > 1 else (0.0, 0.0)
        if angle is None or self.searched != "angle" or self.case.bottoming or not way > 0.0 or not turned < 0.0:
            return found
        band = Band(-angle.error * way / turned, _STROKE)
        return [replace(one, band=band) if one.name in STROKES and not one.band else one for one in found]

    @property
    def studied(self) -> StudiedMesh | None:
        """Mesh beside those of the studies, which have one sheet and no bottoming."""
        return None if self.case.bottoming or self.stack else studied_mesh(self.case, self.measures.outer_strain)

    @property
    def main(self) -> list[str]:
        """The angle, and the springback."""
        return ["angle", "springback"]

    @property
    def tables(self) -> dict[str, list[list[str]]]:
        """The measures, and the bending table."""
        found = [{one.name: one for one in quantities_of(row)} for row in self.table]
        rows = in_rows([[row[name] for name in _TABLE] for row in found])
        sheets = table_of_stack(self.stack)
        return super().tables | ({"Sheets": sheets} if sheets else {}) | ({"Bending table": rows} if rows else {})

    @property
    def notes(self) -> list[str]:
        """Tools, force by the rule of the shop, remarks."""
        low, high = shop_forces(self.case)
        rule = f"the {RULE}, gives {low:.1f} to {high:.1f} {FORCE_PER_LENGTH}; choose the press by the larger force"
        total = [] if self.bend_length is None else [total_force(self.measures.largest_force, self.bend_length)]
        depth = depth_text(self.measures.below_die)
        return [depth, tools_text(self.case), rule, *remarks(self.case, self.measures), *total]

    @property
    def stages(self) -> dict[str, Result]:
        """The run by its name."""
        return {"bend": self.result}

    @property
    def force_balance(self) -> float:
        """Relative difference of the forces of punch and die at the stroke; NaN without a force."""
        at = int(np.flatnonzero(self.step == 1)[-1])
        punch, die = self.result["punch_fz"][at], self.result["die_fz"][at]
        return float(abs(punch + die) / abs(punch)) if punch else math.nan

    @property
    def penetration(self) -> float:
        """Largest penetration of die and punch."""
        return max(float(self.result[f"{tool}_penetration"].max()) for tool in ("die", "punch"))

    @property
    def warnings(self) -> list[str]:
        """Warnings."""
        lying = f"the sheet lies against a flank of the {self.against}: this is no air bending any more"
        hollow = "the sheet does not lie on the flanks of the die: this is no bottoming yet"
        deep = (
            f"the tools penetrate by {self.penetration:.3g}: so much of the stroke is lost; take a smaller penetration"
        )
        flat = "the sheet springs back flat: radius, K-factor and what follows cannot be determined: a larger stroke"
        exceeded = any("the penetration of" in warning for warning in self.result.warnings)
        found = {
            lying: bool(self.against) and not self.case.bottoming,
            hollow: self.case.bottoming and not self.against,
            deep: self.penetration > _DEEP * self.case.thickest and not exceeded,
            flat: not self.released.is_bent,
        }
        failures = {} if self.budget is None else self.budget.failures
        failed = (f"{name}: {why}" for name, why in failures.items())
        return [*(text for text, holds in found.items() if holds), *self.result.warnings, *failed]
