"""The allowed penetration: the estimate of the penalty, its growth in a run, its energy and what is kept of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton import growing_penalties, newton
from umform.analysis.newton.options import NewtonOptions
from umform.errors import NoConvergence
from umform.model.contact import Contact
from umform.model.contact.encounter import Encounter, Layer
from umform.results.penetration import force_error, penetrations
from umform.results.records import Failed

STEEL = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=200.0, modulus=1000.0))


def stretched(to=-3.0, *, material=STEEL, steps=6, fixed=False, **contact):
    """A quarter of a clamped sheet and a sphere: model, move, pair."""
    mesh = uf.mesh.strip(20.0, 20.0, 1.0, (4, 4))
    model = uf.Model(mesh, material=material, thickness_order=1, thickness_points=5)
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    model.fix("x1")
    model.fix("y1")
    pair = model.contact("upper", uf.Sphere(centre=(0, 0, 12.5), radius=12.0), name="ball", **contact)
    if fixed:
        pair.penalty = pair.penalty
    return model, uf.Move(model.drive(pair, "z", name="punch"), to=to, steps=steps), pair


def run(*args, options=None, **how):
    model, move, pair = stretched(*args, **how)
    return uf.solve(model, move, frames=0, progress=False, options=options), pair


def test_the_penalty_under_a_flat_tool_carries_the_line_force_on_twenty_thicknesses():
    model, _, _ = stretched()
    plane = uf.Plane((0.0, 0.0, 0.5), "-z")
    pair = model.contact("upper", plane, name="holder")
    met = Encounter.of(model.mesh, model.mesh.face_set("upper"), plane.kernel(), [Layer(STEEL)], "")
    assert met.flat and met.length < 20.0 * met.thickness
    assert pair.penalty == pytest.approx(met.line_force / (0.005 * 20.0 * 1.0), rel=1e-12)
    assert pair.penalty == pytest.approx(1.15 * 200.0 / 8.0 / (0.005 * 20.0), rel=0.15)


@pytest.mark.parametrize("rule", [{}, {"cells": 3}, {"friction": 0.1}])
def test_every_increment_keeps_the_allowed_penetration(rule):
    result, pair = run(**rule)
    assert pair.adapts and pair.penalty > 2.0 * pair.initial_penalty
    reached = penetrations(result.model, result)["ball"]
    assert reached.reached <= 0.005 and reached.kept and "MISSED" not in reached.text
    assert result["ball_penetration"][1:].max() == reached.reached > 0.003
    assert np.all(np.diff(result["ball_penalty"]) >= 0.0) and result["ball_penalty"][-1] == pair.penalty
    assert not [text for text in result.warnings if "penetration" in text]
    assert result.timing.attempts.discarded < 0.2 * result.timing.attempts.evaluations


def test_a_penalty_grows_no_more_than_it_must():
    """A first pass aims at .85 of the allowed penetration; a line contact needs more than one."""
    result, pair = run()
    assert result["ball_penetration"].max() > 0.6 * pair.allowed
    result, pair = run(fixed=True, penetration=1.3 * result["ball_penetration"].max() * 20.0)
    assert pair.penalty == pair.initial_penalty


def test_a_given_penalty_stays_and_is_marked():
    result, pair = run(penalty=300.0)
    assert not pair.adapts and pair.penalty == pair.initial_penalty == 300.0
    reached = penetrations(result.model, result)["ball"]
    assert reached.allowed == pytest.approx(0.005) and not reached.kept
    assert reached.text.count("MISSED") == 1 and f"{reached.reached / 0.005:.3g} times over" in reached.text


def test_the_penalty_of_multipliers_stays():
    pair = stretched(augmented=True)[2]
    assert pair.allowed == 0.005 and not pair.adapts


def test_the_force_is_that_of_multipliers():
    """What the estimate of the error says, and the error itself."""
    exact = abs(run(augmented=True, penetration=1e-4)[0]["punch_force"][1:])
    soft, kept = run(fixed=True)[0], run()[0]
    errors = [float(np.mean(abs(abs(one["punch_force"][1:]) - exact) / exact)) for one in (soft, kept)]
    assert errors[1] < 0.3 * errors[0] and errors[1] < 3e-3
    assert force_error(soft) == pytest.approx(errors[0], rel=0.5)
    assert force_error(kept) < 0.3 * force_error(soft)


@pytest.mark.parametrize("steps", [1, 4])
@pytest.mark.parametrize("rule", [{"fixed": True}, {"augmented": True}])
def test_opened_tools_change_no_forces(rule, steps):
    fixed = rule.get("fixed", False)
    model, move, pair = stretched(-1.0, augmented=not fixed, fixed=fixed)
    drawn = uf.solve(model, move, frames=0, progress=False)
    opened = uf.solve(model, uf.Free(pair, steps=steps), frames=0, progress=False)
    assert opened["ball_active"][0] > 0 and opened["ball_active"][-1] == 0
    assert opened["ball_penetration_energy"][-1] == 0.0  # multipliers that stay have none
    assert force_error(opened) == 0.0 < force_error(drawn)


@pytest.mark.parametrize("rule", [{}, {"cells": 3}])
def test_a_penalty_that_grows_has_its_work_in_the_balance(rule):
    """Elastic, so that nothing else drifts: the error falls with the square of the increments."""
    law = uf.SVK(E=210e3, nu=0.3)
    drifts = []
    for steps in (8, 24):
        model, move, pair = stretched(-1.0, material=law, steps=steps, **rule)
        pair.use_penalty(0.03 * pair.initial_penalty)
        result = uf.solve(model, move, frames=0, progress=False)
        assert pair.penalty > 0.15 * pair.initial_penalty
        drifts.append(np.abs(result.balance().drift).max())
    spent = abs(pair.stiffening_work) / result["external_work"][-1]
    assert drifts[1] < 0.2 * drifts[0]
    if not rule:  # cells count the work of their pressure along the way themselves
        assert pair.stiffening_work < 0.0 and spent > 5.0 * drifts[1]
    else:
        assert pair.stiffening_work == 0.0


def test_a_failed_increment_takes_its_penalty_back():
    model, move, pair = stretched()
    first = uf.solve(model, move, frames=0, progress=False)
    grown, work, u = pair.penalty, pair.stiffening_work, model.u.copy()
    further = uf.Move(first.model.controls[0], to=-9.0, steps=1, cuts=0)
    with pytest.raises(NoConvergence):
        uf.solve(model, further, frames=0, progress=False, options=NewtonOptions(max_iterations=4))
    assert (pair.penalty, pair.stiffening_work) == (grown, work)
    np.testing.assert_array_equal(model.u, u)


def test_a_snapshot_has_the_penalty():
    model, move, pair = stretched()
    before = model.system.snapshot()
    uf.solve(model, move, frames=0, progress=False)
    after, grown, work = model.system.snapshot(), pair.penalty, pair.stiffening_work
    model.system.restore(before)
    assert (pair.penalty, pair.stiffening_work) == (pair.initial_penalty, 0.0)
    model.system.restore(after)
    assert pair.penalty == grown == pair.block.penalty
    assert pair.stiffening_work == work


def test_a_snapshot_has_the_bits_of_the_work_for_any_number_of_facets():
    model = uf.Model(uf.mesh.strip(14.0, 7.0, 1.0, (14, 7)), material=STEEL)
    pair = model.contact("upper", uf.Plane((0.0, 0.0, 1.0), "-z"))
    for work in (1.0, -1.0 / 3.0, 0.1):
        pair.stiffening_work = work
        pair.restore(pair.state())
        assert pair.stiffening_work == work


def test_the_table_has_each_contact_with_its_own_numbers():
    model, move, _ = stretched()
    model.contact("lower", uf.Plane((0.0, 0.0, -2.5), "z"), name="floor", penalty=50.0)
    result = uf.solve(model, move, frames=0, progress=False)
    rows = penetrations(model, result)
    assert list(rows) == ["ball", "floor"]
    for name, row in rows.items():
        assert row.reached == result[f"{name}_penetration"][1:].max()
        assert row.penalty == result[f"{name}_penalty"][-1]
    assert rows["ball"].kept and not rows["floor"].kept and rows["floor"].penalty == 50.0


def test_a_penalty_that_is_far_too_soft_grows_in_several_passes():
    model, move, pair = stretched(steps=2)
    pair.use_penalty(2e-3 * pair.initial_penalty)
    result = uf.solve(model, move, frames=0, progress=False)
    assert result["ball_penetration"][1:].max() <= pair.allowed
    assert {name: won for name, _, won in result.timing.attempts.rows()}["stiffer penalties"] == len(result) - 1


def out_of_balance(model):
    """Residual of the converged state, relative to the forces."""
    found = model.evaluate(model.u)
    return float(np.linalg.norm(model.system.restrict(found.residual))) / found.force_scale


def test_a_penalty_grows_before_the_iterations_converge(monkeypatch):
    """The same states for fewer evaluations."""
    near, _ = run()
    assert out_of_balance(near.model) < 2e-9
    monkeypatch.setattr(newton, "_NEAR", 0.0)
    late, _ = run()
    assert near.timing.attempts.evaluations < 0.95 * late.timing.attempts.evaluations
    np.testing.assert_allclose(near["punch_force"], late["punch_force"], rtol=2e-3)


def test_the_last_pass_converges_although_a_contact_is_too_deep(monkeypatch):
    monkeypatch.setattr(growing_penalties, "_PASSES", 1)
    model, move, pair = stretched(steps=1)
    pair.use_penalty(2e-3 * pair.initial_penalty)
    result = uf.solve(model, move, frames=0, progress=False)
    assert result["ball_penetration"][1] > pair.allowed
    assert out_of_balance(model) < 2e-9


def test_a_penetration_that_is_prescribed_does_not_grow_the_penalty_without_end():
    model = uf.Model(uf.mesh.strip(2.0, 1.0, 1.0, (2, 1)), material=STEEL)
    model.fix("lower", "xy")
    down = model.prescribe("lower", "z", "down")
    pair = model.contact("lower", uf.Plane((0.0, 0.0, -0.5), "z"), name="table")
    result = uf.solve(model, uf.Move(down, -0.02, steps=8), frames=0, progress=False)
    assert pair.penalty == pair.largest_penalty == pytest.approx(10.0 * 210e3 / 0.91, rel=0.01)
    assert not penetrations(model, result)["table"].kept


def failing(monkeypatch, times):
    """Let passes of the penalties fail, so many times; how often they were tried is the length of the list."""
    tried, grown = [], growing_penalties._grown

    def sometimes(*given):
        tried.append(given)
        if len(tried) <= times:
            given[0].system.revert()
            raise Failed("as asked", [])
        return grown(*given)

    monkeypatch.setattr(growing_penalties, "_grown", sometimes)
    return tried


def failing_once_stiffer(monkeypatch):
    """Let passes of the penalties fail when a penalty has grown."""
    stiffen = Contact.stiffen

    def too_much(pair, found, penalty, change):
        stiffen(pair, found, penalty, change)
        pair.revert()
        raise Failed("as asked", [])

    monkeypatch.setattr(Contact, "stiffen", too_much)


def test_an_increment_whose_penalty_cannot_grow_is_cut(monkeypatch):
    """It is not accepted with more penetration than allowed: a shorter one has a pressure nearer to the last."""
    failing(monkeypatch, 2)
    result, pair = run()
    assert penetrations(result.model, result)["ball"].kept and pair.penalty > pair.initial_penalty
    assert 0.0 < abs(result["punch"][1]) < 0.2  # of .5: the first increment was cut twice


def test_where_no_increment_is_short_enough_the_excess_is_marked(monkeypatch):
    """After three failures both growths are tried, and the increment is accepted as it is."""
    tried = failing(monkeypatch, 1000)
    result, pair = run(steps=3)
    assert 5 <= len(tried) <= 2 * len(result)
    assert result["punch"][-1] == -3.0 and pair.penalty == pair.initial_penalty
    assert out_of_balance(result.model) < 2e-9  # it does not end near equilibrium
    assert not penetrations(result.model, result)["ball"].kept


def test_an_increment_that_exceeds_the_allowed_penetration_has_the_penalty_before(monkeypatch):
    failing_once_stiffer(monkeypatch)
    result, pair = run(steps=3)
    assert result["punch"][-1] == -3.0 and not penetrations(result.model, result)["ball"].kept
    assert np.all(result["ball_penalty"] == pair.initial_penalty) and pair.penalty == pair.initial_penalty


def test_an_arc_keeps_the_allowed_penetration():
    """At its end, too, where it goes back to the target at a fixed load."""
    model, move, pair = stretched()
    touch, arc = uf.Move(move.control, to=-0.5, steps=1), uf.Arc(move.control, to=-3.0, increment=0.15)
    result = uf.solve(model, [touch, arc], frames=0, progress=False)
    assert penetrations(model, result)["ball"].kept and pair.penalty > 2.0 * pair.initial_penalty
    assert result["punch"][-1] == -3.0
    plain = run()[0]
    assert result["punch_force"][-1] == pytest.approx(plain["punch_force"][-1], rel=2e-3)


def test_an_arc_that_fails_takes_its_penalty_back(monkeypatch):
    model, move, pair = stretched()
    uf.solve(model, uf.Move(move.control, to=-1.0, steps=2), frames=0, progress=False)
    grown = pair.penalty
    failing_once_stiffer(monkeypatch)
    with pytest.raises(NoConvergence):
        uf.solve(model, uf.Arc(move.control, to=-5.0, increment=0.5, cuts=0), frames=0, progress=False)
    assert pair.penalty == grown


def test_a_contact_that_allows_any_penetration_misses_none():
    model, move, pair = stretched()
    pair.allowed = math.inf
    result = uf.solve(model, move, frames=0, progress=False)
    reached = penetrations(model, result)["ball"]
    assert not pair.adapts and pair.penalty == pair.initial_penalty and reached.reached > 0.005
    assert reached.kept and "any allowed;" in reached.text and reached.record()["allowed"] is None
    assert not any("penetration" in text for text in result.warnings)
