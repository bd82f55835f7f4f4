"""What is shown while a run goes on."""

from __future__ import annotations

from contextlib import contextmanager

from umform.analysis.run import run_steps, solve
from umform.analysis.steps import Move, Release


def test_the_bar_shows_the_control_its_force_and_the_iterations(build, monkeypatch):
    shown = []

    @contextmanager
    def bar(show):
        yield lambda *arguments: shown.append(arguments)

    monkeypatch.setattr(run_steps, "progress_bar", bar)
    bent = build.free_bending((8, 1))
    result = solve(bent.model, [Move(bent.punch, -5.0, steps=10), Release(bent.punch)], solver="banded")
    assert len(shown) == len(result) - 1
    for k, (name, fraction, detail) in enumerate(shown, start=1):
        row = result.rows[k]
        assert name.startswith(f"step {row['step']}")
        assert 0.0 <= fraction <= 1.0
        force = f"punch {row['punch']:.5g}, force {row['punch_force']:.5g}"
        assert detail == f"{force}; {row['iterations']} iterations"
    assert [fraction for _, fraction, _ in shown][9] == shown[-1][1] == 1.0


def test_the_bar_is_drawn(capsys, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "120")
    from umform.progress import progress_bar

    with progress_bar(True) as tick:
        tick("step 1", 0.25)
        tick("step 1", 0.5, "punch [-1], force 2")
    drawn = capsys.readouterr().err
    assert "step 1" in drawn
    assert "punch [-1], force 2" in drawn
    with progress_bar(False) as tick:
        tick("step 1", 0.5, "x")
    assert capsys.readouterr().err == ""


def test_runs_under_one_bar_take_their_shares():
    """Moves take the time; steps with a word behind their number do not move the bar, and nothing moves it too far."""
    from umform.progress import parts

    told = []
    first, second = parts(lambda *tick: told.append(tick), "2 runs", [1.0, 3.0], moves=2)
    for tick, name, fraction in (
        (first, "step 1: close", 1.0),
        (first, "step 2", 0.5),
        (second, "step 1", 1.0),
        (second, "step 2", 0.5),
        (second, "step 3: release", 0.5),
        (second, "step 4", 0.5),
    ):
        tick(name, fraction, "punch 1")
    assert [fraction for _, fraction, _ in told] == [0.0, 0.0625, 0.625, 0.8125, 1.0, 1.0]
    assert told[1] == ("2 runs", 0.0625, "1 of 2, step 2: punch 1")
