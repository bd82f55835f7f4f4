"""An explicit state: nothing is written to ask a question, and another model answers for it. Names of a model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue, NotFinite
from umform.model.moved_names import MOVED
from umform.model.shown import ShownModel


def pressed(stiffness: float = 400.0) -> tuple[uf.Model, list[uf.Move]]:
    """A plastic strip on a cylinder under a punch on springs, and a tool that turns in time."""
    mesh = uf.mesh.strip(20.0, 1.0, 1.0, (12, 1)).transformed(lambda x: np.add(x, (0.0, 0.0, 0.5)))
    model = uf.Model(mesh, "ANS3DEAS", material=uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(160.0, 500.0)))
    model.symmetry("x0", "x")
    model.fix(np.arange(len(mesh.points)), "y")
    model.contact("lower", uf.Cylinder((10.0, 0.0, -5.0), "y", 5.0), penalty=1e4, points=3, name="die")
    punch = model.contact("upper", uf.Cylinder((0.0, 0.0, 6.0), "y", 5.0), penalty=1e4, points=3, name="punch")
    model.set_motion(punch, lambda time: np.array([0.0, 0.0, -0.05 * time]))
    spring = model.spring(punch, "-z", stiffness=stiffness, preload=1.0, name="spring")
    return model, [uf.Move(spring, 60.0, steps=4)]


@pytest.fixture(scope="module")
def run():
    model, steps = pressed()
    return model, uf.solve(model, steps, frames=0, progress=False)


def test_an_evaluation_at_a_state_is_that_of_the_present_and_writes_nothing(run):
    model, _ = run
    present = model.evaluate(model.system.x)
    other = model.state.toward({"spring": 7.0}, time=model.state.time + 0.3)
    elsewhere = model.evaluate(other)
    assert elsewhere.time == other.time and elsewhere.controls[model.controls[0]] == 7.0
    assert not np.array_equal(elsewhere.residual, present.residual)
    later = model.evaluate(model.state.toward({}, time=model.state.time + 0.3))  # the punch moves in time
    assert not np.array_equal(later.residual, present.residual)
    assert model.state.time == 1.0 and model.controls[0].value == 60.0
    again = model.evaluate(model.state)
    np.testing.assert_array_equal(again.residual, present.residual)
    np.testing.assert_array_equal(again.values, present.values)


def test_a_state_of_one_model_is_evaluated_with_another_of_the_same_structure(run):
    """A second run beside the first one: controls, time and unknowns of the first, histories of its own."""
    model, _ = run
    twin, _ = pressed()
    twin.system.restore(model.system.snapshot())
    expected = model.evaluate(model.state)
    found = twin.evaluate(model.state)
    np.testing.assert_array_equal(found.residual, expected.residual)
    np.testing.assert_array_equal(found.values, expected.values)
    changed, _ = pressed(stiffness=401.0)
    changed.system.restore(model.system.snapshot())
    assert not np.array_equal(changed.evaluate(model.state).residual, expected.residual)


def test_a_scalar_unknown_moves_its_controls_on_the_way_to_a_goal(run):
    model, _ = run
    goal = model.state.toward({"spring": 70.0})
    x = goal.x.copy()
    x[-1] += 0.125
    moved = model.system.state_at(x, goal)
    assert moved.controls["spring"] == 70.0
    assert moved.controls["spring_way"] == pytest.approx(goal.controls["spring_way"] + 0.125)
    assert model.controls[1].value == goal.controls["spring_way"]


def test_a_failed_increment_and_a_tangent_leave_controls_and_time_alone(run):
    model, _ = run
    state = model.state
    with pytest.raises(uf.errors.NoConvergence):
        uf.solve(model, uf.Move(model.controls[0], -1e9, steps=1, cuts=0), frames=0, progress=False)
    after = model.state
    np.testing.assert_array_equal(after.x, state.x)
    assert replace(after, x=0) == replace(state, x=0)


def test_a_state_without_a_control_of_the_model_is_refused_by_name(run):
    model, _ = run
    with pytest.raises(InvalidValue, match="spring_way"):
        model.evaluate(replace(model.state, controls={"spring": 1.0}))


@pytest.mark.parametrize("wrong", [{"sprnig": 1.0}, {"spring": float("nan")}])
def test_a_state_goes_toward_finite_values_of_known_controls(run, wrong):
    model, _ = run
    with pytest.raises(InvalidValue, match=f"control {next(iter(wrong))}") as caught:
        model.state.toward(wrong)
    assert "spring" in caught.value.remedy


def test_where_a_cell_is_turned_inside_out_there_is_no_residual():
    model, _ = pressed()
    x = model.state.x.copy()
    x[3 * model.mesh.nodes("x1")] = -30.0
    at = model.evaluate(x)
    assert at.failed == 11
    assert np.isnan(at.residual).all()
    assert np.isfinite(model.evaluate(model.state).residual).all()
    with pytest.raises(InvalidValue, match="156 displacements, 1 scalar unknowns"):
        model.evaluate(model.u)


def test_a_displacement_has_a_row_of_its_own_shape():
    model, _ = pressed()
    with pytest.raises(InvalidValue, match="three components for each node"):
        model.u = np.zeros((len(model.mesh.points), 3))


def test_a_displacement_is_finite():
    model, _ = pressed()
    wrong = model.u.copy()
    wrong[4] = np.nan
    with pytest.raises(NotFinite, match="component 4"):
        model.u = wrong
    assert np.isfinite(model.u).all()


# Names of a model ---------------------------------------------------------------------------------------------


def test_a_model_has_few_names_and_no_attribute_of_others(run):
    """Its base only shows it; what is not for users belongs to its parts, each of which sets its own attributes."""
    model, _ = run
    assert uf.Model.__bases__ == (ShownModel,)
    names = [name for name in dir(model) if not name.startswith("_")]
    assert len(names) <= 44
    assert set(names).isdisjoint(MOVED)


@pytest.mark.parametrize("name", sorted(MOVED))
def test_an_old_name_is_found_with_a_warning_that_says_the_new_one(run, name):
    model, _ = run
    with pytest.warns(DeprecationWarning, match=f"model.{name} is now called model.{MOVED[name]}"):
        getattr(model, name)


def test_a_name_that_a_model_never_had_is_an_attribute_error(run):
    with pytest.raises(AttributeError, match="no attribute 'never'"):
        _ = run[0].never
