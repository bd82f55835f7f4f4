"""Rules of contact: penalty from penetration, number of points, multipliers, and a V-die with two tools."""

from __future__ import annotations

import logging
import math
from types import SimpleNamespace

import numpy as np
import pytest

from umform import balance, increment
from umform import materials as mt
from umform.contact.encounter import sheet_thickness
from umform.contact.settings import contact_length
from umform.errors import InvalidPenalty, InvalidValue
from umform.mesh import graded, grid, strip
from umform.model import Model
from umform.newton import Failed, Newton, NewtonOptions
from umform.results import Result
from umform.steps import Arc, Move, Release, resume, solve
from umform.surfaces import Cylinder, Extruded, Plane, Profile, Punch, Sphere, VDie
from umform.user_law import UserLaw

PLASTIC = mt.J2(E=210e3, nu=0.3, hardening=mt.Perfect(200.0))
DC04_LIKE = mt.J2(E=210e3, nu=0.3, hardening=mt.Swift(strength=520.0, offset=0.004, exponent=0.22))
ELEMENT = {"hex8": "ANS3DEAS", "hex18": "MI9K3DEAS"}


def lifted(z):
    return lambda x: x + np.array([0.0, 0.0, z])


def sheet(cells=(20, 1), cell="hex8", unit=1.0, law=PLASTIC):
    return Model(strip(40.0 * unit, 10.0 * unit, 1.0 * unit, cells, cell=cell), ELEMENT[cell], material=law)


def roller(radius=10.0, unit=1.0):
    return Cylinder((20.0 * unit, 0.0, -(radius + 0.5) * unit), "y", radius * unit)


# Penalty from penetration -----------------------------------------------------------------------------------


def test_the_penalty_carries_the_line_force_of_a_plastic_bend_at_the_penetration_that_is_allowed():
    model = sheet()
    contact = model.contact("lower", roller(), penetration=0.004, points=10)
    line_force = 2.0 / math.sqrt(3.0) * 200.0 * 1.0 / 8.0
    assert contact.penalty == pytest.approx(line_force / (0.004 * 4 / 3 * math.sqrt(2 * 10 * 0.004)), rel=0.01)
    assert contact.allowed == 0.004
    assert contact_length(10.0, line_force, contact.penalty) == pytest.approx(2 * math.sqrt(2 * 10 * 0.004), rel=0.01)
    coarse = sheet().contact("lower", roller(), penetration=0.004, points=1)  # one row takes it all
    assert coarse.penalty == pytest.approx(line_force / (0.004 * 2.0), rel=0.01)


def test_a_200th_of_the_thickness_is_allowed_by_default():
    contact = sheet().contact("lower", roller())
    assert contact.allowed == pytest.approx(1 / 200)
    assert contact.penalty == sheet().contact("lower", roller(), penetration=1 / 200).penalty
    assert (contact.points, contact.augmented) == (2, False)


@pytest.mark.parametrize("layers", [1, 2, 3])
def test_the_thickness_is_that_of_all_layers(layers):
    mesh = grid(graded(4.0, 4), [0.0, 1.0], graded(0.6, layers))
    assert sheet_thickness(mesh) == pytest.approx(0.6)


@pytest.mark.parametrize("law", [PLASTIC, mt.NeoHooke(E=1000.0, nu=0.3), mt.SVK(E=1000.0, nu=0.0)])
def test_the_estimate_knows_no_units(law):
    """A sheet in metres and pascals gets the penalty of the same sheet in millimetres and megapascals."""
    small = mt.J2(E=210e9, nu=0.3, hardening=mt.Perfect(200e6)) if law is PLASTIC else type(law)(E=1000e6, nu=law.nu)
    mm = sheet(law=law).contact("lower", roller(), points="auto")
    m = sheet(law=small, unit=1e-3).contact("lower", roller(unit=1e-3), points="auto")
    assert m.penalty == pytest.approx(1e9 * mm.penalty, rel=1e-6)
    assert m.points == mm.points


def test_a_thin_elastic_sheet_bends_at_the_stress_of_the_radius():
    """E / (1 - nu^2) times h / (2 R + h) at the faces."""
    contact = sheet(law=mt.SVK(E=1000.0, nu=0.3)).contact("lower", roller(radius=20.0), penetration=0.01, points=10)
    line_force = 1000.0 / 0.91 / 41.0 / 8.0
    assert contact.penalty == pytest.approx(line_force / (0.01 * 4 / 3 * math.sqrt(2 * 20 * 0.01)), rel=0.05)


