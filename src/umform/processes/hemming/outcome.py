"""The hem of the runs of its first bend and of its flattening."""

from __future__ import annotations

from umform.analysis.run import Result
from umform.processes.bend_sequence.outcome import outcome_of as part_of
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming.measures import Hem, measured
from umform.processes.hemming.problem import PARTS, problem_of_hem
from umform.processes.hemming.spec import Hemming


def outcome_of(case: Hemming, bent: Result, result: Result) -> Hem:
    """The hem of a case with a stroke from both runs, which have a frame at the end of each step."""
    first, mesh = part_of(case.first, bent), result.model.mesh
    end = [frame for frame in result.frames if result.rows[frame.number]["step"] <= PARTS][-1]
    force = result["stroke_force"] / case.sheet.thickness
    loaded, released = Strip.of(mesh, end.points["displacement"]), Strip.of(mesh, result.model.u)
    measures = measured(case, force[: end.number + 1], loaded, released)
    return Hem(case, first, measures, result["stroke"], force, released, result, problem_of_hem(case, first)[0])
