"""The last attempt of an increment under a tool may end above its tolerance. eq. (5.131)"""

from __future__ import annotations

from collections import Counter
from contextlib import nullcontext
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from umform.analysis.newton import strategies
from umform.analysis.newton.criteria import Criteria
from umform.analysis.newton.strategies import Strategy, equilibrium
from umform.results.records import Cause, Converged, Failed, Iteration


def iteration(residual: float, increment: float = 1e-5) -> Iteration:
    return Iteration(1, residual, increment, 0.0, 0, 0, 1.0, 0, 0.0)


@dataclass
class At:
    """An increment."""

    model: SimpleNamespace
    newton: SimpleNamespace
    statistics: SimpleNamespace
    touched: bool
    goal: None = None

    def accept(self, found):
        return found


def increment(last: bool, touched: bool):
    attempts = SimpleNamespace(trying=lambda name: nullcontext(), causes=Counter())
    statistics = SimpleNamespace(record=lambda **what: None, record_cut=lambda what: None, last=last)
    timing = SimpleNamespace(attempts=attempts)
    newton = SimpleNamespace(
        timing=timing, settled=0.0, but=lambda settled: SimpleNamespace(timing=timing, settled=settled)
    )
    return At(SimpleNamespace(system=SimpleNamespace(prepare=lambda goal: None)), newton, statistics, touched)


def attempt(*records: Iteration):
    """An attempt that meets some residuals in turn, and ends at the first one that its tolerance allows."""

    def solve(at):
        for k, record in enumerate(records):
            if record.residual <= at.newton.settled:
                return Converged(None, list(records[: k + 1]))
        raise Failed("no convergence", list(records), Cause.ITERATIONS)

    return solve


def solved(monkeypatch, *, last: bool = True, touched: bool = True, **attempts):
    tried = tuple(Strategy(name.replace("_", " "), lambda at: True, attempts[name]) for name in attempts)
    monkeypatch.setattr(strategies, "STRATEGIES", tried)
    at = increment(last, touched)
    try:
        return equilibrium(at)
    finally:
        assert at.newton.settled == 0.0


def test_the_nearest_state_of_all_attempts_is_taken(monkeypatch):
    one, other = attempt(iteration(4e-7), iteration(2e-4)), attempt(iteration(1e-3), iteration(9e-8), iteration(1e-2))
    found = solved(monkeypatch, extrapolation=one, tangent=other)
    assert found.missed == 9e-8 and len(found.iterations) == 2


@pytest.mark.parametrize("record", [iteration(2e-3), iteration(1e-8, increment=0.1)])
def test_a_state_beyond_the_tolerances_of_drawing_is_none(monkeypatch, record):
    with pytest.raises(Failed):
        solved(monkeypatch, tangent=attempt(record))


def test_only_a_last_attempt_under_a_tool_may_end_so(monkeypatch):
    near = attempt(iteration(1e-8))
    with pytest.raises(Failed):
        solved(monkeypatch, last=False, tangent=near)
    with pytest.raises(Failed):
        solved(monkeypatch, touched=False, tangent=near)
    with pytest.raises(Failed):
        solved(monkeypatch, tangent=attempt(iteration(1.0)), softer_penalties=near)


class System(SimpleNamespace):
    """A system whose residual has a given resultant beside a force of a tool."""

    extent = 1.0
    ranks = SimpleNamespace(max=lambda value: value)
    pattern = SimpleNamespace(n=1)

    def largest_entry(self, values):
        return 1.0

    def resultants(self, evaluation):
        return self.resultant, self.tool


EVALUATION = SimpleNamespace(force_scale=1.0, round_off=0.0, values=np.ones(1), border=SimpleNamespace(unknowns=()))


def met(criteria: Criteria, norm: float, *, increment: float = 1e-8) -> bool:
    return criteria.met(norm, increment, np.ones(1), EVALUATION, moved=False, solved=True)


@pytest.mark.parametrize(("norm", "increment", "ends"), [(1e-7, 1e-3, True), (1e-6, 1e-3, False), (1e-7, 0.1, False)])
def test_a_settled_residual_ends_the_iterations_above_the_tolerance(norm, increment, ends):
    criteria = Criteria(System(resultant=0.0, tool=0.0), 1e-9, 1e-6)
    assert not met(criteria, norm, increment=increment)
    criteria.settled = 2e-7
    assert met(criteria, norm, increment=increment) is ends


@pytest.mark.parametrize(
    ("residual", "resultant", "tool", "ends"),
    [
        (1e-3, 0.9e-2, 1.0, True),
        (1e-3, 1.1e-2, 1.0, False),
        (1e-3, 1.1e-2, 0.0, True),  # nothing touches the sheet
        (1e-3, 0.9e-4, 1e-3, True),  # forces of tools near lift-off are no reference
        (1e-3, 1.1e-4, 1e-3, False),
        (1e-9, 0.9e-6, 1.0, True),
        (1e-9, 1.1e-6, 1.0, False),
    ],
)
def test_the_resultant_must_be_small_beside_the_forces_of_tools(residual, resultant, tool, ends):
    """eq. (5.130)"""
    criteria = Criteria(System(resultant=resultant, tool=tool), residual, 1e-2)
    assert met(criteria, 0.5 * residual) is ends
