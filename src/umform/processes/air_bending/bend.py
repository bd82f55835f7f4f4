"""Result of a bend: measures, curve, sections, and the run."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from umform.processes.air_bending.brake import force_per_width, loading
from umform.processes.air_bending.measures import Measures, measure
from umform.processes.air_bending.section import Section
from umform.processes.air_bending.spec import AirBending
from umform.run import Result

Floats = NDArray[np.float64]
#: Penetration, relative to the thickness, that is reported.
_DEEP = 0.02


@dataclass(frozen=True)
class Loaded:
    """State under load.

    Attributes
    ----------
    stroke, force, largest_force : float
        Stroke of the punch in mm, its force per length of bend in N/mm, and the largest force so far.
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

    def measured(self, released: Section) -> Measures:
        """Measures with the section after unloading."""
        return measure(self.stroke, self.force, self.largest_force, self.section, released)


@dataclass(frozen=True)
class AirBend:
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
        Stroke of the punch in mm and its force per length of bend in N/mm, all converged increments.
    loaded, released : Section
        The section under load and after unloading.
    path : ndarray, shape (m, 2)
        Stroke and angle under load.
    against : str
        Tool whose flank touches the sheet at the stroke: "die", "punch" or none. With a contact it is no air bending.
    result : Result
        History, frames and iterations.
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

    @classmethod
    def of(cls, case: AirBending, result: Result, loaded: Loaded, measures: Measures) -> Self:
        """The bend of a case from its run: the steps of the loading, then the unloading."""
        number = result["step"].astype(np.int64)
        step = np.where(number > len(loading(case, loaded.stroke)), 2, np.minimum(number, 1))
        stroke, model = result["stroke"], result.model
        under_load = [frame for frame in result.frames if step[frame.number] < 2]
        sections = Section.each(model.mesh, (frame.points["displacement"] for frame in under_load))
        angles = [section.angle for section in sections]
        return cls(
            case=case,
            measures=measures,
            step=step,
            stroke=stroke,
            force=force_per_width(case, result["stroke_force"]),
            loaded=loaded.section,
            released=Section.of(model.mesh, model.u),
            path=np.array([[stroke[frame.number], angle] for frame, angle in zip(under_load, angles, strict=True)]),
            against=loaded.against,
            result=result,
        )

    @property
    def total_force(self) -> float | None:
        """Largest force on the whole width in N; None in plane strain."""
        return None if self.case.width is None else self.measures.largest_force * self.case.width

    @property
    def stages(self) -> dict[str, Result]:
        """The run by its name."""
        return {"bend": self.result}

    @property
    def iterations(self) -> int:
        """Number of Newton iterations."""
        return int(self.result["iterations"].sum())

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
            deep: self.penetration > _DEEP * self.case.thickness and not exceeded,
            flat: not self.released.is_bent,
        }
        return [*(text for text, holds in found.items() if holds), *self.result.warnings]
