"""The balance of a run closes: external work, energies, drift of second order, resultants of all external forces."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import umform
from umform import materials as mt
from umform.analysis.run import solve
from umform.analysis.steps import Move, Release
from umform.mesh import strip
from umform.model import Model
from umform.results.balance import drift, energies
from umform.surfaces import Cylinder, Plane

COLUMNS = ("external_work", "elastic_energy", "plastic_work", "contact_energy")
STEEL = mt.J2(kappa=175e3, mu=80.77e3, hardening=mt.Voce(160.0, 320.0, 15.0))


def last_drift(run, *counts):
    """Drift at the end of runs with so many increments; all of them are in balance of forces and moments."""
    drifts = []
    for count in counts:
        balance = run(count).balance()
        assert balance.force_imbalance.max() < 1e-9
        assert balance.moment_imbalance.max() < 1e-9
        drifts.append(balance.drift[-1])
    return drifts


def assert_second_order(drifts, rel=0.05):
    for coarse, fine in pairwise(drifts):
        assert coarse / fine == pytest.approx(4.0, rel=rel)


# Where the work comes from ----------------------------------------------------------------------------------


@pytest.mark.parametrize("law", ["svk", "neo-hooke", "neo-hooke-power"])
def test_prescribed_displacement(build, materials, law):
    def run(count):
        model, pull = build.bar(material=materials[law])
        return solve(model, Move(pull, 0.3, steps=count), frames=0)

    drifts = last_drift(run, 8, 16, 32)
    assert abs(drifts[-1]) < 2e-4
    assert_second_order(drifts)


@pytest.mark.parametrize("element", ["ANS3DEAS", "EAS3DEAS", "MI9K3DEAS"])
def test_dead_load(build, element):
    def run(count):
        model, tip = build.cantilever(element=element)
        return solve(model, Move(tip, 1.0, steps=count), frames=0)

    drifts = last_drift(run, 10, 20)
    assert abs(drifts[-1]) < 3e-4
    assert_second_order(drifts)


def test_follower_pressure_that_bends_a_strip_far():
    def run(count):
        model = Model(strip(10.0, 1.0, 0.1, (6, 1)), material=mt.SVK(E=1.2e6, nu=0.0))
        model.fix("x0")
        return solve(model, Move(model.pressure("lower"), 3.0, steps=count), frames=0)

    drifts = last_drift(run, 10, 20, 40)
    assert abs(drifts[-1]) < 3e-4
    assert_second_order(drifts)


def pressed_block():
    """A soft block between sliding planes under a plane that touches all of its upper face."""
    model = Model(strip(1.0, 1.0, 0.2, (2, 2)), material=mt.NeoHooke(E=1e3, nu=0.3))
    for face, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(face, normal=normal)
    return model, model.contact("upper", Plane((0, 0, 0.1), "-z"), penalty=1e4)


def test_tool_that_is_driven():
    def run(count):
        model, contact = pressed_block()
        return solve(model, Move(model.drive(contact, "z"), -0.06, steps=count), frames=0)

    drifts = last_drift(run, 10, 20)
    assert abs(drifts[-1]) < 1e-4
    assert_second_order(drifts)
    result = run(5)
    assert result["contact_energy"][-1] > 0.3 * result["external_work"][-1]  # the penalty is soft: it counts


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (1000.0, 0.0, -2000.0)])
def test_a_tool_that_turns_does_the_work_of_its_moment_wherever_the_origin_is(place):
    at = np.array(place)
    model = Model(strip(10.0, 1.0, 1.0, (10, 1)).moved(at), material=STEEL)
    model.fix(lambda x, y, z: x - at[0] < 4.5)
    roller = Cylinder(at + np.array([8.0, 0.0, -1.5]), "y", 1.0)
    fold = model.turn(model.contact("lower", roller, name="roller"), "-y", at + np.array([5.0, 0.0, 0.0]), name="fold")
    result = solve(model, Move(fold, 0.2, steps=4), frames=0)
    work = 0.5 * (result["fold_force"][1:] + result["fold_force"][:-1]) @ np.diff(result["fold"])
    assert work > 5.0
    assert result.balance().works["roller"][-1] == pytest.approx(work, rel=1e-8)


def test_tool_that_turns_and_slides_in_time():
    """A wedge about a skew axis away from the block: force and moment, translation and rotation have their share."""

    def run(count):
        model, contact = pressed_block()
        clock = model.force("x1", (0, 0, 0), "clock")
        motion = lambda t: (np.array([0.3, 0.1, -0.01]) * t, np.array([0.02, 0.04, 0.0]) * t)  # noqa: E731
        model.set_motion(contact, motion, about=(-0.2, 2.0, 0.1))
        return solve(model, Move(clock, 1.0, steps=count), frames=0)

    drifts = last_drift(run, 20, 40, 80)
    assert abs(drifts[-1]) < 5e-5
    assert_second_order(drifts)


def test_cam_that_bends_a_strip():
    """An eccentric roll: contact comes and goes, so the drift falls, but not evenly."""

    def run(count):
        model = Model(strip(10.0, 1.0, 0.2, (8, 1)), material=mt.NeoHooke(E=1e5, nu=0.3))
        model.fix("x0")
        contact = model.contact("upper", Cylinder((7.0, 0, 3.1), "y", 3.0), penalty=1e4, points=4)
        model.set_motion(contact, lambda t: (np.zeros(3), np.array([0, 0.8 * t, 0])), about=(6.0, 0.0, 3.1))
        return solve(model, Move(model.force("x1", (0, 0, 0), "clock"), 1.0, steps=count), frames=0)

    coarse, fine = last_drift(run, 20, 80)
    assert abs(fine) < 5e-4
    assert abs(fine) < abs(coarse) / 4


def test_the_largest_drift_of_a_first_touch_falls_with_the_increments():
    """A punch that starts off the strip: the energy in the row of the first touch is no scale for its error."""

    def largest_drift(count):
        model = Model(strip(10.0, 1.0, 0.2, (8, 1)), material=mt.NeoHooke(E=210e3, nu=0.3))
        model.symmetry("x0", "x")
        model.symmetry("y0", "y")
        model.prescribe("x1_lower", "z", "support")
        punch = model.contact("upper", Cylinder((0, 0, 1.613), "y", 1.0), penalty=1e4, points=4)
        result = solve(model, Move(model.drive(punch, "z"), -2.513, steps=count), frames=0)
        return np.abs(result.balance().drift).max()

    drifts = [largest_drift(count) for count in (10, 20, 40, 80)]
    assert drifts[0] < 2e-3
    for coarse, fine in pairwise(drifts):  # each point that comes errs once: not as even as on a smooth path
        assert coarse / fine > 2.0
    assert drifts[0] / drifts[-1] > 12.0


# Plasticity and unloading -----------------------------------------------------------------------------------


def test_plastic_flow_and_a_start_from_a_deformed_state(build, materials):
    """The kink of first yield lies in the first run; the second one starts from the energies that it finds."""

    def run(count):
        model, pull = build.bar(material=materials["j2"])
        first = solve(model, Move(pull, 0.05, steps=10), frames=0)
        result = solve(model, Move(pull, 0.3, steps=count), frames=0)
        assert result["plastic_work"][0] == pytest.approx(first["plastic_work"][-1], rel=1e-12)
        assert result.balance().drift[0] == 0.0
        return result

    drifts = last_drift(run, 10, 20, 40)
    assert abs(drifts[-1]) < 1e-4
    assert_second_order(drifts)


def test_elastic_unloading_gives_all_of_the_work_back(build):
    model, tip = build.cantilever()
    result = solve(model, [Move(tip, 1.0, steps=20), Move(tip, 0.0, steps=20)], frames=0)
    balance = result.balance()
    top = int(np.argmax(balance.elastic))
    assert 0 < top < len(result) - 1
    assert abs(balance.drift[-1]) < 1e-8
    assert balance.elastic[-1] < 1e-12 * balance.elastic[top]
    assert (balance.plastic == 0.0).all()


def bent(count, release=True):
    model = Model(strip(10.0, 1.0, 0.5, (8, 1)), material=STEEL)
    model.fix("x0")
    tip = model.prescribe("x1_lower", "z", "tip")
    return solve(model, [Move(tip, 2.0, steps=count)] + [Release(tip)] * release, frames=0)


def test_a_plastic_bend_and_its_springback_close():
    result = bent(40)
    balance = result.balance()
    assert abs(balance.drift[-1]) < 2e-3
    back = balance.step == 2
    assert np.ptp(balance.plastic[back]) < 1e-12 * balance.plastic[-1]  # unloading is elastic
    assert (np.diff(balance.plastic) >= -1e-12 * balance.plastic[-1]).all()
    assert 0 < balance.elastic[-1] < 0.25 * balance.elastic[~back][-1]  # of the residual stresses
    assert balance.force_imbalance.max() < 1e-9
    assert balance.moment_imbalance.max() < 1e-9
    loaded = np.flatnonzero(~back)[-1]
    released = balance.external_work[loaded] - balance.external_work[-1]
    assert released == pytest.approx(balance.elastic[loaded] - balance.elastic[-1], rel=1e-3)


def test_the_drift_of_a_plastic_bend_falls_with_the_increments():
    coarse, fine = (abs(bent(count, release=False).balance().drift[-1]) for count in (20, 80))
    assert fine < 3e-4
    assert 8 < coarse / fine < 32


def test_a_strip_bent_over_a_tool_is_in_balance_in_each_state(build):
    case = build.free_bending((12, 1))
    result = solve(case.model, [Move(case.punch, -6.0, steps=30), Release(case.punch)], frames=0)
    balance = result.balance()
    assert balance.force_imbalance.max() < 1e-8
    assert balance.moment_imbalance.max() < 1e-8
    assert abs(balance.drift[-1]) < 3e-3
    assert result["tool_active"].max() > 0
    assert balance.contact.max() > 0.0


# Bookkeeping ------------------------------------------------------------------------------------------------


def test_a_fresh_run_starts_at_zero_and_the_table_is_that_of_the_history(build):
    case = build.free_bending((8, 1))
    result = solve(case.model, Move(case.punch, -1.0, steps=4), frames=0)
    balance = result.balance()
    assert [result[name][0] for name in COLUMNS] == [0.0] * 4
    for name, values in zip(
        COLUMNS, (balance.external_work, balance.elastic, balance.plastic, balance.contact), strict=True
    ):
        np.testing.assert_array_equal(values, result[name])
        assert (values[1:] > 0.0).any()
    found = energies(case.model, case.model.evaluate(case.model.u))
    assert (found.elastic, found.plastic, found.contact) == tuple(result[name][-1] for name in COLUMNS[1:])
    np.testing.assert_array_equal(balance.step, [0, 1, 1, 1, 1])
    np.testing.assert_array_equal(balance.time, result["time"])
    assert balance.force_imbalance[0] == balance.moment_imbalance[0] == 0.0


def test_the_drift_is_measured_against_the_largest_energy_of_the_run():
    stored, work = np.array([0.0, 1.0, 2.0, 1.0]), np.array([0.0, 1.2, 2.2, 1.4])
    np.testing.assert_allclose(drift(work, stored), [0.0, 0.1, 0.1, 0.2])
    np.testing.assert_array_equal(drift(np.array([0.0, 1.0]), np.zeros(2)), [0.0, 0.0])


@pytest.mark.parametrize("origin", [(0.0, 0.0, 0.0), (300.0, -4000.0, 50.0)])
def test_a_force_that_nothing_carries_shows_as_an_imbalance(origin):
    """A state that is no equilibrium: the load is there, its reactions are not; wherever the part is."""
    model = Model(strip(2.0, 1.0, 0.1, (2, 1)).moved(origin), material=mt.SVK(E=1e3, nu=0.3))
    model.fix("x0")
    load = model.line_load("x1", "upper", (0.0, 0.0, 1.0), "load")
    load.value = 1.0
    result = solve(model, Move(load, 1.0, steps=1), frames=0)
    balance = result.balance()
    assert balance.force_imbalance[0] == pytest.approx(1.0, rel=1e-12)
    assert balance.moment_imbalance[0] == pytest.approx(1.0 / np.hypot(1.0, np.hypot(0.5, 0.05)), rel=1e-9)
    assert balance.force_imbalance[1] < 1e-9


def test_energies_change_no_history_and_are_bitwise_the_same_for_any_number_of_threads(build):
    case = build.free_bending((30, 10))
    model = case.model
    solve(model, Move(case.punch, -1.0, steps=4), frames=0)
    before, residual = umform.threads(), model.evaluate(model.u).residual
    state = model.bodies.only.block.state
    try:
        found = set()
        for count in (1, 2, 3):
            umform.set_threads(count)
            found.add(model.bodies.only.block.energy(model.u))
    finally:
        umform.set_threads(before)
    assert len(found) == 1
    elastic, plastic = found.pop()
    assert elastic > 0.0
    assert plastic > 0.0
    np.testing.assert_array_equal(model.bodies.only.block.state, state)
    np.testing.assert_array_equal(model.evaluate(model.u).residual, residual)


def test_energy_of_a_block_is_the_integral_over_its_points(build, materials):
    case = build.free_bending((8, 1), element="EAS3DEAS", material=materials["j2"])
    solve(case.model, Move(case.punch, -2.0, steps=5), frames=0)
    block = case.model.bodies.only.block
    E, _, _, _, dV = block.point_fields(case.model.u)
    elastic, plastic = materials["j2"].law().energy(E.reshape(-1, 6), block.state.reshape(len(dV.ravel()), -1))
    assert block.energy(case.model.u) == pytest.approx((elastic @ dV.ravel(), plastic @ dV.ravel()), rel=1e-12)


def test_a_displacement_of_another_length_is_refused(build, materials):
    model, _ = build.bar(material=materials["svk"])
    with pytest.raises(ValueError, match="another length"):
        model.bodies.only.block.energy(np.zeros(5))
