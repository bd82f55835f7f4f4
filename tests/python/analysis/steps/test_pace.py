"""Increments whose size follows what happens in them."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.steps.pace import Happened
from umform.errors import InvalidValue
from umform.history_variables import history_of
from umform.model.bodies.change import strained, turned
from umform.results.balance import Worked


def happened(**values):
    return Happened(**{"turn": 0.0, "strain": 0.0, "contact": 0.0, "iterations": 1, **values})


@pytest.mark.parametrize(
    ("what", "factor"),
    [
        ({}, 2.0),
        ({"iterations": 6}, 2.0),
        ({"iterations": 12}, 1.0),
        ({"iterations": 16}, 0.75),
        ({"iterations": 60}, 0.5),
        ({"turn": 2.5}, 0.8),
        ({"strain": 0.025}, 0.8),
        ({"contact": 1.25}, 0.8),
        ({"turn": 2.5, "strain": 0.04}, 0.5),
    ],
)
def test_the_narrowest_limit_rules(what, factor):
    assert uf.Pace().factor(happened(**what)) == pytest.approx(factor)


@pytest.mark.parametrize(
    "limits", [{"turn": 0.0}, {"strain": -1.0}, {"iterations": 0}, {"first": 0.2}, {"largest": 2.0}, {"turn": np.nan}]
)
def test_limits_that_make_no_sense_are_refused(limits):
    with pytest.raises(InvalidValue) as refused:
        uf.Pace(**limits)
    assert refused.value.where in limits


@pytest.mark.parametrize(
    ("size", "worked", "again"),
    [
        (0.02, Worked(0.011, gained=1.0, energy=10.0), False),  # 50 in the step at this rate
        (0.2, Worked(0.011, gained=1.0, energy=10.0), True),
        (0.2, Worked(0.011, gained=1.0, energy=12.0), False),
        (0.02, Worked(0.06, gained=1.0, energy=1.0), True),
        (0.003, Worked(1.0, gained=1.0, energy=1.0), False),  # as small as increments become for this
        (0.2, Worked(np.nan, gained=np.nan, energy=np.nan), False),
    ],
)
def test_an_increment_is_repeated_if_its_works_differ(size, worked, again):
    assert uf.Pace().repeats(size, worked) is again


def test_repeated_increments_halve_the_drift():
    """The whole strip yields in its first increments."""

    def bent(work):
        model, end = cantilever(uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(100.0, 1000.0)))
        pace = uf.Pace(first=0.1, turn=20.0, strain=0.2, work=work)
        return uf.solve(model, uf.Move(end, to=3.0, steps=pace), frames=0, progress=False)

    loose, kept = bent(1.0), bent(uf.Pace.work)
    repeated = kept.timing.attempts.causes["difference of work and energies"]
    assert 1 <= repeated <= 4
    assert len(kept) <= len(loose) + 2 * repeated
    assert kept.timing.attempts.discarded > 0
    drifts = [np.abs(run.balance().drift).max() for run in (loose, kept)]
    assert drifts[1] < 0.5 * drifts[0]
    assert (np.diff(kept["time"]) > 0.0).all()
    assert kept["end"][-1] == 3.0


def cantilever(law, cells=(10, 1)):
    model = uf.Model(uf.mesh.strip(length=20.0, width=2.0, thickness=1.0, cells=cells), material=law)
    model.fix("x0")
    return model, model.prescribe("x1_lower", "z", name="end")


def test_turning_and_straining_are_measured():
    model, end = cantilever(uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(100.0, 1000.0)))
    uf.solve(model, uf.Move(end, to=2.0, steps=4), frames=0, progress=False)
    before, body = model.u.copy(), model.bodies[0]
    eqps = history_of(body.block)["eqps"]
    result = uf.solve(model, uf.Move(end, to=2.5, steps=1), frames=0, progress=False)
    assert len(result) == 2
    tips = model.mesh.nodes("x1_lower"), model.mesh.nodes("x1_upper")
    fibres = [model.mesh.displaced(u)[tips[1][0]] - model.mesh.displaced(u)[tips[0][0]]
              for u in (before, model.u)]  # fmt: skip
    unit = [d / np.linalg.norm(d) for d in fibres]
    tip = np.degrees(np.arccos(unit[0] @ unit[1]))
    assert tip > 1.0
    assert turned(body, before, model.u) == pytest.approx(tip, rel=0.05)
    assert strained(body) == pytest.approx((history_of(body.block)["eqps"] - eqps).max())
    assert strained(body) > 1e-4


def test_an_elastic_body_does_not_strain_plastically():
    model, end = cantilever(uf.SVK(E=1000.0, nu=0.3))
    uf.solve(model, uf.Move(end, to=2.0, steps=2), frames=0, progress=False)
    assert strained(model.bodies[0]) == 0.0


def test_a_move_without_a_number_of_increments_goes_at_a_pace():
    model, end = cantilever(uf.SVK(E=1000.0, nu=0.3))
    result = uf.solve(model, uf.Move(end, to=4.0), frames=0, progress=False)
    sizes = np.diff(result["end"]) / 4.0
    assert sizes[0] == pytest.approx(0.01)
    assert sizes.max() <= 0.1 + 1e-12
    assert (sizes[1:] <= 2.0 * sizes[:-1] + 1e-12).all()
    assert result["end"][-1] == 4.0
    assert len(result) < 40


def test_half_the_limits_are_finer_and_nearer_to_equal_increments():
    law = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(100.0, 1000.0))

    def curve(steps):
        model, end = cantilever(law)
        result = uf.solve(model, uf.Move(end, to=3.0, steps=steps), frames=0, progress=False)
        return result["end"], result["end_force"]

    fine_way, fine_force = curve(400)
    away, counts = [], []
    for steps in (uf.Pace(), uf.Pace(turn=0.5, strain=0.005)):
        way, force = curve(steps)
        counts.append(len(way))
        away.append(np.abs(force - np.interp(way, fine_way, fine_force)).max() / np.abs(fine_force).max())
    assert counts[0] < counts[1]
    assert away[1] < away[0] < 0.01


def test_after_a_cut_the_pace_stays_below_the_size_that_failed(monkeypatch):
    from umform.analysis.newton.newton import Newton
    from umform.results.records import Failed

    original, times = Newton.solve, []

    def solve_or_fail(self, goal, extrapolation=None, mode=None, beyond=None, keep=False):
        times.append(goal.time)
        if 0.3 < goal.time < 0.5 and len(times) < 40:
            raise Failed("not here", [])
        return original(self, goal, extrapolation, mode, beyond, keep)

    monkeypatch.setattr(Newton, "solve", solve_or_fail)
    model, end = cantilever(uf.SVK(E=1000.0, nu=0.3))
    result = uf.solve(model, uf.Move(end, to=1.0, cuts=30), frames=0, progress=False)
    assert result["time"][-1] == 1.0
    sizes = np.diff(result["time"])
    cut = int(np.argmin(sizes[4:])) + 4
    assert sizes[cut] < 0.05
    failed = 2.0 * sizes[cut]
    np.testing.assert_allclose(sizes[cut + 1 : cut + 12], 0.6 * failed * 1.05 ** np.arange(11))


def test_a_run_at_a_pace_is_taken_up_to_the_bit(tmp_path):
    law = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(100.0, 1000.0))

    def fresh():
        model, end = cantilever(law)
        return model, uf.Move(end, to=3.0)

    whole = uf.solve(*fresh(), frames=0, progress=False)
    model, move = fresh()
    seen = []

    def stop(record):
        seen.append(record)
        if len(seen) == 40:
            raise KeyboardInterrupt

    from umform.analysis.newton.newton import Newton

    start = Newton.__init__

    def with_callback(self, *arguments):
        start(self, *arguments)
        self.callbacks.append(stop)

    path = tmp_path / "run.checkpoint"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Newton, "__init__", with_callback)
        with pytest.raises(KeyboardInterrupt):
            uf.solve(model, move, frames=0, progress=False, checkpoint=path, every=0.0)
    rest = uf.resume(path, *fresh(), frames=0, progress=False)
    np.testing.assert_array_equal(rest["end_force"], whole["end_force"])
    np.testing.assert_array_equal(rest["time"], whole["time"])
