"""The drawn part of a run of its problem."""

from __future__ import annotations

from umform.analysis.run import Result
from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import DRAW_IN, FORCE, FORCE_OFF, HOLDER, Drawn
from umform.processes.draw.u_bend import UBend
from umform.results.forming import (
    BY_PATHS,
    BY_STRAINS,
    MARGIN,
    NUMBER_OF_EARS,
    THINNING,
    KeelerBrazier,
    add_forming_fields,
)

#: States that each step keeps, for pictures and paths of strain.
FRAMES = 20
#: Names of all measures that a part may have, then those of a cup and of a U-bend.
_PART = (
    *(FORCE, "at a stroke of", HOLDER, DRAW_IN, THINNING, "largest thickening", "largest major strain", MARGIN),
    *(BY_STRAINS, BY_PATHS, "work of friction", "stroke at the forming limit", "largest springback"),
)
_CUP = (
    *(FORCE_OFF, "off the holder: at a stroke of", "height, mean", "height, lowest", "height, highest"),
    *(*(f"amplitude of {n} waves" for n in (2, 4, 6, 8)), "ears count from an amplitude of", NUMBER_OF_EARS),
)
_U_BEND = ("theta1", "theta2", "radius of the wall")


def outcome_of(case: Cup | UBend, result: Result) -> Drawn:
    """The part of a case from a run of its problem, which has `FRAMES` frames in each step.

    The path-dependent limit and the stroke at the forming limit follow from these frames.
    """
    kinds = [step.kind for step in case.problem().contents.steps]
    opens = kinds.index("free") + 1
    limit = KeelerBrazier.of(case.thickness, case.material)
    add_forming_fields(result, limit)
    drawing, release = result.of_steps(1, opens - 1), result.of_steps(opens, len(kinds))
    return Drawn(case, limit, drawing, drawing.frames[-1].points["displacement"].ravel(), release, None)


def names_of(case: Cup | UBend) -> list[str]:
    """Names of the measures that a part may have."""
    return [*_PART, *(_CUP if isinstance(case, Cup) else _U_BEND)]
