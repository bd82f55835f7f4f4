"""The problem of a drawn part: what a deck of it holds."""

from __future__ import annotations

from umform.problem.problem import Problem
from umform.processes.draw.cup import Cup
from umform.processes.draw.u_bend import UBend


def problem_of(case: Cup | UBend) -> Problem:
    """The computed part of the blank in its tools: held, drawn, released."""
    return case.problem()
