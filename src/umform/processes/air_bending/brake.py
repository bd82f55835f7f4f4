"""A sheet that is loaded once and unloaded from several strokes: branches of one run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run.loose import carry_loose_sheet
from umform.analysis.run.open_run import Mark, OpenRun
from umform.analysis.steps import Move
from umform.model import Model
from umform.model.terms.control import Control
from umform.processes.air_bending.bend import AirBend, Loaded
from umform.processes.air_bending.loading import (
    INCREMENTS,
    OPTIONS,
    against_flank,
    force_per_width,
    loading,
    part_end,
    unloading,
)
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.problem import build
from umform.processes.air_bending.section import Section
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import edges_of
from umform.progress import Tick, silent

Floats = NDArray[np.float64]

#: About how many states of a bend are kept for pictures.
FRAMES = 60


class Brake:
    """A sheet between die and punch that keeps its states under load.

    Parameters
    ----------
    case : AirBending
        The parameters; the stroke is not used.
    solver : str
        Sparse solver.
    frames : int
        Approximate number of states kept for pictures on the largest stroke; 0 also drops the ends of steps.

    Attributes
    ----------
    run : OpenRun
        The run: loaded, or loaded and unloaded.
    """

    def __init__(self, case: AirBending, solver: str = "auto", frames: int = 0) -> None:
        self.case = case
        self.model, self.punch = self.build()
        carry_loose_sheet(self.model, [Move(self.punch, case.way)])  # a drawn die may be a hair off level
        share = frames * INCREMENTS * case.way / case.largest_stroke
        self.run = OpenRun(self.model, solver=solver, options=OPTIONS, frames=min(frames, max(1, round(share))))
        self._parts: list[Mark] = [self.run.mark()]
        self._done: int | None = 0  # completed steps of the run, if it is at the end of one
        self._loaded: Loaded | None = None

    def build(self) -> tuple[Model, Control]:
        """Model of the sheet in the tools, and the control that moves the punch down."""
        return build(self.case)

    def section(self) -> Section:
        """Section of the first sheet as it is now."""
        return Section.of(self.model.mesh, self.model.u, edges_of(self.case))

    def forces(self) -> Floats:
        """Force of the punch per length of bend in kN/m, all increments up to now."""
        return force_per_width(self.case, self.run.result["stroke_force"])

    def load(self, stroke: float, tick: Tick = silent) -> Loaded:
        """Load to a stroke, from the nearest kept state below it.

        Raises
        ------
        NoConvergence
            If the sheet cannot be bent to the stroke.
        """
        parts = loading(self.case, stroke)
        rest = [] if parts[-1][0] == part_end(self.case, len(parts)) else [parts.pop()]
        known = min(len(parts), len(self._parts) - 1)
        if self._done != known:
            self.run.go_back(self._parts[known])
        for number in range(known, len(parts)):
            self._down(*parts[number], tick)
            self._parts.append(self.run.mark())
        self._done = len(parts)
        for end, count in rest:
            self._down(end, count, tick)
        found = {pair.name: self.run.evaluation.found[pair].points() for pair in self.model.contacts}
        forces, against = self.forces(), against_flank(self.case, found)
        self._loaded = Loaded(stroke, float(forces[-1]), float(forces.max()), self.section(), against)
        return self._loaded

    def _down(self, stroke: float, count: int, tick: Tick) -> None:
        self._done = None
        self.run.take(Move(self.punch, to=stroke, steps=count))
        tick("loading", stroke / self.case.largest_stroke, f"stroke {stroke:.4g}")

    def unload(self) -> Measures:
        """Measures after unloading from the state that `load` has reached.

        Raises
        ------
        NoConvergence
            If unloading does not converge.
        """
        assert self._loaded is not None
        self._done = None
        self.run.take(unloading(self.case, self.punch))
        return self._loaded.measured(self.section(), self.case.height)

    def bend(self, stroke: float, tick: Tick = silent) -> AirBend:
        """Load to a stroke and unload; the run ends there."""
        loaded = self.load(stroke, tick)
        return self.end(loaded, self.unload())

    def end(self, loaded: Loaded, measures: Measures) -> AirBend:
        """The last bend that was loaded and unloaded; the run ends there."""
        return AirBend.of(replace(self.case, stroke=loaded.stroke), self.run.close(), loaded, measures)
