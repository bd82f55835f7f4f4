"""Derivatives of problems, cases and functions: what they are, and what is refused by name."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import umform as uf
from umform.errors import FileProblem, InvalidValue
from umform.problem import Problem
from umform.processes.air_bending import AirBending
from umform.processes.draw import Cup, draw
from umform.processes.draw.u_bend import NUMISHEET, UBend
from umform.results.forming import BY_PATHS, BY_STRAINS
from umform.results.quantity import Quantity
from umform.spec import Scalar
from umform.studies.derivatives import derive
from umform.studies.derivatives.derivative import Derivative

EXAMPLES = Path(__file__).resolve().parents[4] / "examples" / "umat"
COMPILER = shutil.which("gcc") or shutil.which("cc")


def cantilever(E, thickness):
    """Elastic, with a load of 1e-3 at its end: the force for a small deflection is that of a beam."""
    model = uf.Model(uf.mesh.strip(10.0, 1.0, thickness, (8, 1)), material=uf.SVK(E=E, nu=0.0))
    model.fix("x0")
    return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-1e-3, steps=2)


BEAM = {"E": 210e3, "thickness": 0.2}


@pytest.fixture(scope="module")
def beam():
    return uf.derivatives(cantilever, by=BEAM, of=["tip_force:last"], progress=False)


def test_a_beam(beam):
    """The force goes with E and with the cube of the thickness."""
    assert beam["tip_force:last", "E"].relative == pytest.approx(1.0, rel=1e-7)
    assert beam["tip_force:last", "thickness"].relative == pytest.approx(3.0, rel=2e-3)
    one = beam["tip_force:last", "E"]
    assert (one.switched, one.why) == (0, "")
    column = beam.column("tip_force", "thickness")
    assert column[0] == 0.0
    assert column[-1] == beam["tip_force:last", "thickness"].value
    assert column[1] == pytest.approx(0.5 * column[2], rel=1e-3)
    shape = beam.displacement("E")
    assert shape.shape == (36, 3)
    assert np.abs(shape).max() < 1e-12  # the deflection is given


def test_far_from_the_origin_a_place_has_the_derivative_of_here():
    """A part of a coordinate is no small change there: the sheet would lie in the tool."""

    def pressed(z, away):
        strip = uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)).transformed(lambda X: X + np.array([0.0, 0.0, away]))
        model = uf.Model(strip, material=uf.SVK(E=210e3, nu=0.3))
        model.fix("x0")
        roll = uf.Cylinder((8.0, 0.0, z), "y", 2.0)
        stroke = model.drive(model.contact("upper", roll, penalty=1e3).tool, "z", name="stroke")
        return model, uf.Move(stroke, to=-0.5, steps=5)

    slopes = []
    for away in (0.0, 1000.0):
        build = partial(pressed, away=away)
        found = uf.derivatives(build, {"z": away + 2.1}, ["stroke_force:last"], progress=False)
        assert not found.warnings
        slopes.append(found["stroke_force:last", "z"].value)
    assert slopes[1] == pytest.approx(slopes[0], rel=1e-3)


def test_a_held_response(beam):
    """At the same force a thicker beam has less E: -3 of its percentage."""
    held = uf.derivatives(
        cantilever, by={**BEAM}, of=["tip_force:last"] * 2, hold={"tip_force:last": "E"}, progress=False
    )
    assert [one.path for one in held.parameters] == ["thickness"]
    assert held["tip_force:last", "thickness"].value == 0.0
    assert held["E", "thickness"].relative == pytest.approx(-beam["tip_force:last", "thickness"].relative, rel=1e-4)
    other = uf.derivatives(cantilever, by=BEAM, of=["tip:last"], hold={"tip_force:last": "E"}, progress=False)
    assert other["tip_force:last", "thickness"].value == 0.0  # a held one is a response without being named

    def pull(result):
        return result["tip_force"][-1]

    own = uf.derivatives(cantilever, by=BEAM, of=[pull], hold={"pull": "E"}, progress=False)
    assert own["E", "thickness"].value == pytest.approx(held["E", "thickness"].value, rel=1e-6)
    with pytest.raises(InvalidValue, match="a parameter that follows has no derivative"):
        uf.derivatives(cantilever, by={"E": BEAM["E"]}, hold={"tip_force:last": "E"}, progress=False)
    with pytest.raises(InvalidValue, match="cannot be held"):
        uf.derivatives(cantilever, by=BEAM, of=["tip:last"], hold={"tip:last": "E"}, progress=False)


@pytest.mark.parametrize("of", [["tip_strength"], ["tip_force:mean"]])
def test_unknown_responses_are_refused_before_the_run(of, monkeypatch):
    monkeypatch.setattr(derive, "_run", None)
    with pytest.raises(InvalidValue) as caught:
        uf.derivatives(cantilever, by=BEAM, of=of, progress=False)
    assert of[0].partition(":")[0] in str(caught.value) or "mean" in str(caught.value)
    assert caught.value.where == "of"


# What cannot be varied --------------------------------------------------------------------------------------------


def test_an_elastic_strip_is_flat_again_whatever_its_width():
    def released(width):
        model = uf.Model(uf.mesh.strip(20.0, width, 1.0, (6, 1)), material=uf.SVK(E=206e3, nu=0.3))
        model.fix("x0")
        tip = model.prescribe("x1_lower", "z", name="tip")
        return model, [uf.Move(tip, to=-3.0, steps=6), uf.Release(tip)]

    found = uf.derivatives(released, {"width": 2.0}, "tip:last", progress=False)
    assert found["tip:last", "width"].value == 0.0


@pytest.mark.parametrize("given", [None, 3, cantilever(**{"E": 210e3, "thickness": 0.2})[0]])
def test_what_has_no_parameters_is_refused(given):
    with pytest.raises(InvalidValue, match="a function that takes the numbers"):
        uf.derivatives(given, {"E": 210e3})
    with pytest.raises(InvalidValue, match="returns a model and its steps"):
        uf.derivatives(lambda E: cantilever(E, 0.2)[0], {"E": 210e3})


def test_names_of_derivatives(beam):
    with pytest.raises(InvalidValue, match="a response by a parameter"):
        beam["tip_force:last"]
    with pytest.raises(InvalidValue, match="no such response"):
        beam.plot("nothing")
    assert repr(uf.derivatives(cantilever, by=BEAM, of=[], progress=False)) == "Derivatives()"


def test_a_function_needs_values():
    with pytest.raises(InvalidValue, match="a function needs the values of its parameters"):
        uf.derivatives(cantilever, by=["E"])


def test_values_of_a_case_and_frames_below_one_are_refused():
    case = AirBending(stroke=3.0)
    with pytest.raises(InvalidValue, match="those of a function"):
        uf.derivatives(case, {"die_radius": 2.0})
    for frames in (0, 1.5):
        with pytest.raises(InvalidValue) as caught:
            uf.derivatives(case, "die_radius", frames=frames)
        assert caught.value.where == "frames"


def test_whole_numbers_of_a_function_are_refused_by_name():
    with pytest.raises(InvalidValue, match="it is a whole number") as caught:
        uf.derivatives(cantilever, by={"E": 210000, "thickness": 0.2})
    assert caught.value.where == "E"
    assert "210000.0" in str(caught.value)


def test_a_number_of_elements_is_refused_by_name():
    """One that follows from a size: varied downwards, and refused if both ways change it."""

    def build(size, shift):
        cells = round(2.0 / size + shift)
        model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (cells, 1)), material=uf.SVK(E=1e5, nu=0.0))
        model.fix("x0")
        return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-1e-3, steps=1)

    upwards = 2.0 / 8.5 * (1.0 + 1e-6)  # eight elements; nine for a slightly smaller size
    found = uf.derivatives(build, by={"size": upwards, "shift": 0.0}, of=["tip_force:last"], progress=False)
    assert found.sizes["size"] > 0.0 and found["tip_force:last", "size"].value == 0.0
    assert "size has no effect on this run" in found.warnings

    def jumping(size):
        return build(0.25, 0.0) if size == 1.0 else build(0.2, 0.0)

    with pytest.raises(InvalidValue, match="cannot be varied") as caught:
        uf.derivatives(jumping, by={"size": 1.0})
    assert caught.value.where == "size"


def test_a_bound_is_left_downwards():
    """A value at its largest one is made smaller."""

    def build(nu, E):
        model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (4, 1)), material=uf.SVK(E=E, nu=nu))
        model.fix("x0")
        model.contact("upper", uf.Plane((0, 0, 5.0), (0, 0, -1)), friction=2.0 * nu / 0.3, penalty=1.0, name="far")
        return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-1e-3, steps=1)

    found = uf.derivatives(build, by={"nu": 0.3, "E": 1e5}, of=["tip_force:last"], progress=False)
    assert found.sizes["nu"] < 0.0 < found.sizes["E"]
    assert found["tip_force:last", "nu"].value != 0.0


def test_the_same_model_twice_is_refused():
    kept = cantilever(**BEAM)
    with pytest.raises(InvalidValue, match="returns the same model twice"):
        uf.derivatives(lambda E: kept, by={"E": 1.0})


@pytest.fixture(scope="module")
def problem(strip):
    return Problem.read(strip)


def test_a_problem(problem):
    """The last part of a path will do; the derivative has its unit, and is that of whole runs."""
    found = uf.derivatives(problem, by=["E", "material.nu"], of=["pull_force:last"], progress=False)
    assert [one.path for one in found.parameters] == ["material.E", "material.nu"]
    assert found["pull_force:last", "material.E"].relative == pytest.approx(1.0, rel=1e-6)
    ends = [runs(problem.with_({"material.nu": value})) for value in (0.3003, 0.2997)]
    assert found["pull_force:last", "material.nu"].value == pytest.approx((ends[0] - ends[1]) / 6e-4, rel=1e-4)


def runs(problem):
    made = problem.build()
    return uf.solve(made.model, made.steps, options=uf.NewtonOptions(residual=1e-12))["pull_force"][-1]


@pytest.mark.parametrize(
    ("path", "cause"),
    [
        ("solution.residual", "an error of the solution"),
        ("mesh.cells.0", "whole number"),
        ("steps.0.increments", "whole number"),
        ("material.mu", "did you mean material.nu"),
        ("material.nothing", "no number of this path"),
    ],
)
def test_numbers_of_a_problem_that_cannot_be_varied(problem, path, cause):
    with pytest.raises(InvalidValue) as caught:
        uf.derivatives(problem, by=[path])
    assert cause in str(caught.value)


# Laws of users ----------------------------------------------------------------------------------------------------


def bar(law):
    model = uf.Model(uf.mesh.strip(1.0, 0.5, 0.4, (1, 1)), "EAS3DEAS", material=law)
    for face, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(face, normal=normal)
    pull = model.prescribe("x1", "x", "pull")
    return model, [uf.Move(pull, 0.02, steps=4), uf.Move(pull, -0.01, steps=6)]


def relatives(build, values):
    found = uf.derivatives(build, by=values, of=["pull_force:last", "pull_force:max"], progress=False)
    return np.array([[found[one.name, name].relative for name in values] for one in found.responses])


def test_a_law_of_a_user():
    """Softening with the largest strain so far, a history: the derivative is that of whole runs."""

    def build(stiffness, decay):
        def law(E, state):
            worst = np.maximum(state[:, 0], np.linalg.norm(E, axis=1))
            part = stiffness * np.exp(-decay * worst)
            grows = np.linalg.norm(E, axis=1) > state[:, 0]
            S = part[:, None] * E
            C = part[:, None, None] * np.eye(6)
            size = np.maximum(np.linalg.norm(E, axis=1), 1e-300)
            C = C - np.where(grows, decay * part / size, 0.0)[:, None, None] * E[:, :, None] * E[:, None, :]
            return S, C, worst[:, None]

        return bar(uf.UserLaw(law, initial=(0.0,)))

    values = {"stiffness": 1e4, "decay": 8.0}
    found = uf.derivatives(build, by=values, of=["pull_force:last"], progress=False)
    assert found["pull_force:last", "stiffness"].relative == pytest.approx(1.0, rel=1e-7)
    ends = []
    for sign in (1.0, -1.0):
        model, steps = build(1e4, 8.0 * (1.0 + sign * 1e-4))
        options = uf.NewtonOptions(residual=1e-12)
        ends.append(uf.solve(model, steps, options=options, frames=0)["pull_force"])
    column, wanted = found.column("pull_force", "decay"), (ends[0] - ends[1]) / 1.6e-3
    assert np.abs(column - wanted).max() < 1e-5 * np.abs(wanted).max()


@pytest.mark.skipif(COMPILER is None or not EXAMPLES.is_dir(), reason="no C compiler, or no examples")
def test_a_umat_has_the_derivatives_of_the_metal(tmp_path):
    library = tmp_path / "kinematic.so"
    subprocess.run([COMPILER, "-O1", "-shared", "-fPIC", "-o", library, EXAMPLES / "kinematic.c", "-lm"], check=True)

    def foreign(E, Y, H, C):
        state = {"back_stress": 6, "eqps": 1}
        return bar(uf.Umat(library, state=state, properties=[E, 0.3, Y, H, C], energies=True, directional=False))

    def own(E, Y, H, C):
        back = uf.Chaboche(((C, 0.0),))
        return bar(uf.Metal(E, 0.3, hardening=uf.Linear(Y, H), back_stress=back))

    values = {"E": 210e3, "Y": 200.0, "H": 500.0, "C": 3000.0}
    np.testing.assert_allclose(relatives(foreign, values), relatives(own, values), rtol=1e-5, atol=1e-7)


# Tables and files -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("of", "by", "unit"),
    [
        ("degrees", "mm", "degrees/mm"),
        ("", "mm", "1/mm"),
        ("degrees", "", "degrees per unit of the parameter"),
        ("", "", ""),
    ],
)
def test_a_derivative_has_the_unit_of_its_response_over_that_of_its_parameter(of, by, unit):
    assert Derivative(Quantity("angle", of, value=90.0), Scalar("material.E", 210e3, by), 1e-4).unit == unit


def test_table_files_and_picture(beam, tmp_path):
    assert len(beam.table) == 2
    assert [path.name for path in beam.write(tmp_path)] == [
        "derivatives.csv",
        "derivatives-history.csv",
        "derivatives.png",
    ]
    lines = (tmp_path / "derivatives.csv").read_text().splitlines()
    assert len(lines) == 3 and "E" in lines[1]
    history = (tmp_path / "derivatives-history.csv").read_text().splitlines()
    assert "d tip_force / d E" in history[0] and len(history) == 4
    beam.plot("tip_force:last", tmp_path / "bars.png")
    assert (tmp_path / "bars.png").stat().st_size > 1000
    with pytest.raises(InvalidValue, match="no such response"):
        beam["tip_force", "E"]
    with pytest.raises(InvalidValue, match="no such parameter"):
        beam.column("tip_force", "nu")


def test_a_parameter_that_is_zero_has_its_change_for_1_more(tmp_path):
    """One per cent of nothing would be none; the column says which of both it is."""

    def pulled(E, start):
        return cantilever(E, 0.2 * (1.0 + start))

    found = uf.derivatives(pulled, {"E": 210e3, "start": 0.0}, ["tip_force:last"], progress=False)
    one = found["tip_force:last", "start"]
    assert one.relative is None and one.change == one.value
    assert found.table[1][3] == f"{one.value:+.3g}"
    assert found.annex.notes == ["changes for 1 more in place of 1 % where the value is zero: start"]
    (axes,) = found.plot("tip_force:last").axes
    assert [label.get_text() for label in axes.get_yticklabels()] == ["E", "start, 1 more"]
    assert axes.patches[1].get_width() == one.value


def test_shadows_of_a_bend_are_near_at_once_and_in_balance():
    """Their increments begin with those of the reference, and need two to three corrections."""
    case = AirBending(stroke=3.0, layers=1, elements_per_thickness=1.0)
    found = uf.derivatives(case, ["thickness", "die_radius"], of=["angle"], progress=False)
    assert found.warnings == []
    increments = len(found.run) - 1
    for shadow in found.runs.shadows.values():
        assert increments < shadow.timing.attempts.evaluations < 4 * increments
        assert shadow.balance().force_imbalance.max() < 1e-10
        assert shadow["die_penetration"].max() < 0.01  # what a sheet of 2 mm allows
    assert found.runs.reference.balance().force_imbalance.max() < 1e-12


@pytest.mark.parametrize("further", [0.0, -1e-3, 1e-4])
def test_a_bottomed_sheet_has_derivatives_however_its_tools_let_it_go(further):
    """By one increment to no contact at all, where the tangent is singular, or by small ones to no force."""
    case = AirBending(bottoming=True, layers=1, elements_per_thickness=1.0, increment=0.05)
    case = replace(case, stroke=6.87925646 + further)
    found = uf.derivatives(case, ["stroke", "thickness"], ["force", "angle"], progress=False)
    assert not found.warnings
    assert found["force", "stroke"].value == pytest.approx(3800.0, rel=0.02)
    assert found["angle", "stroke"].value == pytest.approx(-16.33, rel=0.02)


def test_the_picture_shows_the_main_result():
    """The angle of a bend, and its springback where the angle is held; not the force, which depends more."""
    case = AirBending(stroke=3.0, layers=1, elements_per_thickness=1.0, increment=0.05)
    found = uf.derivatives(case, ["stroke", "strength"], progress=False)
    assert found._main == "angle"
    assert found.holding({"angle": "stroke"})._main == "springback"


def test_a_stopped_run_goes_on_to_the_same_bits(tmp_path):
    def stop(name, fraction, detail):
        seen.append(name)
        if len(seen) == 2:
            raise KeyboardInterrupt

    by, seen = {"E": 210e3, "thickness": 0.2}, []
    whole = uf.derivatives(cantilever, by, ["tip_force"], progress=False)
    with pytest.raises(KeyboardInterrupt):
        uf.derivatives(cantilever, by, ["tip_force"], progress=stop, checkpoint=tmp_path / "run.h5")
    for _ in range(2):  # in the middle, and at the end
        again = uf.derivatives(cantilever, by, ["tip_force"], progress=False, checkpoint=tmp_path / "run.h5")
        np.testing.assert_array_equal(again.values, whole.values)
    with pytest.raises(FileProblem):
        uf.derivatives(cantilever, {**by, "E": 211e3}, ["tip_force"], progress=False, checkpoint=tmp_path / "run.h5")


def test_a_flange_that_lies_flat_between_planes():
    """Its contact is settled element by element: the reference takes as many corrections as points come and go."""
    steel = uf.sheet_metals.get("NUMISHEET93 mild steel").law
    case = UBend(**NUMISHEET | UBend.meshes["coarse"] | {"material": steel, "stroke": 14.0})
    found = uf.derivatives(case, ["thickness"], ["stroke_force:last"], progress=False)
    (one,) = found
    assert one.why == ""
    assert one.residual < 1e-9
    assert found.stages["run"].missing == ""


def test_the_path_dependent_limit_of_a_draw_is_that_of_its_own_run():
    """Strain paths go through the states that a run keeps: with their ends only they were straight."""
    sizes = {"thickness": 1.0, "blank_radius": 40.0, "punch_radius": 25.0, "punch_edge": 5.0, "die_edge": 10.0}
    press = {"holder_force": 40e3, "friction": 0.09, "stroke": 15.0}
    case = Cup(material=uf.sheet_metals.get("DC04").law, **sizes, **press, turn=30.0, around=4)
    found = uf.derivatives(case, ["friction"], [BY_PATHS, BY_STRAINS], progress=False)
    values = {one.name: one.value for one in found.responses}
    drawn = draw(case, progress=False)
    assert values[BY_PATHS] == pytest.approx(drawn[BY_PATHS].value, rel=1e-6)
    assert values[BY_PATHS] > 1.2 * values[BY_STRAINS]


@pytest.mark.parametrize("value", ["steel", True, None, [1.0]])
def test_values_that_are_no_numbers_have_no_derivative(value):
    with pytest.raises(InvalidValue, match="it is no number"):
        uf.derivatives(lambda E: cantilever(E, 0.2), {"E": value}, ["tip_force"], progress=False)


def test_functions_of_the_user_are_named_where_they_fail():
    def work(result):
        return {}["lost"]

    with pytest.raises(TypeError) as caught:
        uf.derivatives(cantilever, {**BEAM, "width": 1.0}, ["tip_force"], progress=False)
    assert caught.value.__notes__[0].endswith("called as cantilever(E=210000.0, thickness=0.2, width=1.0)")
    with pytest.raises(KeyError) as lost:
        uf.derivatives(cantilever, BEAM, [work], progress=False)
    assert lost.value.__notes__[0] == "in the function work, called with the result of a run"
    for wrong in (lambda result: None, lambda result: result["tip_force"]):
        with pytest.raises(InvalidValue, match="returns a number or a Quantity"):
            uf.derivatives(cantilever, BEAM, [wrong], progress=False)


def test_a_tool_that_closes_on_blocks_as_high_as_the_sheet():
    """It touches without a force there, which has no slope; it stands where the blocks are."""

    def closed(gap):
        model = uf.Model(uf.mesh.strip(20.0, 1.0, 1.0, (8, 1)).moved((0.0, 0.0, 0.5)), material=uf.SVK(210e3, 0.3))
        model.fix("x0")
        die = model.tool("die", uf.Plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
        holder = model.tool("holder", uf.Plane((0.0, 0.0, 1.5), (0.0, 0.0, -1.0)))
        model.contact("lower", die, penalty=2e3)
        model.contact("upper", holder, penalty=2e3)
        hold = model.press(holder, "z", name="hold")
        model.keep_gap(hold, to=die, gap=gap)
        return model, uf.Close(hold, force=-40.0)

    found = uf.derivatives(closed, by={"gap": 1.0}, of=["hold_way", "hold_stop"], progress=False)
    assert found["hold_way", "gap"].value == pytest.approx(1.0, rel=1e-9)
    assert found["hold_stop", "gap"].switched  # a lower block would leave force to the sheet
