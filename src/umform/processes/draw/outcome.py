"""The drawn part of a run of its problem."""

from __future__ import annotations

from umform.analysis.run import Result
from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.u_bend import UBend
from umform.results.forming import KeelerBrazier, add_forming_fields


def outcome_of(case: Cup | UBend, result: Result) -> Drawn:
    """The part of a case from a run of its problem, which has a frame at the end of each step.

    The stroke at the forming limit is rough: it is interpolated between these frames.
    """
    kinds = [step.kind for step in case.problem().contents.steps]
    opens = kinds.index("free") + 1
    limit = KeelerBrazier.of(case.thickness, case.material)
    add_forming_fields(result, limit)
    drawing, release = result.of_steps(1, opens - 1), result.of_steps(opens, len(kinds))
    return Drawn(case, limit, drawing, drawing.frames[-1].points["displacement"].ravel(), release, None)
