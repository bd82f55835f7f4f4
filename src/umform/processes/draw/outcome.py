"""The drawn part of a run of its problem."""

from __future__ import annotations

from copy import copy
from dataclasses import replace

from umform.analysis.run import Result
from umform.problem.unloading import loading_steps
from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.u_bend import UBend
from umform.results.forming import KeelerBrazier, add_forming_fields


def outcome_of(case: Cup | UBend, result: Result) -> Drawn:
    """The part of a case from a run of its problem, which has a frame at the end of each step.

    The stroke at the forming limit is rough: it is interpolated between these frames.
    """
    contents = case.problem().contents
    closing = loading_steps(contents)
    limit = KeelerBrazier.of(case.thickness, case.material)
    drawn, released = _steps(result, 0, closing), _steps(result, closing + 1, len(contents.steps))
    add_forming_fields(drawn, limit)
    return Drawn(case, limit, drawn, drawn.frames[-1].points["displacement"].ravel(), released, None)


def _steps(result: Result, first: int, last: int) -> Result:
    """The part of a result that belongs to some steps."""
    part = copy(result)
    numbers = [number for number, row in enumerate(result.rows) if first <= row["step"] <= last]
    part.rows, part.iterations = [result.rows[n] for n in numbers], [result.iterations[n] for n in numbers]
    part.frames = [replace(one, number=one.number - numbers[0]) for one in result.frames if one.number in numbers]
    return part
