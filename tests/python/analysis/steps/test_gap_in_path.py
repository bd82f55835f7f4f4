"""A path without equilibria over a short way is stepped over by an increment of the nominal size. eq. (5.132)"""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.steps import moving
from umform.errors import NoConvergence
from umform.results.records import Cause, Failed


def run(
    monkeypatch, gap: tuple[float, float], steps: int | uf.Pace, *, load: bool = False
) -> tuple[uf.Result, list[float]]:
    """A bar is pulled to 1 by a displacement or a load; no increment ends within the gap.

    The result, and the ends of all increments tried.
    """
    tried, take = list[float](), moving.take_increment

    def without_gap(run, values, controls, time, *more, **keys):
        tried.append(values[0])
        if gap[0] < values[0] < gap[1]:
            raise Failed("no equilibrium here", [], Cause.STALL)
        return take(run, values, controls, time, *more, **keys)

    monkeypatch.setattr(moving, "take_increment", without_gap)
    model = uf.Model(uf.mesh.strip(20.0, 1.0, 1.0, (4, 1)), material=uf.SVK(E=1000.0, nu=0.0))
    model.fix("x0")
    pull = model.traction("x1", (1.0, 0.0, 0.0), "pull") if load else model.prescribe("x1", "x", "pull")
    return uf.solve(model, uf.Move(pull, 1.0, steps=steps, cuts=4), frames=0, progress=False), tried


@pytest.mark.parametrize("steps", [10, uf.Pace(first=0.1, largest=0.1, turn=90.0)])
def test_a_gap_of_less_than_an_increment_is_stepped_over(monkeypatch, steps):
    result, tried = run(monkeypatch, (0.33, 0.42), steps)
    at = int((result["pull"] > 0.34).argmax())
    assert result["pull"][-1] == 1.0 and 0.3 < result["pull"][at - 1] <= 0.33
    assert result["pull"][at] >= 0.42
    assert sum(0.33 < end < 0.42 for end in tried) >= 4  # smaller ones were tried first


def test_the_step_over_a_gap_is_not_repeated_for_its_work(monkeypatch):
    """Its halves do not converge: it would be repeated without an end."""

    def repeats(pace, size, worked):
        asked.append(size)
        assert len(asked) < 400
        return size > 0.04

    asked = list[float]()
    monkeypatch.setattr(uf.Pace, "repeats", repeats)
    monkeypatch.setattr(uf.Pace, "factor", lambda pace, happened: 1.0)
    result, _ = run(monkeypatch, (0.33, 0.42), uf.Pace(first=0.1, largest=0.1))
    sizes = np.diff(result["pull"], prepend=0.0)
    assert result["pull"][-1] == 1.0
    assert sorted(sizes)[-1] > 0.09 and sorted(sizes)[-2] < 0.04


@pytest.mark.parametrize("gap", [(0.3, 0.6), (0.33, 0.6), (0.97, 1.1)])
@pytest.mark.parametrize("steps", [10, uf.Pace(first=0.1, largest=0.1)])
def test_a_longer_gap_ends_the_run(monkeypatch, gap, steps):
    with pytest.raises(NoConvergence, match="did not converge at the smallest increment") as failed:
        run(monkeypatch, gap, steps)
    assert gap[0] - 0.02 < failed.value.result["pull"][-1] <= gap[0]


def test_a_load_is_not_leapt_with(monkeypatch):
    """Beyond its maximum there is no equilibrium near."""
    with pytest.raises(NoConvergence):
        run(monkeypatch, (0.33, 0.42), 10, load=True)