@pytest.mark.parametrize(
    "tool",
    [
        Plane((0.0, 0.0, -0.5)),
        Cylinder((20.0, 0.0, 49.5), "y", 50.0, inside=True),
        Sphere((20.0, 5.0, -5.5), 5.0),
        Extruded(Profile.from_corners([(20.0, -9.0), (20.0, -0.5), (0.0, -0.5)], 0.0, closed=False)),
    ],
    ids=["flat", "hollow", "sphere", "edge"],
)
def test_any_tool_gets_a_penalty_that_the_sheet_can_feel(tool):
    contact = sheet().contact("lower", tool, points="auto")
    assert 1e-3 * 210e3 < contact.penalty <= 10.0 * 210e3 / 0.91 * 1.001
    assert 2 <= contact.points <= 10


def test_a_law_without_a_stress_is_refused():
    nothing = UserLaw(lambda E, state: (0 * E, np.tile(np.eye(6), (len(E), 1, 1)), state), name="nothing")
    model = sheet(law=nothing)
    with pytest.raises(InvalidPenalty, match="no bending stress"):
        model.contact("lower", roller())
    assert model.contact("lower", roller(), penalty=5.0).penalty == 5.0


@pytest.mark.parametrize("penetration", [0.0, -1.0, math.nan, math.inf])
def test_a_penetration_must_be_positive(penetration):
    with pytest.raises(InvalidValue, match="penetration that is allowed"):
        sheet().contact("lower", roller(), penetration=penetration)


def test_penalty_and_penetration_together_are_for_multipliers():
    with pytest.raises(InvalidValue, match="not both"):
        sheet().contact("lower", roller(), penalty=1.0, penetration=0.1)
    both = sheet().contact("lower", roller(), penalty=1.0, penetration=0.1, augmented=True)
    assert (both.penalty, both.allowed) == (1.0, 0.1)
    assert sheet().contact("lower", roller(), penalty=1.0).allowed is None


# Number of points -------------------------------------------------------------------------------------------


def wanted(length, penalty, radius=10.0):
    """Two points within the length that touches."""
    return 2.0 * length / contact_length(radius, 2.0 / math.sqrt(3.0) * 200.0 / 8.0, penalty)


@pytest.mark.parametrize(("cells", "penalty"), [(10, 300.0), (20, 1000.0), (20, 5000.0), (40, 5000.0), (10, 200.0)])
def test_points_grow_with_the_length_of_a_facet_and_the_cube_root_of_the_penalty(cells, penalty):
    expected = wanted(40.0 / cells, penalty)
    assert 2 < expected < 10
    contact = sheet((cells, 1)).contact("lower", roller(), penalty=penalty, points="auto")
    assert contact.points == math.ceil(expected)
    assert contact.block.points == cells * contact.points**2


def test_only_the_length_across_the_tool_counts():
    """Ten times as wide facets along the cylinder need no more points."""
    across = sheet((20, 1)).contact("lower", roller(), penalty=1000.0, points="auto")
    wide = Model(strip(40.0, 100.0, 1.0, (20, 1)), material=PLASTIC)
    assert wide.contact("lower", roller(), penalty=1000.0, points="auto").points == across.points


@pytest.mark.parametrize(("cell", "least"), [("hex8", 2), ("hex18", 3)])
def test_points_are_neither_too_few_nor_too_many(cell, least):
    soft = sheet(cell=cell).contact("lower", roller(), penalty=1e-6, points="auto")
    stiff = sheet(cell=cell).contact("lower", roller(), penalty=1e9, points="auto")
    assert (soft.points, stiff.points) == (least, 10)


def test_the_choice_is_logged(caplog):
    with caplog.at_level(logging.INFO, logger="umform.contact"):
        sheet().contact("lower", roller(), points="auto", name="die")
    assert "contact die: thickness 1, tool radius 10" in caplog.text


