"""The part of the runs of its bends."""

from __future__ import annotations

from umform.analysis.run import Result
from umform.processes.air_bending.goal import needed_stroke
from umform.processes.air_bending.loading import against_flank, loading
from umform.processes.air_bending.measures import Measures
from umform.processes.bend_sequence.one_bend import bend_done, measures_of, placed_problem
from umform.processes.bend_sequence.part import BendDone, Part
from umform.processes.bend_sequence.problem import flat_strip
from umform.processes.bend_sequence.sides import Sides, Strip
from umform.processes.bend_sequence.spec import Bend, BendSequence
from umform.results.quantity import declared
from umform.results.records import Floats


def outcome_of(sequence: BendSequence, *results: Result) -> Part:
    """The part of a sequence with strokes from a run of each bend, which has a frame at the end of each step."""
    befores = (None, *results)
    bends = zip(sequence.bends, befores, results, strict=False)
    return Part(sequence, tuple(_done(sequence, bend, before, result) for bend, before, result in bends))


def names_of(sequence: BendSequence) -> list[str]:
    """Names of the quantities of a part."""
    count = len(sequence.bends)
    of_bends = [f"bend {n + 1}: {name}" for n in range(count) for name in (*declared(Measures), "final_angle")]
    return [*of_bends, *(f"flange {n + 1}" for n in range(count + 1)), "length_balance"]


def _done(sequence: BendSequence, bend: Bend, before: Result | None, result: Result) -> BendDone:
    case = sequence.case(bend)
    stroke, mesh = needed_stroke(case), result.model.mesh

    def sides(u: Floats) -> Sides:
        return Strip.of(mesh, u).at(bend.position, over=bend.over).sides(sequence.zone(bend))

    last = len(loading(case, stroke))
    end = [frame for frame in result.frames if result.rows[frame.number]["step"] <= last][-1]
    forces = result["stroke_force"][: end.number + 1] / case.thickness
    measures = measures_of(
        sides(end.points["displacement"]), sides(result.model.u), stroke, float(forces[-1]), float(forces.max())
    )
    problem = placed_problem(sequence, bend, stroke, before, flat_strip(sequence))
    return bend_done(sequence, bend, measures, against_flank(case, end.contacts), result, problem)
