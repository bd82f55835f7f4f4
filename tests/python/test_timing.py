"""The clock of a run: parts, their sums, and who hears of them."""

from __future__ import annotations

import pickle

import pytest

import umform as uf
from umform import timing
from umform.timing import Timing, timings


@pytest.fixture
def clock(monkeypatch):
    """A clock that moves by what it is told."""
    now = [0.0]
    monkeypatch.setattr(timing.clock, "perf_counter", lambda: now[0])
    return lambda seconds: now.__setitem__(0, now[0] + seconds)


def test_parts_and_rest_are_the_whole(clock):
    spent = Timing()
    with spent.run:
        clock(1.0)
        for _ in range(2):
            with spent.elements:
                clock(3.0)
        with spent.solve:
            clock(0.5)
    with spent.files:
        clock(2.5)
    clock(100.0)
    assert (spent.elements.seconds, spent.elements.calls) == (6.0, 2)
    assert (spent.total, spent.rest) == (10.0, 1.0)
    assert spent.rows() == [
        ("elements", 6.0, 0.6, 2),
        ("solve", 0.5, 0.05, 1),
        ("files", 2.5, 0.25, 1),
        ("rest of Python", 1.0, 0.1, None),
    ]
    assert spent.record()["rest"] == {"seconds": 1.0}


def test_what_an_exception_ends_counts_too(clock):
    spent = Timing()
    with pytest.raises(ZeroDivisionError), spent.contact:
        clock(1.0)
        _ = 1 / 0
    assert (spent.contact.seconds, spent.contact.calls) == (1.0, 1)


def test_sum_and_pickle(clock):
    one, two = Timing(), Timing()
    for spent, seconds in ((one, 1.0), (two, 2.0)):
        with spent.run, spent.factorisation:
            clock(seconds)
    whole = Timing.sum(pickle.loads(pickle.dumps(spent)) for spent in (one, two))
    assert (whole.run.seconds, whole.factorisation.seconds, whole.factorisation.calls) == (3.0, 3.0, 2)
    assert one.run.seconds == 1.0


def strip():
    mesh = uf.mesh.strip(length=10.0, width=1.0, thickness=0.5, cells=(6, 1))
    model = uf.Model(mesh, material=uf.SVK(E=1000.0, nu=0.3))
    model.fix("x0")
    return model, uf.Move(model.prescribe("x1_lower", "z", name="end"), to=1.0, steps=2)


def test_a_result_knows_where_its_time_went():
    model, move = strip()
    result = uf.solve(model, move, frames=0, progress=False)
    spent = result.timing
    assert spent is model.system.timing
    iterations = int(result["iterations"].sum())
    # One more of each increment: its start; the last one of an increment is not factorised but for the first tangent.
    assert spent.solve.calls == spent.factorisation.calls + len(result) - 1  # and the tangent at the end of each
    assert iterations <= spent.elements.calls <= iterations + 2 * len(result)
    assert spent.output.calls == len(result)
    assert spent.ties.calls == spent.contact.calls == 0
    assert 0.0 < sum(part.seconds for part in spent.parts) < spent.total
    assert spent.run.seconds >= result.seconds


def test_each_run_has_a_clock_of_its_own_and_listeners_hear_of_all():
    model, move = strip()
    with timings() as heard:
        first = uf.solve(model, move, frames=0, progress=False)
        second = uf.solve(model, uf.Move(move.control, to=0.0, steps=1), frames=0, progress=False)
    uf.solve(model, move, frames=0, progress=False)
    assert heard == [first.timing, second.timing]
    assert first.timing.run.calls == second.timing.run.calls == 1