# Multipliers ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("points", [2, 4, "nodes"])
def test_force_and_tangent_are_derivatives_of_the_potential(build, rng, cell, points):
    mesh = build.jittered(strip(2.0, 1.5, 0.2, (3, 2), cell=cell), 0.1).transformed(lifted(0.1))
    model = Model(mesh, ELEMENT[cell], material=mt.NeoHooke(E=1000.0, nu=0.3))
    contact = model.contact("lower", Sphere((1.0, 0.7, -7.97), 8.0), penalty=50.0, points=points, augmented=True)
    contact.place(0.0)
    full = build.full_tangent(contact.block, len(mesh.points))
    u = 0.03 * rng.normal(size=full.size)
    contact.block.multipliers = np.maximum(4.0 * rng.normal(size=contact.block.points), 0.0)
    _, K = full(u)
    active, free = contact.active(), contact.block.multipliers == 0.0
    assert 0.2 < active.mean() < 0.8
    assert (active & (contact.block.gaps > 0.0)).any()  # held by a multiplier at an open gap
    assert (active & free).any()
    assert np.abs(contact.block.gaps - contact.block.multipliers / 50.0).min() > 1e-6  # away from the kink
    np.testing.assert_allclose(K, K.T, atol=1e-13 * np.abs(K).max())

    def potential(v):
        contact.block.locate(v)
        return balance._contact_energy(contact)

    for _ in range(3):
        du = rng.normal(size=u.size)
        assert build.relative_error(full.force(u) @ du, build.central_difference(potential, u, du, 1e-7)) < 1e-6
        assert build.relative_error(K @ du, build.central_difference(full.force, u, du, 1e-7)) < 1e-6


@pytest.mark.parametrize(("cell", "points"), [("hex8", 2), ("hex8", "nodes"), ("hex18", 3), ("hex18", "nodes")])
def test_a_uniform_pressure_is_exact_without_a_penetration(cell, points):
    mesh = strip(2.0, 1.5, 0.5, (3, 2), cell=cell, grading=(1.5, 1.0)).transformed(lifted(0.25))
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
    saved = model.snapshot()
    assert contact.multipliers.max() > 1.0
    np.testing.assert_array_equal(saved.multipliers[0], contact.multipliers)
    first = solve(model, Move(held.punch, -1.5, steps=5), frames=0)["punch_force"]
    assert not np.array_equal(saved.multipliers[0], contact.multipliers)
    model.restore(saved)
    np.testing.assert_array_equal(contact.block.multipliers, saved.multipliers[0])
    np.testing.assert_array_equal(solve(model, Move(held.punch, -1.5, steps=5), frames=0)["punch_force"], first)
    before = contact.multipliers.copy()
    contact.augment(np.zeros_like(model.u))
    assert not np.array_equal(contact.block.multipliers, before)
    model.revert()
    np.testing.assert_array_equal(contact.block.multipliers, before)


def test_an_increment_whose_passes_fail_is_taken_as_the_penalty_has_it(monkeypatch, caplog):
    plain = bent(penalty=100.0, depth=1.0, steps=5)

    def fail(self, converged, change):
        self.system.revert()
        raise Failed("no pass today", [])

    monkeypatch.setattr(Newton, "go_on", fail)
    with caplog.at_level(logging.INFO, logger="umform.steps"):
        held = bent(penalty=100.0, augmented=True, depth=1.0, steps=5)
    assert "no pass today in a pass of the multipliers" in caplog.text
    np.testing.assert_allclose(held.force, plain.force, rtol=1e-7)
    assert (held.model.contacts[0].multipliers == 0.0).all()
    assert "exceeds the 0.005 allowed" in held.result.warnings[0]


def test_an_arc_refuses_multipliers():
    case = bent(penalty=100.0, augmented=True, depth=0.2, steps=1)
    with pytest.raises(InvalidValue, match="an arc cannot be followed"):
        solve(case.model, Arc(case.punch, -0.4), frames=0)


def test_a_run_with_multipliers_goes_on_from_its_checkpoint(tmp_path, monkeypatch):
    def case():
        model, stroke = vdie(penetration=0.002, penalty=1e5, augmented=True)
        return model, [Move(stroke, 0.6, steps=6), Move(stroke, 0.58, steps=4)]

    whole = solve(*case(), frames=0)
    keep, calls = increment.Run.keep, []

    def power_cut(self, *args, **options):
        calls.append(self.number)
        if len(calls) == 8:
            raise RuntimeError("power cut")
        keep(self, *args, **options)

    path = tmp_path / "run.checkpoint"
    with monkeypatch.context() as patch:
        patch.setattr(increment.Run, "keep", power_cut)
        with pytest.raises(RuntimeError, match="power cut"):
            solve(*case(), frames=0, checkpoint=path, every=0)
    model, steps = case()
    np.testing.assert_array_equal(resume(path, model, steps, frames=0)["stroke_force"], whole["stroke_force"])
    assert model.contacts[0].multipliers.max() > 1.0


