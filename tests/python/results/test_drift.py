"""Warning at the end of a run whose increments are too long for its works."""

from __future__ import annotations

import math

import numpy as np
import pytest

import umform as uf
from umform.analysis.run.open_run import OpenRun
from umform.report.page import write_report
from umform.results.balance_summary import balanced


def about(result):
    return [text for text in result.warnings if "the energies differ" in text]


def bar():
    """A bar of a plastic metal that is pulled."""
    metal = uf.J2(E=2e5, nu=0.3, hardening=uf.Linear(200.0, 50.0))
    model = uf.Model(uf.mesh.strip(4.0, 1.0, 1.0, (2, 1)), material=metal)
    model.fix("x0")
    model.prescribe("x1", "x", "pull")
    return model


def pulled(to=0.02, steps=4):
    model = bar()
    return uf.solve(model, uf.Move(model.controls[0], to, steps=steps, cuts=0), frames=0, progress=False)


def test_long_increments_are_named_with_how_many_more_help():
    coarse = pulled()
    (text,) = about(coarse)
    drift = np.abs(coarse.balance().drift).max()
    assert drift > 0.01
    assert f"{100 * drift:.2g} % of the largest energy in step 1" in text
    more = float(text.split("at least ")[1].split()[0])
    assert about(pulled(steps=math.ceil(8 * more))) == []


def test_short_increments_are_not():
    result = pulled(steps=60)
    assert np.abs(result.balance().drift).max() < 0.01
    assert about(result) == []


def test_the_record_has_imbalances_works_and_energies():
    result = pulled()
    (record,) = result.summary()["balance"].values()
    drift = result.balance().drift
    assert (record["drift"], record["drift_step"], record["small"]) == (np.abs(drift).max(), 1, False)
    assert record["force_imbalance"] < 1e-6 and record["moment_imbalance"] < 1e-6
    assert record["works"]["loads and supports"] == pytest.approx(record["external_work"] - record["before"])
    energies = record["elastic"] + record["plastic"] + record["contact"] + record["friction"]
    scale = np.abs(result["elastic_energy"] + result["plastic_work"]).max()
    assert record["external_work"] - energies == pytest.approx(drift[-1] * scale)


@pytest.mark.parametrize("steps", [4, 60])
def test_a_report_marks_a_drift_beyond_its_limit(steps, tmp_path):
    result = pulled(steps=steps)
    found = balanced(result)
    assert found.small == (steps == 60)
    page = write_report(result, tmp_path / "a.html").read_text()
    mark, missed = ("", "") if found.small else (' class="bad"', " MISSED 2.79 times over")
    assert f"<td{mark}>{100 * found.drift:.2g}{missed}</td>" in page
    assert ("1 % allowed: MISSED" in found.text) == (not found.small)


def test_the_run_that_follows_is_not_blamed():
    model = pulled().model
    again = uf.solve(model, uf.Move(model.controls[0], 0.0201, steps=2), frames=0, progress=False)
    assert about(again) == []


def test_round_off_is_no_drift():
    """A sheet that is carried along has no work and no energy but round-off."""
    model = uf.Model(uf.mesh.strip(4.0, 1.0, 1.0, (2, 1)), material=uf.SVK(E=2e5, nu=0.3))
    ways = [model.prescribe("x0", axis, axis) for axis in "xyz"]
    result = uf.solve(model, uf.Move(ways, [3.0, 5.0, 700.0], steps=7), frames=0, progress=False)
    assert 0.0 < np.abs(result["external_work"]).max() < 1e-6
    assert about(result) == []


def test_unknown_energies_are_no_drift():
    law = uf.UserLaw(lambda E, state: (1e3 * E, np.broadcast_to(1e3 * np.eye(6), (len(E), 6, 6)).copy(), state))
    model = uf.Model(uf.mesh.strip(4.0, 1.0, 1.0, (2, 1)), material=law)
    model.fix("x0")
    result = uf.solve(model, uf.Move(model.prescribe("x1", "x", "pull"), 0.5, steps=1), frames=0, progress=False)
    assert np.isnan(result["elastic_energy"]).any()
    assert about(result) == []
    (record,) = result.summary()["balance"].values()
    assert record["drift"] is record["elastic"] is None and record["force_imbalance"] < 1e-6
    assert "unknown" in balanced(result).text


def test_a_run_that_ends_early_is_named_too():
    with pytest.raises(uf.errors.NoConvergence) as caught:
        pulled(lambda f: 0.02 * f if f < 0.5 else -6.0)
    assert len(about(caught.value.result)) == 1


def test_an_open_run_says_it_once_at_its_end():
    model = bar()
    run = OpenRun(model)
    run.take(uf.Move(model.controls[0], 0.02, steps=4))
    assert about(run.result) == []
    assert len(about(run.close())) == len(about(run.close())) == 1


def test_multipliers_have_a_remedy_of_their_own():
    """They leave a penetration, and remove it while the tool stands still."""
    model = uf.Model(uf.mesh.strip(4.0, 4.0, 1.0, (2, 2)), material=uf.SVK(E=1e4, nu=0.0))
    press = model.prescribe("upper", "z", "press")
    model.fix("upper", ("x", "y"))
    model.contact("lower", uf.Plane((0, 0, -0.5), (0, 0, 1)), penalty=1e4, penetration=1e-9, augmented=True)
    steps = [uf.Move(press, -0.02, steps=1), uf.Move(press, -0.02, steps=4)]
    (text,) = about(uf.solve(model, steps, frames=0, progress=False))
    assert "multipliers" in text
