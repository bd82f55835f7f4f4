"""Counts of attempts: what a run tried, what won, what was discarded."""

from __future__ import annotations

import math

import pytest

import umform as uf
from umform.attempts import Attempts
from umform.timing import Timing, timings


def test_what_fails_is_discarded_once_however_deep_it_lies():
    attempts = Attempts()
    with attempts.trying("outer"):
        attempts.evaluations += 1
        with pytest.raises(ZeroDivisionError), attempts.trying("inner"):
            attempts.evaluations += 2
            _ = 1 / 0
    with pytest.raises(ZeroDivisionError), attempts.trying("outer"):
        attempts.evaluations += 1
        with pytest.raises(ValueError, match="x"), attempts.trying("inner"):
            attempts.evaluations += 4
            raise ValueError("x")
        _ = 1 / 0
    assert (attempts.evaluations, attempts.discarded) == (8, 7)
    assert attempts.share == 7 / 8
    assert attempts.rows() == [("outer", 2, 1), ("inner", 2, 0)]


def test_an_increment_that_is_taken_back_is_discarded_whole():
    attempts = Attempts()
    attempts.evaluations = 10
    mark = attempts.mark()
    with pytest.raises(ZeroDivisionError), attempts.trying("tangent"):
        attempts.evaluations += 2
        _ = 1 / 0
    attempts.evaluations += 3
    attempts.take_back(mark, "too far")
    assert (attempts.discarded, attempts.causes) == (5, {"too far": 1})


def strip(law):
    mesh = uf.mesh.strip(length=60, width=10, thickness=1, cells=(12, 1))
    model = uf.Model(mesh, material=law)
    model.symmetry("x0", normal="x")
    model.fix(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), "y")
    punch = model.prescribe("x0_lower", "z", name="punch")
    model.contact("lower", uf.Cylinder(centre=(25, 0, -20.5), axis="y", radius=20), penalty=100, points=2)
    return model, punch


def steel():
    return uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(160.0, 500.0))


def test_a_run_counts_its_evaluations_and_strategies():
    model, punch = strip(steel())
    with timings() as runs:
        result = uf.solve(model, [uf.Move(punch, to=-3, steps=12), uf.Release(punch)], frames=0, progress=False)
    attempts = result.timing.attempts
    assert attempts.evaluations == result.timing.elements.calls
    assert sum(attempts.won.values()) >= len(result) - 1  # and the increments of the release that were taken back
    assert set(attempts.won) <= {"extrapolation", "tangent", "softer penalties"}
    assert attempts.evaluations - attempts.discarded >= result["iterations"].sum() >= attempts.accepted > 0
    assert attempts.beside == pytest.approx(1.0 - attempts.accepted / attempts.evaluations)
    assert sum(attempts.tried.values()) - sum(attempts.won.values()) <= sum(attempts.causes.values())
    whole = Timing.sum([*runs, *runs]).attempts
    assert whole.record()["evaluations"] == 2 * attempts.evaluations
    assert whole.won == {name: 2 * won for name, won in attempts.won.items()}


def test_attempts_that_run_out_of_iterations_are_discarded():
    model, punch = strip(steel())
    options = uf.NewtonOptions(max_iterations=5)
    result = uf.solve(model, uf.Move(punch, to=-3, steps=4), options=options, frames=0, progress=False)
    attempts = result.timing.attempts
    assert 0.1 < attempts.share < 1.0
    assert any("too many iterations" in cause for cause in attempts.causes)
    assert len(result) > 5  # increments were cut


def test_a_stiff_tool_that_comes_from_afar_is_met_with_softer_penalties():
    """Half a thickness into a sheet that nothing touched: its first touch in an increment."""
    mesh = uf.mesh.strip(length=50, width=50, thickness=0.5, cells=(12, 12))
    model = uf.Model(mesh, material=steel())
    model.symmetry("x0", normal="x")
    model.symmetry("y0", normal="y")
    model.fix("x1")
    model.fix("y1")
    contact = model.contact("upper", uf.Sphere(centre=(0, 0, 20.25), radius=20), penalty=5e4, points=2)
    result = uf.solve(model, uf.Move(model.drive(contact, "-z", "ball"), to=4, steps=2), frames=0, progress=False)
    attempts = result.timing.attempts
    assert len(result) == 3
    assert attempts.won["softer penalties"] >= 1
    assert attempts.causes["indefinite tangent far from equilibrium"] + attempts.causes["first touch"] >= 1
    assert attempts.share < 0.15
    assert math.isfinite(result["ball_force"][-1])


def test_the_command_line_and_the_report_show_them(capsys, tmp_path):
    from umform.cli.timing import show_timing

    model, punch = strip(steel())
    result = uf.solve(model, uf.Move(punch, to=-3, steps=12), frames=1, progress=False)
    show_timing(result.timing)
    printed = capsys.readouterr().out
    assert f"{result.timing.attempts.evaluations} evaluations" in printed
    assert "extrapolation" in printed
    page = tmp_path / "report.html"
    result.report(page)
    text = page.read_text(encoding="utf-8")
    assert result.timing.attempts.summary in text
    assert "<td>extrapolation</td>" in text or ">extrapolation<" in text


@pytest.mark.parametrize("steps", [None, 15, 20])
def test_increments_that_are_too_large_for_a_sharp_hinge_are_cut_without_much_ado(steps):
    """The first run of the demo, in perfect plasticity: softer penalties do not help there, and are given up soon."""
    from umform.processes.bending.case import build
    from umform.processes.bending.spec import FreeBending

    case = FreeBending()
    model, punch = build(case)
    result = uf.solve(model, uf.Move(punch, to=-case.stroke, steps=steps), frames=0, progress=False)
    attempts = result.timing.attempts
    assert result["punch"][-1] == -case.stroke
    assert attempts.tried["softer penalties"] >= 1  # they are not left out from the beginning
    assert attempts.share < 0.15
    assert attempts.evaluations < 300
