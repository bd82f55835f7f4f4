"""Two tools at once: a V-die with a driven punch; driven tools and the first increment."""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.strategies import Increment
from umform.analysis.newton.strategy_statistics import StrategyStatistics
from umform.analysis.run import resume, solve
from umform.analysis.steps import Move, Release
from umform.analysis.steps.run_state import Run
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import Cylinder, Punch, VDie

ELEMENT = {"hex8": "ANS3DEAS", "hex18": "MI9K3DEAS"}
DC04_LIKE = mt.J2(E=210e3, nu=0.3, hardening=mt.Swift(strength=520.0, offset=0.004, exponent=0.22))


def vdie(cells=24, cell="hex8", **contact):
    """Half of a sheet of 2 mm in a die of 16 mm, plane strain; the punch is driven."""
    mesh = strip(16.0, 1.0, 2.0, (cells, 1), cell=cell).moved((0.0, 0.0, 1.0))
    model = Model(mesh, ELEMENT[cell], material=DC04_LIKE)
    model.symmetry("x0", "x")
    model.fix(np.arange(len(mesh.points)), "y")
    options = {"points": 3} | contact
    model.contact("lower", VDie(16.0, 85.0, 2.0), name="die", **options)
    punch = model.contact("upper", Punch(1.5, 85.0, origin=(0.0, 0.0, 2.0)), name="punch", **options)
    return model, model.drive(punch, "-z", name="stroke")


V_DIES = {
    "penalty": {"penalty": 1e5},
    "penetration": {"penetration": 0.01},
    "stiff": {"penalty": 1e6, "points": 5},
    "multipliers": {"penetration": 0.002, "penalty": 1e5, "augmented": True},
    "own rules": {"points": "auto"},
}


@pytest.mark.parametrize("name", V_DIES)
def test_a_sheet_is_bent_in_a_v_die_and_springs_back(name):
    model, stroke = vdie(**V_DIES[name])
    result = solve(model, Move(stroke, 4.0, steps=20), frames=0)
    assert len(result) == 21  # no increment was cut
    assert result["iterations"][1:].mean() < (12 if name in ("multipliers", "stiff") else 9)
    np.testing.assert_allclose(result["stroke_force"], result["punch_fz"], atol=1e-9)
    assert result["die_fz"][-1] == pytest.approx(-result["punch_fz"][-1], rel=1e-9)
    assert result["punch_fz"][-1] == pytest.approx(47.3, rel=0.02)  # eight layers of EAS3DEAS, order 2, 48 along
    assert not any("chatter" in warning for warning in result.warnings)
    loaded = model.u.copy()
    released = solve(model, Release(stroke), frames=0)
    assert "the force is zero" in released.events[-1] or "lifted off" in released.events[-1]
    assert abs(released["stroke_force"][-1]) <= 1e-6 * abs(released["stroke_force"][0])
    assert 3.8 < stroke.value < 3.95
    tip = (model.u - loaded).reshape(-1, 3)[model.mesh.nodes("x1")]
    assert (tip[:, 0] > 0.05).all()  # the leg swings outwards


def test_each_pair_of_two_tools_has_its_own_rule():
    model, _ = vdie(points="auto")
    die, punch = model.contacts
    assert die.penalty < punch.penalty  # the punch is sharper
    assert die.block.points == 24 * die.points**2


def test_all_elements_slide_around_the_shoulder_without_a_chatter():
    model, stroke = vdie(cells=48, penalty=1e5)
    result = solve(model, Move(stroke, 5.0, steps=20), frames=0)
    assert len(result) == 21
    assert all("the energies differ" in text for text in result.warnings)  # in so few increments
    x = model.mesh.points[:, 0] + model.u.reshape(-1, 3)[:, 0]
    lower = model.mesh.nodes("lower")
    over = lambda x: (x > 6.5) & (x < 9.5)  # noqa: E731
    assert not np.intersect1d(lower[over(x[lower])], lower[model.mesh.points[lower, 0] < 7.0]).size
    assert (model.mesh.points[lower[over(x[lower])], 0] > 8.0).any()


def test_the_tangent_follows_a_driven_tool():
    """Its first residual is of second order in the way of the tool; at the new place of the tool it is of the first."""
    model, stroke = vdie(penalty=1e5)
    solve(model, Move(stroke, 2.0, steps=10), frames=0)
    saved, ways, norms = model.system.snapshot(), (2e-4, 1e-4), []
    for way in ways:
        model.system.restore(saved)
        last = model.evaluate(model.u)
        newton = Newton(model.system)
        goal = model.state.toward({stroke.name: 2.0 - way})
        du = Increment(model, newton, StrategyStatistics(), goal, (stroke,), None, last).tangent()
        assert stroke.value == 2.0
        model.system.recover(du)
        norms.append(
            np.linalg.norm(model.system.restrict(model.evaluate(model.system.state_at(model.u + du, goal)).residual))
        )
        model.system.revert()
    assert norms[0] / norms[1] == pytest.approx(4.0, rel=0.2)


def pressed(away):
    """An elastic strip, held at x = 0 by a support that can move, under a roller that is some way off."""
    model = Model(strip(10.0, 1.0, 0.2, (10, 1)), material=mt.SVK(E=1000.0, nu=0.3))
    model.fix("x0", "xy")
    support = model.prescribe("x0", "z", "support")
    contact = model.contact("upper", Cylinder((8.0, 0.0, 1.1 + away), "y", 1.0), penalty=50.0, points=5)
    return model, support, model.drive(contact, "-z", "roller")


def test_a_driven_tool_may_still_have_to_come():
    model, _, roller = pressed(0.05)
    result = solve(model, Move(roller, 0.3, steps=6), frames=0)
    assert len(result) == 7
    assert result["roller_force"][0] == 0.0
    assert (np.diff(result["roller_force"][1:]) > 0.0).all()
    assert -model.u.reshape(-1, 3)[:, 2].min() > 0.24
    assert result.warnings == []


def test_tool_and_support_that_move_together_carry_the_sheet_along():
    """The tangent has the rates of both: it is exact for a translation."""
    model, support, roller = pressed(0.0)
    solve(model, Move(roller, 0.2, steps=4), frames=0)
    before = model.u.reshape(-1, 3) + np.array([0.0, 0.0, -0.5])
    result = solve(model, Move([roller, support], [0.7, -0.5], steps=1), frames=0)
    assert result["iterations"][-1] <= 2
    np.testing.assert_allclose(model.u.reshape(-1, 3), before, atol=1e-8)
    assert result["roller_force"][-1] == pytest.approx(result["roller_force"][0], rel=1e-6)


def test_a_run_with_multipliers_goes_on_from_its_checkpoint(tmp_path, monkeypatch):
    def case():
        model, stroke = vdie(penetration=0.002, penalty=1e5, augmented=True)
        return model, [Move(stroke, 0.6, steps=6), Move(stroke, 0.58, steps=4)]

    whole = solve(*case(), frames=0)
    keep, calls = Run.keep, []

    def power_cut(self, *args, **options):
        calls.append(self.number)
        if len(calls) == 8:
            raise RuntimeError("power cut")
        keep(self, *args, **options)

    path = tmp_path / "run.checkpoint"
    with monkeypatch.context() as patch:
        patch.setattr(Run, "keep", power_cut)
        with pytest.raises(RuntimeError, match="power cut"):
            solve(*case(), frames=0, checkpoint=path, every=0)
    model, steps = case()
    np.testing.assert_array_equal(resume(path, model, steps, frames=0)["stroke_force"], whole["stroke_force"])
    assert model.contacts[0].multipliers.max() > 1.0
