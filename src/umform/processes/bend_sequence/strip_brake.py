"""A strip in the tools of one bend: placed with its state, bent and unloaded like a single sheet."""

from __future__ import annotations

from umform.analysis.run import Result
from umform.mesh import Mesh
from umform.model import Model
from umform.model.terms.control import Control
from umform.problem.problem import Problem
from umform.processes.air_bending.bend import Loaded
from umform.processes.air_bending.brake import Brake, Floats
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.section import Section
from umform.processes.bend_sequence.one_bend import measures_of, placed_problem
from umform.processes.bend_sequence.sides import Sides, Strip
from umform.processes.bend_sequence.spec import Bend, BendSequence
from umform.progress import Tick, silent


class StripBrake(Brake):
    """A strip in the tools of a bend.

    Parameters
    ----------
    sequence : BendSequence
        The part.
    bend : Bend
        The bend.
    mesh : Mesh
        Mesh of the flat strip.
    before : Result, optional
        Run of the previous bend; None for the flat strip.
    frames : int
        Approximate number of states kept for pictures.
    """

    def __init__(
        self, sequence: BendSequence, bend: Bend, mesh: Mesh, before: Result | None = None, frames: int = 0
    ) -> None:
        self.sequence, self.bend_line, self.mesh, self.before = sequence, bend, mesh, before
        self._sides: Sides | None = None
        self._loaded_sides: Sides | None = None
        super().__init__(sequence.case(bend), frames=frames)

    def build(self) -> tuple[Model, Control]:
        """Model of the strip in the tools, and the control that moves the punch down."""
        made = self.problem(self.case.way).build()
        return made.model, made.controls["stroke"]

    def problem(self, stroke: float) -> Problem:
        """The bend as a problem."""
        return placed_problem(self.sequence, self.bend_line, stroke, self.before, self.mesh)

    def section(self) -> Section:
        """Right side of the bend, in a frame in which both legs have the same slope."""
        bend = self.bend_line
        strip = Strip.of(self.mesh, self.model.u).at(bend.position, over=bend.over)
        self._sides = strip.sides(self.sequence.zone(bend))
        return self._sides.right

    def forces(self) -> Floats:
        """Force of the punch per length of bend in kN/m, all increments so far."""
        found: Floats = self.run.result["stroke_force"] / self.case.thickness
        return found

    def load(self, stroke: float, tick: Tick = silent) -> Loaded:
        """Load to a stroke, from the nearest kept state below it."""
        state = super().load(stroke, tick)
        self._loaded_sides = self._sides
        return state

    def unload(self) -> Measures:
        """Measures after unloading: means of both sides, except the largest strain and the smallest thickness."""
        right = super().unload()
        assert self._loaded_sides is not None and self._sides is not None
        return measures_of(self._loaded_sides, self._sides, right.stroke, right.force, right.largest_force)
