"""A strip in the tools of one bend: placed with its state, bent and unloaded like a single sheet."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from umform.mesh import Mesh
from umform.model import Model, Snapshot
from umform.model.control import Control
from umform.processes.air_bending.bend import Loaded
from umform.processes.air_bending.brake import touching
from umform.processes.air_bending.branches import Brake, Floats
from umform.processes.air_bending.measures import Measures, measure
from umform.processes.air_bending.section import Section
from umform.processes.bend_sequence.sides import Sides, Strip
from umform.processes.bend_sequence.spec import Bend, BendSequence
from umform.progress import Tick, silent
from umform.run import Result
from umform.run.stages import continued


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
        case, bend = self.case, self.bend_line
        model = Model(
            self.mesh,
            case.element,
            material=case.material,
            thickness_points=case.thickness_points,
            rolling=case.rolling_direction,
            plane_strain=case.plane_strain,
        )
        u = np.zeros(3 * len(self.mesh.points)) if self.before is None else self.before.model.u
        lying = Strip.of(self.mesh, u).at(bend.position, over=bend.over).laid(case.reach)
        if self.before is None:
            model.system.restore(Snapshot(lying.displacement(self.mesh.points, u)))
        else:
            continued(model, self.before, lying)
        model.fix(np.arange(len(self.mesh.points)), "y", here=True)
        model.fix(self._under_the_tip(), "x", here=True, name="stop")
        die, punch = self._settings()
        lower, upper = ("upper", "lower") if bend.over else ("lower", "upper")
        model.contact(self._faces(lower), case.die, name="die", **die)
        pushed = model.contact(self._faces(upper), case.punch, name="punch", **punch)
        stroke = model.drive(pushed, "-z", name="stroke")
        if self.before is not None:  # a bent strip is not flat enough to touch both shoulders at first
            model.rest()
        return model, stroke

    def _settings(self) -> list[dict[str, Any]]:
        """Penalty and points of die and punch: those of a single bend with undeformed sheet."""
        single = touching(self.case)
        self.allowed = {name: settings.allowed for name, settings in single.items()}
        return [{"penalty": settings.penalty, "points": settings.points} for settings in single.values()]

    def _faces(self, name: str) -> Any:
        """Faces of the strip about the bend line."""
        rows = self.mesh.face_set(name)
        centres = self.mesh.points[self.mesh.facets_of(rows)].mean(axis=1)
        return rows[np.abs(centres[:, 0] - self.bend_line.position) <= self.sequence.zone(self.bend_line)]

    def _under_the_tip(self) -> Any:
        """Nodes of the bend line on the face that the punch touches: friction on its tip holds the strip."""
        x = self.mesh.points
        height = 0.0 if self.bend_line.over else self.case.thickness
        close = 1e-6 * self.case.thickness
        return (np.abs(x[:, 0] - self.bend_line.position) < close) & (np.abs(x[:, 2] - height) < close)

    def section(self) -> Section:
        """Right side of the bend, in a frame in which both legs have the same slope."""
        bend = self.bend_line
        strip = Strip.of(self.mesh, self.model.u).at(bend.position, over=bend.over)
        self._sides = strip.sides(self.sequence.zone(bend))
        return self._sides.right

    def forces(self) -> Floats:
        """Force of the punch per length of bend in N/mm, all increments so far."""
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
        loaded, released = self._loaded_sides, self._sides
        assert loaded is not None and released is not None
        left = measure(right.stroke, right.force, right.largest_force, loaded.left, released.left)
        both = {f.name: (getattr(right, f.name), getattr(left, f.name)) for f in fields(Measures)}
        mean = {name: 0.5 * (a + b) for name, (a, b) in both.items()}
        return Measures(**{**mean, "outer_strain": max(both["outer_strain"]), "thinning": min(both["thinning"])})
