import numpy as np
import pytest

from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue, NoConvergence
from umform.processes import FreeBending, free_bending
from umform.processes.bending import case as case_module
from umform.processes.bending.case import build, measured
from umform.processes.problems import quantities_named


def test_forces_of_the_reference_in_a_few_steps():
    run = free_bending(FreeBending(steps=60), progress=False)
    assert [one.name for one in run.quantities] == quantities_named(FreeBending())
    assert run.forces == pytest.approx([18.793, 21.760, 27.890, 33.513], rel=2e-3)
    assert run.zero_force == pytest.approx(14.655, rel=1e-4)
    assert abs(run.F[-1]) < 1e-5 * run.F.max()
    assert run.solver == "multifrontal"
    assert run.failure == ""
    assert run.shape.points[:, 2].min() < -15.0


def test_step_doubling_at_the_first_mark():
    coarse, fine = (
        free_bending(FreeBending(stroke=2.0, steps=steps, unload=False), progress=False) for steps in (10, 40)
    )
    assert coarse.forces[-1] == pytest.approx(18.79, rel=2e-3)
    assert coarse.forces[-1] == pytest.approx(fine.forces[-1], rel=1e-3)
    assert coarse.zero_force is None


def test_more_contact_points_make_a_smoother_curve():
    runs = [
        free_bending(FreeBending(contact=contact, steps=100, unload=False), progress=False)
        for contact in ("nodes", 2, 5)
    ]
    jumps, deviations = [run.jump for run in runs], [run.roughness for run in runs]
    assert jumps[0] > 2 * jumps[1] > 2 * jumps[2]
    assert deviations[0] > 2 * deviations[1] > 4 * deviations[2]


def test_hardening_stiffens():
    soft, hard = (
        free_bending(FreeBending(hardening=modulus, stroke=3.0, steps=15, unload=False), progress=False)
        for modulus in (0.0, 5000.0)
    )
    assert hard.F[-1] > 1.01 * soft.F[-1]


def test_tool_follows_radius_and_thickness():
    assert FreeBending().centre == (25.0, 0.0, -20.5)
    assert FreeBending(radius=10.0, thickness=2.0).centre == (25.0, 0.0, -11.0)
    assert FreeBending(tool_z=-30.0).centre == (25.0, 0.0, -30.0)


def test_names_and_likeness_to_the_example():
    case = FreeBending(mesh=(48, 2), thickness_order=3, tie_E33=True, steps=10, solver="superlu")
    assert case.name == "ANS3DEAS 48x2 2x2 order 3 tied"
    assert FreeBending(contact="nodes").name == "ANS3DEAS 24x1 nodes"
    assert case.is_example
    assert not FreeBending(radius=19.0).is_example
    assert not FreeBending(hardening=500.0).is_example


@pytest.mark.parametrize(
    "wrong", [{"stroke": 0.0}, {"element": "FOO"}, {"penalty": -1.0}, {"contact": 11}, {"thickness_order": 5}]
)
def test_wrong_parameters_are_refused(wrong):
    with pytest.raises(InvalidValue):
        free_bending(FreeBending(**wrong), progress=False)


def test_a_case_that_ends_early_keeps_what_it_reached(monkeypatch):
    case = FreeBending(steps=20, unload=False)

    def stop_half_way(model, steps, **options):
        punch = model.controls[0]
        error = NoConvergence("stopped", where="half way")
        error.result = solve(model, [Move(punch, to=-7.5, steps=10)], progress=False)
        raise error

    monkeypatch.setattr(case_module, "solve", stop_half_way)
    with pytest.raises(NoConvergence) as caught:
        free_bending(case)
    run = measured(case, caught.value.result, caught.value)
    assert run.u[-1] == pytest.approx(7.5)
    assert run.forces[1] is not None
    assert run.forces[2:] == [None, None]
    assert run.zero_force is None
    assert "half way" in run.failure


def test_model_of_the_case():
    model, punch = build(FreeBending(mesh=(6, 2), element="MI9K3DEAS", contact=3))
    assert punch.name == "punch"
    assert len(punch.dofs) == 5
    assert model.mesh.cell == "hex18"
    assert np.flatnonzero(model.supports.fixed[1::3]).size == 1


@pytest.mark.parametrize(
    ("setting", "word"),
    [
        ({"thickness_order": 3, "tie_E33": True}, "tilt"),
        ({"element": "MI9K3DEAS", "contact": 2}, "jumpy"),
        ({"contact": 1}, None),
    ],
)
def test_settings_that_mislead_are_said(setting, word):
    case = FreeBending(mesh=(6, 1), stroke=0.2, steps=2, unload=False, **setting)
    warnings = free_bending(case, progress=False).warnings
    assert len(warnings) == (1 if word else 0)
    assert all(word in warning for warning in warnings)


@pytest.fixture(scope="module")
def full():
    """The runs of the example on its coarse mesh, with all their increments; seconds in all."""
    return {contact: free_bending(FreeBending(contact=contact), progress=False) for contact in ("nodes", 2, 5)}


def test_smoothness_of_the_example(full):
    jumps, deviations = [run.jump for run in full.values()], [run.roughness for run in full.values()]
    assert jumps == pytest.approx([0.0596, 0.0136, 0.0090], rel=0.02)
    assert deviations == pytest.approx([0.0306, 0.0075, 0.0018], rel=0.03)
    assert jumps[0] > jumps[1] > jumps[2]
    assert deviations[0] > deviations[1] > deviations[2]


def test_forces_of_the_example(full):
    assert full[2].forces == pytest.approx([18.793, 21.761, 27.890, 33.514], rel=5e-3)
    assert full[2].zero_force == pytest.approx(14.656, rel=5e-3)


def test_line_search_comes_to_the_same_forces():
    with_it, without = (
        free_bending(FreeBending(steps=10, stroke=2.0, unload=False, line_search=choice), progress=False)
        for choice in (True, False)
    )
    assert with_it.forces == pytest.approx(without.forces, rel=1e-6)
    assert with_it.case.is_example == without.case.is_example


@pytest.mark.parametrize(
    ("field", "value"),
    [("length", float("inf")), ("mesh", (0, 1)), ("mesh", (3,)), ("contact", "node"), ("steps", 2.5), ("mu", "x")],
)
def test_a_wrong_parameter_is_named(field, value):
    with pytest.raises(InvalidValue) as caught:
        FreeBending(**{field: value})
    assert caught.value.where == field
    assert caught.value.cause
    assert caught.value.remedy


@pytest.mark.parametrize(
    ("setting", "room"),
    [({"radius": 30.0}, "12.67"), ({"tool_x": 5.0}, "0.6039"), ({"tool_x": 0.0, "tool_z": -22.5}, "2")],
)
def test_a_cylinder_that_leaves_no_room_is_refused(setting, room):
    with pytest.raises(InvalidValue, match="no room for the stroke") as caught:
        FreeBending(**setting)
    assert caught.value.where == "stroke"
    assert caught.value.value == 15.0
    assert f"can go down by {room} at most" in caught.value.cause
    FreeBending(**setting, stroke=0.99 * float(room))


def test_beside_the_cylinder_there_is_room_for_any_stroke():
    FreeBending(tool_x=21.0, stroke=40.0)
    with pytest.raises(InvalidValue, match="no room"):
        FreeBending(tool_x=20.9, stroke=40.0)
