"""Contact with multipliers: derivatives, no penetration, the converged state; and the warning of penetration."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Arc, Move
from umform.errors import InvalidValue
from umform.mesh import strip
from umform.model import Model
from umform.results.records import Failed
from umform.surfaces import Cylinder, Plane, Sphere

ELEMENT = {"hex8": "ANS3DEAS", "hex18": "MI9K3DEAS"}


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("points", [2, 4, "nodes"])
def test_force_and_tangent_are_derivatives_of_the_potential(build, rng, cell, points):
    mesh = build.jittered(strip(2.0, 1.5, 0.2, (3, 2), cell=cell), 0.1).moved((0.0, 0.0, 0.1))
    model = Model(mesh, ELEMENT[cell], material=mt.NeoHooke(E=1000.0, nu=0.3))
    contact = model.contact("lower", Sphere((1.0, 0.7, -7.97), 8.0), penalty=50.0, points=points, augmented=True)
    full = build.full_tangent(contact.block, len(mesh.points))
    u = 0.03 * rng.normal(size=full.size)
    contact.block.multipliers = np.maximum(4.0 * rng.normal(size=contact.block.points), 0.0)
    found = contact.locate(u, contact.pose)
    _, K = full(u)
    active, free = found.active, found.multiplier == 0.0
    assert 0.2 < active.mean() < 0.8
    assert (active & (found.gap > 0.0)).any()  # held by a multiplier at an open gap
    assert (active & free).any()
    assert np.abs(found.gap - found.multiplier / 50.0).min() > 1e-6  # away from the kink
    np.testing.assert_allclose(K, K.T, atol=1e-13 * np.abs(K).max())

    def potential(v):
        return contact.locate(v, contact.pose).energy()

    for _ in range(3):
        du = rng.normal(size=u.size)
        assert build.relative_error(full.force(u) @ du, build.central_difference(potential, u, du, 1e-7)) < 1e-6
        assert build.relative_error(K @ du, build.central_difference(full.force, u, du, 1e-7)) < 1e-6


@pytest.mark.parametrize(("cell", "points"), [("hex8", 2), ("hex8", "nodes"), ("hex18", 3), ("hex18", "nodes")])
def test_a_uniform_pressure_is_exact_without_a_penetration(cell, points):
    mesh = strip(2.0, 1.5, 0.5, (3, 2), cell=cell, grading=(1.5, 1.0)).moved((0.0, 0.0, 0.25))
    model = Model(mesh, ELEMENT[cell], material=mt.NeoHooke(E=1000.0, nu=0.3))
    contact = model.contact("lower", Plane(), penalty=400.0, penetration=1e-9, points=points, augmented=True)
    for face, normal in (("x0", "x"), ("x1", "x"), ("y0", "y"), ("y1", "y")):
        model.symmetry(face, normal=normal)
    load = model.traction("upper", (0.0, 0.0, -1.0))
    result = solve(model, Move(load, 8.0, steps=2), options=NewtonOptions(residual=1e-13), frames=0)
    at = contact.at_points()
    assert np.abs(at.gap).max() < 1e-9
    np.testing.assert_allclose(at.pressure, 8.0, rtol=1e-9)
    np.testing.assert_allclose(contact.multipliers, 8.0, rtol=1e-6)
    assert result["tool1_fz"][-1] == pytest.approx(-24.0, rel=1e-9)
    assert abs(result["contact_energy"][-1]) < 1e-7
    assert result.warnings == []


def bent(steps=30, depth=3.0, **contact):
    """The strip over a cylinder; its curve of force."""
    mesh = strip(60.0, 10.0, 1.0, (12, 1))
    model = Model(mesh, material=mt.J2(kappa=175e3, mu=80.77e3, hardening=mt.Linear(160, 500)))
    model.symmetry("x0", normal="x")
    model.symmetry(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), normal="y")
    punch = model.prescribe("x0_lower", "z", "punch")
    tool = Cylinder(centre=(25.0, 0.0, -20.5), axis="y", radius=20.0)
    model.contact("lower", tool, name="tool", **({"points": 10} | contact))
    result = solve(model, Move(punch, -depth, steps=steps), frames=0)
    force = np.interp(depth / 30 * np.arange(31), -result["punch"], -result["punch_force"])
    return SimpleNamespace(model=model, punch=punch, result=result, force=force)


@pytest.fixture(scope="module")
def curves():
    soft = bent(penalty=100.0)
    stiff = bent(penalty=1e4)
    held = bent(penalty=100.0, penetration=5e-4, augmented=True)
    return soft, stiff, held


def test_multipliers_give_the_force_of_a_penalty_that_is_a_hundred_times_as_stiff(curves):
    """Between the jumps; where the line of contact goes over to the next points one curve is an increment ahead."""
    soft, stiff, held = curves
    penalty_error = np.median(np.abs(soft.force - stiff.force)[3:])
    assert penalty_error > 0.1
    assert np.median(np.abs(held.force - stiff.force)[3:]) < 0.05 * penalty_error
    assert np.median(held.result["tool_penetration"][3:]) < 0.02 * np.median(soft.result["tool_penetration"][3:])


def test_multipliers_are_not_rougher_than_the_stiff_penalty(curves):
    _, stiff, held = curves
    rough = [np.abs(np.diff(run.force[8:], 2)).max() for run in (stiff, held)]
    assert rough[1] < rough[0]


def test_the_energy_balance_holds_with_multipliers():
    """The energy that multipliers put in is of the order of penalty energy, and falls with it."""
    held = bent(penalty=1000.0, augmented=True).result
    assert abs(held.balance().drift[-1]) < 0.01
    assert held.balance().force_imbalance.max() < 1e-8


def test_multipliers_are_part_of_the_converged_state(curves):
    held = bent(penalty=100.0, penetration=1e-3, augmented=True, depth=1.0, steps=10)
    model, contact = held.model, held.model.contacts[0]
    saved = model.system.snapshot()
    assert contact.multipliers.max() > 1.0
    kept = saved.terms["contact tool"]["history"].ravel()
    np.testing.assert_array_equal(kept, contact.multipliers)
    first = solve(model, Move(held.punch, -1.5, steps=5), frames=0)["punch_force"]
    assert not np.array_equal(kept, contact.multipliers)
    model.system.restore(saved)
    np.testing.assert_array_equal(contact.block.multipliers, kept)
    np.testing.assert_array_equal(solve(model, Move(held.punch, -1.5, steps=5), frames=0)["punch_force"], first)
    before = contact.multipliers.copy()
    contact.augment(contact.found, np.zeros_like(model.u))
    assert not np.array_equal(contact.block.multipliers, before)
    model.system.revert()
    np.testing.assert_array_equal(contact.block.multipliers, before)


def test_an_increment_whose_passes_fail_is_taken_as_the_penalty_has_it(monkeypatch):
    plain = bent(penalty=100.0, depth=1.0, steps=5)
    passed = bent(penalty=100.0, augmented=True, depth=1.0, steps=5).result
    column = next(name for name in passed.columns() if name.endswith("_multipliers_stay"))
    assert (passed[column] == 0.0).all()
    assert not any("pass of the multipliers" in warning for warning in passed.warnings)

    def fail(self, converged, change):
        self.system.revert()
        raise Failed("no pass today", [])

    monkeypatch.setattr(Newton, "go_on", fail)
    held = bent(penalty=100.0, augmented=True, depth=1.0, steps=5)
    told = [warning for warning in held.result.warnings if "no pass today in a pass of the multipliers" in warning]
    touched = held.result["tool_active"][1:] > 0
    assert len(told) == touched.sum() > 0
    np.testing.assert_array_equal(held.result[column][1:], touched)
    np.testing.assert_allclose(held.force, plain.force, rtol=1e-7)
    assert (held.model.contacts[0].multipliers == 0.0).all()
    assert "exceeds the 0.005 allowed" in held.result.warnings[-1]
    # The equilibrium is taken up where it was, not sought from the beginning again.
    attempts, alone = held.result.timing.attempts, plain.result.timing.attempts
    assert attempts.causes == {}
    assert attempts.evaluations < 2 * alone.evaluations


def test_an_arc_refuses_multipliers():
    case = bent(penalty=100.0, augmented=True, depth=0.2, steps=1)
    with pytest.raises(InvalidValue, match="an arc cannot be followed"):
        solve(case.model, Arc(case.punch, -0.4), frames=0)


# Warnings ---------------------------------------------------------------------------------------------------


def test_a_penetration_that_is_exceeded_is_told_once_with_a_remedy_that_helps():
    case = bent(penetration=0.005, depth=1.0, steps=5)
    assert case.result.warnings == []
    contact = case.model.contacts[0]
    soft = bent(penalty=contact.penalty, depth=1.0, steps=5)
    assert soft.result.warnings == []  # no penetration was named
    soft.model.contacts[0].allowed = 1e-4
    warned = solve(soft.model, Move(soft.punch, -1.2, steps=2), frames=0).warnings
    assert len(warned) == 1
    assert "contact tool: the penetration of" in warned[0]
    assert "or none: it then grows in the run" in warned[0]
    contact.allowed = 1e-4  # of an estimate
    kept = solve(case.model, Move(case.punch, -1.2, steps=2), frames=0)
    assert kept.warnings == [] and kept["tool_penetration"][1:].max() <= 1e-4
    stiffer = float(warned[0].split("a penalty of ")[1].split(",")[0])
    assert bent(penalty=stiffer, depth=1.2, steps=6).result["tool_penetration"].max() < 1.5e-4
