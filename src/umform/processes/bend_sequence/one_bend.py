"""What the run of one bend of a part leaves: measures, forces, states, collisions, warnings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from umform.analysis.run import Result
from umform.mesh import Mesh
from umform.model.transfer.rigid_motion import RigidMotion
from umform.problem.problem import Problem
from umform.processes.air_bending.measures import Measures, measure
from umform.processes.air_bending.problem import touching
from umform.processes.bend_sequence.collisions import collisions
from umform.processes.bend_sequence.part import BendDone
from umform.processes.bend_sequence.problem import problem_of_bend
from umform.processes.bend_sequence.sides import Sides, Strip
from umform.processes.bend_sequence.spec import Bend, BendSequence


def placed_problem(sequence: BendSequence, bend: Bend, stroke: float, before: Result | None, flat: Mesh) -> Problem:
    """The problem of a bend of the strip as the bend before has left it.

    Parameters
    ----------
    sequence, bend
        The part, and its bend.
    stroke : float
        Stroke of the punch.
    before : Result, optional
        Run of the bend before; None for the flat strip.
    flat : Mesh
        Mesh of the flat strip.
    """
    if before is None:  # exact: the tools touch a flat strip by no more than round-off
        turn, top = (-1.0, sequence.sheet.thickness) if bend.over else (1.0, 0.0)
        lying = RigidMotion(np.diag([turn, 1.0, turn]), np.array([-turn * bend.position, 0.0, top]))
    else:
        lying = Strip.of(flat, before.model.u).at(bend.position, over=bend.over).laid(sequence.case(bend).reach)
    return problem_of_bend(sequence, bend, stroke, flat, lying, before)


def measures_of(loaded: Sides, released: Sides, stroke: float, force: float, largest_force: float) -> Measures:
    """Measures of a bend: means of both sides, except the largest strain and the smallest thickness."""
    right = measure(stroke, force, largest_force, loaded.right, released.right)
    left = measure(stroke, force, largest_force, loaded.left, released.left)
    both = {f.name: (getattr(right, f.name), getattr(left, f.name)) for f in fields(Measures)}
    mean = {name: 0.5 * (a + b) for name, (a, b) in both.items()}
    return Measures(**{**mean, "outer_strain": max(both["outer_strain"]), "thinning": min(both["thinning"])})


def bend_done(
    sequence: BendSequence,
    bend: Bend,
    measures: Measures,
    against: str,
    result: Result,
    problem: Problem,
    trials: Sequence[tuple[float, float]] = (),
) -> BendDone:
    """The bend of a run.

    Parameters
    ----------
    sequence, bend
        The part, and its bend.
    measures : Measures
        Its measures.
    against : str
        Tool whose flank the sheet touches under load; or empty.
    result : Result
        Its run.
    problem : Problem
        The problem of the run.
    trials : sequence of tuple of float
        Stroke and angle of each trial.
    """
    mesh, case = result.model.mesh, sequence.case(bend)
    strips = [
        (float(result["stroke"][frame.number]), Strip.of(mesh, frame.points["displacement"])) for frame in result.frames
    ]
    states = [(stroke, strip.at(bend.position, over=bend.over)) for stroke, strip in strips]
    hits = collisions(case, sequence.zone(bend), sequence.bodies, states)
    forces = result["stroke_force"] / case.thickness
    warnings = _warnings(sequence, bend, result, against, measures)
    return BendDone(
        bend, measures, result["stroke"], forces, tuple(states), tuple(hits), tuple(trials), warnings, result, problem
    )


def _warnings(sequence: BendSequence, bend: Bend, result: Result, against: str, measures: Measures) -> tuple[str, ...]:
    """Warnings of a bend."""
    found = []
    if against:
        found.append(f"the sheet lies against a flank of the {against}: this is no air bending any more")
    for name, how in touching(sequence.case(bend)).items():
        deep = float(result[f"{name}_penetration"].max())
        if how.allowed is not None and deep > how.allowed * 1.05:
            found.append(f"contact {name}: the penetration of {deep:.3g} exceeds the {how.allowed:.3g} allowed")
    if measures.radius != measures.radius:
        found.append("the sheet springs back flat: a larger stroke")
    return (*found, *result.warnings)
