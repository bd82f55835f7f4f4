"""The strip drawn through a bead, of a run of its problem."""

from __future__ import annotations

from collections.abc import Collection

from umform.analysis.run import Result
from umform.processes.draw_bead.measures import Drawn
from umform.processes.draw_bead.spec import DrawBead
from umform.results.quantity import declared


def outcome_of(case: DrawBead, result: Result) -> Drawn:
    """Restraint, uplift and thinning of a case from a run of its problem."""
    return Drawn.of(case, result)


def names_of(case: DrawBead) -> Collection[str]:
    """Names of the quantities of a strip."""
    del case
    return declared(Drawn)
