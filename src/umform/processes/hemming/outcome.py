"""The hem of the runs of its first bend and of its flattening."""

from __future__ import annotations

from umform.analysis.run import Result
from umform.processes.bend_sequence.outcome import outcome_of as part_of
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming.measures import Hem, HemMeasures, measured
from umform.processes.hemming.problem import FORCE, edge_of, loading_steps, problem_of_hem, start_of, way_column
from umform.processes.hemming.spec import Hemming
from umform.results.quantity import declared


def outcome_of(case: Hemming, bent: Result, result: Result) -> Hem:
    """The hem of a case with a stroke from both runs, which have a frame at the end of each step."""
    first, mesh, edge = part_of(case.first, bent), result.model.mesh, edge_of(case)
    end = [frame for frame in result.frames if result.rows[frame.number]["step"] <= loading_steps(case)][-1]
    force = result[FORCE] / case.sheet.thickness
    loaded, released = Strip.of(mesh, end.points["displacement"], edge), Strip.of(mesh, result.model.u, edge)
    start = Strip.of(*start_of(case, first)[:2])
    measures = measured(case, force[: end.number + 1], start, loaded, released)
    way, problem = result[way_column(case)], problem_of_hem(case, first)[0]
    return Hem(case, first, measures, way, force, loaded, released, result, problem)


def names_of(case: Hemming) -> list[str]:
    """Names of the quantities of a hem."""
    del case
    return [*declared(HemMeasures), "first_angle"]
