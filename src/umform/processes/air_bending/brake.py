"""The press brake: a model of sheet, die and punch; loading to a stroke, and unloading as a branch that is undone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.model import Model
from umform.model.contact import ContactPoints
from umform.model.control import Control
from umform.model.state import Snapshot
from umform.processes.air_bending.measures import Measures, measure
from umform.processes.air_bending.parameters import AirBending
from umform.processes.air_bending.section import Section
from umform.processes.air_bending.sheet import half_sheet
from umform.run import Result, solve
from umform.solution.options import NewtonOptions
from umform.steps import Move
from umform.steps.release import Release

#: Towards zero force the sheet rests on single rows of contact points, and plain Newton jumps between two rows.
OPTIONS = NewtonOptions(line_search=True)
#: Force that counts as zero, as a part of the force before unloading: the angle is then off by about 0.001 degrees.
_ZERO_FORCE = 2e-3
#: First increment of the way back in thicknesses.
_FIRST_BACK = 0.005


@dataclass(frozen=True)
class Loaded:
    """State under load.

    Attributes
    ----------
    stroke, force : float
        Way of the punch in mm, and its force in N for each mm of the bend.
    section : Section
        The bent section.
    against : str
        Tool against whose flank the sheet lies: "die", "punch" or none.
    """

    stroke: float
    force: float
    section: Section
    against: str

    @property
    def angle(self) -> float:
        """Angle between the legs in degrees."""
        return self.section.angle


def build(case: AirBending) -> tuple[Model, Control]:
    """Model of a case, and the control that moves the punch down."""
    mesh = half_sheet(case)
    model = Model(mesh, case.element, material=case.material, thickness_points=case.thickness_points)
    model.symmetry("x0", normal="x")
    if case.width is None:
        model.fix(np.arange(len(mesh.points)), "y")
    else:
        model.symmetry("y0", normal="y")
    penalty, depth, points = case.penalty, case.penetration, case.contact_points
    model.contact("lower", case.die, penalty=penalty, penetration=depth, points=points, name="die")
    punch = model.contact("upper", case.punch, penalty=penalty, penetration=depth, points=points, name="punch")
    return model, model.drive(punch, "-z", name="stroke")


def loading(case: AirBending, punch: Control, stroke: float) -> Move:
    """Step that moves the punch to a stroke in increments of the case."""
    return Move(punch, to=stroke, steps=increments(case, abs(stroke - punch.value)))


def increments(case: AirBending, way: float) -> int:
    """Increments that a way of the punch takes."""
    return max(1, math.ceil(way / case.way - 1e-9))


def unloading(case: AirBending, punch: Control) -> Release:
    """Step that takes the punch back until its force is zero."""
    return Release(punch, **unloading_keys(case))


def unloading_keys(case: AirBending) -> dict[str, float]:
    """First increment and tolerance of the way back."""
    return {"increment": _FIRST_BACK * case.thickness, "tolerance": _ZERO_FORCE}


def force_per_width(case: AirBending, force: NDArray[np.float64]) -> NDArray[np.float64]:
    """Force on the whole sheet for each mm of the bend, from the force on the modelled part."""
    modelled = case.thickness if case.width is None else 0.5 * case.width
    return 2.0 / modelled * force


def against_flank(case: AirBending, contacts: Mapping[str, ContactPoints]) -> str:
    """Tool, "die" or "punch", that the sheet touches on its flank, a quarter of a thickness beyond the radius."""
    beyond = 0.25 * case.thickness
    die, punch = (0.5 * math.radians(180.0 - angle) for angle in (case.die_angle, case.punch_angle))
    x_die = contacts["die"].x[contacts["die"].gap <= 0.0, 0]
    if (x_die < case.shoulder - case.die_radius * math.sin(die) - beyond * math.cos(die)).any():
        return "die"
    x_punch = contacts["punch"].x[contacts["punch"].gap <= 0.0, 0]
    return "punch" if (x_punch > case.punch_radius * math.sin(punch) + beyond * math.cos(punch)).any() else ""


class Brake:
    """A sheet between die and punch that remembers the states under load it has been in.

    Parameters
    ----------
    case : AirBending
        The parameters; the stroke is not used.
    solver : str
        Sparse solver.
    """

    def __init__(self, case: AirBending, solver: str = "auto") -> None:
        self.case = case
        self.solver = solver
        self.model, self.punch = build(case)
        self.iterations = 0
        self.forces: dict[float, float] = {0.0: 0.0}
        self._saved: dict[float, Snapshot] = {0.0: self.model.snapshot()}
        self._loaded: Loaded | None = None

    def load(self, stroke: float) -> Loaded:
        """Load to a stroke, from the nearest remembered state at or below it.

        Raises
        ------
        NoConvergence
            If the sheet cannot be bent so far.
        """
        nearest = max(known for known in self._saved if known <= stroke)
        if self.punch.value != nearest:
            self.model.restore(self._saved[nearest])
        if stroke > nearest:
            result = self._solve(loading(self.case, self.punch, stroke))
            forces = force_per_width(self.case, -result["stroke_force"])
            self.forces |= dict(zip(result["stroke"].tolist(), forces.tolist(), strict=True))
            self._saved[stroke] = self.model.snapshot()
        else:
            self.model.evaluate(self.model.u)
        section = Section.of(self.model.mesh, self.model.u)
        force = self.forces[self.punch.value]
        contacts = {contact.name: contact.at_points() for contact in self.model.contacts}
        self._loaded = Loaded(stroke, force, section, against_flank(self.case, contacts))
        return self._loaded

    def unload(self) -> Measures:
        """Measures after unloading from the present state under load, which is then put back.

        Raises
        ------
        NoConvergence
            If the punch cannot be taken back.
        """
        state = self._loaded or self.load(self.punch.value)
        before = self.model.snapshot()
        try:
            self._solve(unloading(self.case, self.punch))
            largest = max(force for stroke, force in self.forces.items() if stroke <= state.stroke)
            return measure(state.stroke, state.force, largest, state.section, self.model)
        finally:
            self.model.restore(before)

    def _solve(self, step: Move | Release) -> Result:
        result = solve(self.model, step, solver=self.solver, options=OPTIONS, frames=0, progress=False)
        self.iterations += int(result["iterations"].sum())
        return result
