"""One bend: loaded to the stroke, unloaded, measured."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.processes.air_bending.brake import OPTIONS, against_flank, build, force_per_width, loading, unloading
from umform.processes.air_bending.checks import needed_stroke
from umform.processes.air_bending.measures import Measures, measure
from umform.processes.air_bending.parameters import AirBending
from umform.processes.air_bending.section import Section
from umform.run import Result, solve
from umform.steps import Move, Release

Floats = NDArray[np.float64]
#: Penetration, in thicknesses, that is worth a word.
_DEEP = 0.02


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
        Way of the punch in mm and its force in N for each mm of the bend, all converged increments.
    loaded, released : Section
        The section under load and after unloading.
    path : ndarray, shape (m, 2)
        Stroke and angle under load.
    against : str
        Tool against whose flank the sheet lies at the stroke: "die", "punch" or none; then it is no air bending.
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

    @property
    def total_force(self) -> float | None:
        """Largest force on the whole width in N; None in plane strain."""
        return None if self.case.width is None else self.measures.largest_force * self.case.width

    @property
    def iterations(self) -> int:
        """Number of Newton iterations."""
        return int(self.result["iterations"].sum())

    @property
    def force_balance(self) -> float:
        """Force of the punch less that of the die over that of the punch, at the stroke; NaN without a force."""
        at = int(np.flatnonzero(self.step == 1)[-1])
        punch, die = self.result["punch_fz"][at], self.result["die_fz"][at]
        return float(abs(punch + die) / abs(punch)) if punch else math.nan

    @property
    def penetration(self) -> float:
        """Largest penetration of die and punch."""
        return max(float(self.result[f"{tool}_penetration"].max()) for tool in ("die", "punch"))

    @property
    def warnings(self) -> list[str]:
        """What to look at."""
        lying = f"the sheet lies against a flank of the {self.against}: this is no air bending any more"
        deep = (
            f"the tools penetrate by {self.penetration:.3g}: so much of the stroke is lost; take a smaller penetration"
        )
        flat = (
            "the sheet springs back flat: radius, K-factor and all that rests on them cannot be told: a larger stroke"
        )
        exceeded = any("the penetration of" in warning for warning in self.result.warnings)
        found = {
            lying: self.against,
            deep: self.penetration > _DEEP * self.case.thickness and not exceeded,
            flat: not self.released.is_bent,
        }
        return [*(text for text, holds in found.items() if holds), *self.result.warnings]


def air_bending(case: AirBending, *, frames: int = 60, solver: str = "auto", progress: bool | None = None) -> AirBend:
    """Bend a sheet in a V-die to the stroke of the case, and unload it.

    Parameters
    ----------
    case : AirBending
        The parameters, with a stroke.
    frames : int
        About how many states are kept for pictures and for the angle under load, in loading and in unloading.
    solver : str
        Sparse solver.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.

    Returns
    -------
    AirBend
        Measures, curve, sections, and the result with its history and frames.

    Raises
    ------
    InvalidValue
        If the case has no stroke.
    NoConvergence
        If it cannot be continued; the attribute ``result`` holds what was reached.
    """
    stroke_of_case = needed_stroke(case)
    model, punch = build(case)
    steps: list[Move | Release] = [loading(case, punch, stroke_of_case), unloading(case, punch)]
    result = solve(model, steps, solver=solver, options=OPTIONS, frames=max(1, frames), progress=progress)
    step = result["step"].astype(np.int64)
    stroke, force = result["stroke"], force_per_width(case, -result["stroke_force"])
    under_load = [frame for frame in result.frames if step[frame.number] < 2]
    sections = [Section.of(model.mesh, frame.points["displacement"]) for frame in under_load]
    last = under_load[-1].number
    return AirBend(
        case=case,
        measures=measure(stroke_of_case, float(force[last]), float(force[: last + 1].max()), sections[-1], model),
        step=step,
        stroke=stroke,
        force=force,
        loaded=sections[-1],
        released=Section.of(model.mesh, model.u),
        path=np.array([[stroke[f.number], s.angle] for f, s in zip(under_load, sections, strict=True)]),
        against=against_flank(case, under_load[-1].contacts),
        result=result,
    )
