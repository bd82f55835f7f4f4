"""What free bending reports of a run of its problem."""

from __future__ import annotations

from umform.analysis.run import Result
from umform.processes.bending.case import Bending, measured
from umform.processes.bending.spec import FreeBending


def outcome_of(case: FreeBending, result: Result) -> Bending:
    """The measures of a case from a run of its problem, which has a frame at the end of each step."""
    return measured(case, result)


def names_of(case: FreeBending) -> list[str]:
    """Names of the measures of a case."""
    return [*(f"F_{mark:g}" for mark in case.marks), "u_zero_force", "J", "roughness"]