# Warnings ---------------------------------------------------------------------------------------------------


def test_a_penetration_that_is_exceeded_is_told_once_with_a_remedy_that_helps():
    case = bent(penetration=0.005, depth=1.0, steps=5)
    assert case.result.warnings == []
    contact = case.model.contacts[0]
    soft = bent(penalty=contact.penalty, depth=1.0, steps=5)
    assert soft.result.warnings == []  # no penetration was named
    contact.allowed = 1e-4
    warned = solve(case.model, Move(case.punch, -1.2, steps=2), frames=0).warnings
    assert len(warned) == 1
    assert "contact tool: the penetration of" in warned[0]
    assert "or augmented=True" in warned[0]
    stiffer = float(warned[0].split("a penalty of ")[1].split(",")[0])
    assert bent(penalty=stiffer, depth=1.2, steps=6).result["tool_penetration"].max() < 1.5e-4


# Two tools --------------------------------------------------------------------------------------------------


def vdie(cells=24, cell="hex8", **contact):
    """Half of a sheet of 2 mm in a die of 16 mm, plane strain; the punch is driven."""
    mesh = strip(16.0, 1.0, 2.0, (cells, 1), cell=cell).transformed(lifted(1.0))
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
    np.testing.assert_allclose(result["stroke_force"], result["punch_fz"] * -1.0, atol=1e-9)
    assert result["die_fz"][-1] == pytest.approx(-result["punch_fz"][-1], rel=1e-9)
    assert 80.0 < result["punch_fz"][-1] < 86.0
    assert not any("chatter" in warning for warning in result.warnings)
    loaded = model.u.copy()
    released = solve(model, Release(stroke), frames=0)
    assert "the force is zero" in released.events[-1] or "lifted off" in released.events[-1]
    assert abs(released["stroke_force"][-1]) <= 1e-6 * abs(released["stroke_force"][0])
    assert 3.7 < stroke.value < 3.9
    tip = (model.u - loaded).reshape(-1, 3)[model.mesh.nodes("x1")]
    assert (tip[:, 0] > 0.15).all()  # the leg swings outwards


def test_each_pair_of_two_tools_has_its_own_rule():
    model, _ = vdie(points="auto")
    die, punch = model.contacts
    assert die.penalty < punch.penalty  # the punch is sharper
    assert die.block.points == 24 * die.points**2


def test_all_elements_slide_around_the_shoulder_without_a_chatter():
    model, stroke = vdie(cells=48, penalty=1e5)
    result = solve(model, Move(stroke, 5.0, steps=20), frames=0)
    assert len(result) == 21
    assert result.warnings == []
    x = model.mesh.points[:, 0] + model.u.reshape(-1, 3)[:, 0]
    lower = model.mesh.nodes("lower")
    over = lambda x: (x > 6.5) & (x < 9.5)  # noqa: E731
    assert not np.intersect1d(lower[over(x[lower])], lower[model.mesh.points[lower, 0] < 7.0]).size
    assert (model.mesh.points[lower[over(x[lower])], 0] > 8.0).any()


def test_the_tangent_goes_with_a_driven_tool():
    """Its first residual is of second order in the way of the tool; at the new place of the tool it is of the first."""
    model, stroke = vdie(penalty=1e5)
    solve(model, Move(stroke, 2.0, steps=10), frames=0)
    saved, ways, norms = model.snapshot(), (2e-4, 1e-4), []
    for way in ways:
        model.restore(saved)
        model.evaluate(model.u)
        run = increment.Run(model, Newton(model), Result(model))
        stroke.value = 2.0 - way
        du = increment._tangent(run, {stroke: 2.0}, model.time)
        assert stroke.value == 2.0 - way
        model.recover(du, 1.0)
        norms.append(np.linalg.norm(model.restrict(model.evaluate(model.u + du).residual)))
        model.revert()
        stroke.value = 2.0
    assert norms[0] / norms[1] == pytest.approx(4.0, rel=0.2)
