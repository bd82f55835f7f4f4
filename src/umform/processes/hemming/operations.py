"""First bend and flattening as operations; the bend has a stroke."""

from __future__ import annotations

from umform.analysis.run import Result
from umform.problem.problem import Problem
from umform.processes.air_bending.goal import needed_stroke
from umform.processes.bend_sequence.operations import operations_of as bends_of
from umform.processes.bend_sequence.outcome import outcome_of as part_of
from umform.processes.hemming.problem import problem_of_hem
from umform.processes.hemming.spec import Hemming
from umform.processes.problems import Operation


def operations_of(case: Hemming) -> list[Operation]:
    """The first bend, and the flattening.

    Raises
    ------
    InvalidValue
        The sheet has no stroke for the first bend.
    """
    needed_stroke(case.sheet, "sheet")

    def flattening(before: Result | None) -> Problem:
        assert before is not None
        return problem_of_hem(case, part_of(case.first, before))[0]

    return [*bends_of(case.first), Operation("flattening", flattening, alone=False)]
