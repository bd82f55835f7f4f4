"""Numbers of a problem from measurements of its run."""

import csv
import json
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue, UmformError
from umform.problem import load
from umform.processes.air_bending import AirBending
from umform.processes.problems import outcome_of, problem_of

TRUTH = {"yield_stress": 200.0, "modulus": 2000.0}


def bar(yield_stress, modulus, young=200e3, idle=1.0, factor=1.0):
    """One element in tension, which takes the constants of a linear hardening."""
    metal = uf.J2(young, 0.3, hardening=uf.Linear(factor * yield_stress, modulus))
    model = uf.Model(uf.mesh.strip(1.0, 1.0, 1.0, (1, 1)), "BEND8", material=metal)
    model.symmetry("x0", "x"), model.symmetry("y0", "y")
    model.hinge("x0", "z")
    return model, uf.Move(model.prescribe("x1", "x", name="pull"), to=0.01, steps=5)


def in_tension(strains, yield_stress, modulus, young=200e3):
    """Forces of the bar: of a small strain on the unit area, with the stretch of a large one."""
    run = uf.derivatives(bar, {"yield_stress": yield_stress, "modulus": modulus, "young": young}, [])
    return np.interp(strains, run.runs.reference["pull"], run.runs.reference["pull_force"])


@pytest.fixture(scope="module")
def tension():
    x = np.linspace(0.0015, 0.0095, 12)
    return x, in_tension(x, **TRUTH)


def curve(tension, noise=0.0, seed=0, **rest):
    x, y = tension
    scatter = np.random.default_rng(seed).normal(0.0, noise, len(y)) if noise else 0.0
    return uf.MeasuredCurve("pull", "pull_force", (x, y + scatter), **rest)


BOUNDS = {"yield_stress": (100.0, 400.0), "modulus": (500.0, 8000.0)}


def test_exact_measurements_give_the_constants(tension):
    found = uf.identify(bar, BOUNDS, [curve(tension, deviation=1.0)])
    assert dict(found.values) == pytest.approx(TRUTH, rel=1e-5)
    assert found.fit.misfit < 1e-3
    assert found.runs <= 6
    assert not found.unfinished
    assert found.refused == 0
    assert found.subject == found.values


def test_a_number_near_zero_is_determined_beside_its_bounds(tension):
    def offset(more):
        return bar(200.0 + more, 2000.0)

    for sought, answer in (((-50.0, 50.0), "yes"), (uf.Sought(start=1.0), "no")):
        found = uf.identify(offset, {"more": sought}, [curve(tension, deviation=1.0)])
        assert abs(found.values["more"]) < 0.01 < found.deviations["more"] < 1.0
        assert found.table[1][-1] == answer


def test_constants_lie_within_two_standard_errors_as_often_as_they_should(tension):
    inside, distances = 0, []
    for seed in range(30):
        start = {name: uf.Sought(*BOUNDS[name], start=1.03 * value) for name, value in TRUTH.items()}
        found = uf.identify(bar, start, [curve(tension, 2.0, seed, deviation=2.0)])
        off = [(found.values[name] - value) / found.deviations[name] for name, value in TRUTH.items()]
        inside += sum(abs(one) < 2.0 for one in off)
        distances += off
    # 57.3 of 60 of a normal distribution, with a standard deviation of 1.6; their spread is 1 +- .09
    assert 53 <= inside <= 60
    assert 0.75 < np.std(distances) < 1.25
    assert abs(np.mean(distances)) < 0.3


def test_errors_follow_from_the_scatter_if_no_deviations_are_given(tension):
    given = uf.identify(bar, BOUNDS, [curve(tension, 2.0, 3, deviation=2.0)])
    scattered = uf.identify(bar, BOUNDS, [curve(tension, 2.0, 3)])
    assert dict(scattered.values) == pytest.approx(given.values, rel=1e-4)
    ratio = scattered.deviations["modulus"] / given.deviations["modulus"]
    assert ratio == pytest.approx(given.fit.misfit * np.sqrt(12 / 10), rel=1e-3)
    assert "per cent" in str(scattered)


def test_errors_are_unknown_without_deviations_and_more_measurements_than_numbers(tension):
    number = [uf.MeasuredNumber("pull_force:last", tension[1][-1])]
    found = uf.identify(partial(bar, modulus=2000.0), {"yield_stress": (100.0, 400.0)}, number)
    assert np.isinf(found.deviations["yield_stress"])
    assert "the standard errors are unknown" in str(found)
    assert "more than half" not in str(found)
    assert found.table[1][-1] == "–"


def test_a_curve_and_a_number_of_another_bar(tension):
    twice = in_tension([0.01], 400.0, 2000.0)[0]
    data = [
        uf.MeasuredNumber("pull_force:last", twice, 1.0, at={"factor": 2.0}),
        curve(tension, deviation=1.0),
    ]
    found = uf.identify(bar, BOUNDS, data)
    assert dict(found.values) == pytest.approx(TRUTH, rel=1e-4)
    assert found.runs % 2 == 0
    assert found.residuals["measurement"].count("pull_force") == 12


def test_what_was_known_before_determines_what_is_not_measured(tension):
    number = [uf.MeasuredNumber("pull_force:last", tension[1][-1], 1.0)]
    with pytest.raises(UmformError, match="fewer measurements than numbers"):
        uf.identify(bar, BOUNDS, number)
    sought = {"yield_stress": (100.0, 400.0), "modulus": uf.Sought(start=1500.0, deviation=100.0)}
    found = uf.identify(bar, sought, number)
    assert found.values["modulus"] == pytest.approx(1500.0, abs=1.0)
    assert found.deviations["modulus"] == pytest.approx(100.0, rel=0.01)
    assert "modulus is hardly measured: standard deviation 1e+02, known before 1e+02" in str(found)


def test_a_number_at_its_bound_is_not_determined(tension):
    sought = {"yield_stress": (100.0, 400.0), "modulus": (500.0, 1500.0)}
    found = uf.identify(bar, sought, [curve(tension, deviation=1.0)])
    assert found.values["modulus"] == pytest.approx(1500.0)
    assert np.isinf(found.deviations["modulus"])
    assert "do not determine modulus" in str(found)


def test_values_that_a_law_refuses_shorten_the_step(tension):
    def other(logarithm):
        if logarithm > 6.0:
            raise InvalidValue("too strong", value=logarithm)
        return bar(np.exp(logarithm), 2000.0)

    sought = {"logarithm": uf.Sought(3.0, 12.0, start=3.5)}  # the first step leads far beyond
    found = uf.identify(other, sought, [curve(tension, deviation=1.0)])
    assert found.values["logarithm"] == pytest.approx(np.log(200.0), rel=1e-4)
    assert found.refused > 0
    assert "without a run" in str(found)


def test_a_search_that_has_not_ended_says_why(tension):
    sought = {"yield_stress": (100.0, 400.0), "modulus": (500.0, 8000.0)}
    short = uf.identify(bar, sought, [curve(tension, deviation=1.0)], most=2)
    assert "more trials are needed" in str(short)

    built = []

    def only(yield_stress):
        built.append(yield_stress)
        if len(built) > 3:  # the run, its reference and its shadow
            raise InvalidValue("only this one", value=yield_stress)
        return bar(yield_stress, 2000.0)

    with pytest.raises(UmformError, match="only this one"):
        uf.identify(only, {"yield_stress": (100.0, 400.0)}, [curve(tension, deviation=1.0)])


@pytest.mark.parametrize(
    ("find", "said", "names"),
    [
        ({"yield_stress": (100.0, 400.0), "idle": (0.0, 2.0)}, "do not depend on this number", "idle"),
        (
            {"yield_stress": (100.0, 400.0), "factor": (0.5, 2.0), "modulus": (500.0, 8000.0)},
            "only a combination",
            "yield_stress, factor",
        ),
        ({"yield_stress": (400.0, 100.0)}, "bounds or a first value", "the lower bound is not below"),
        ({"yield_stress": uf.Sought(100.0, 400.0, start=50.0)}, "bounds or a first value", "beyond the bounds"),
        ({"yield_stress": uf.Sought()}, "bounds or a first value", "no first value"),
        ({"yield_stress": "200"}, "bounds or a first value", "neither bounds"),
        ({}, "nothing to find", ""),
    ],
)
def test_what_cannot_be_found_is_refused_by_name(tension, find, said, names):
    def build(yield_stress, modulus=2000.0, factor=1.0, idle=1.0):
        return bar(yield_stress, modulus, factor=factor)

    with pytest.raises(UmformError, match=said) as refused:
        uf.identify(build, find, [curve(tension, deviation=1.0)])
    assert names in str(refused.value)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"x": "pul"}, "no such column"),
        ({"step": 3}, "no such step"),
        ({"points": ([0.0, 0.02], [1.0, 2.0])}, "goes beyond the run"),
        ({"points": ([0.0, 0.01, 0.002], [1.0, 2.0, 1.0])}, "turns more often"),
        ({"points": ([0.01, 0.002], [2.0, 1.0])}, "begins the other way"),
    ],
)
def test_a_curve_that_the_run_does_not_have_is_refused(tension, change, said):
    with pytest.raises(UmformError, match=said):
        uf.identify(bar, BOUNDS, [replace(curve(tension, deviation=1.0), **change)])


def test_a_curve_that_goes_back_farther_than_the_run_has_the_way_back_in_its_message():
    def build(strength):
        metal = uf.J2(200e3, 0.3, hardening=uf.Linear(strength, 2000.0))
        model = uf.Model(uf.mesh.strip(1.0, 1.0, 1.0, (1, 1)), "BEND8", material=metal)
        model.symmetry("x0", "x"), model.symmetry("y0", "y"), model.hinge("x0", "z")
        pull = model.prescribe("x1", "x", name="pull")
        return model, [uf.Move(pull, to=0.01, steps=4), uf.Move(pull, to=0.009, steps=2)]

    back = uf.MeasuredCurve("pull", "pull_force", ([0.005, 0.01, 0.007], [200.0, 210.0, 50.0]), 1.0)
    with pytest.raises(UmformError, match=r"pull 0\.007; the run goes there from 0\.01 to 0\.009"):
        uf.identify(build, {"strength": (100.0, 300.0)}, [back])


def test_a_number_under_two_names_is_refused():
    find = {"strength": (400.0, 700.0), "material.hardening.strength": (400.0, 700.0)}
    with pytest.raises(UmformError, match="looked for twice"):
        uf.identify(AirBending(stroke=4.0), find, [uf.MeasuredNumber("angle", 120.0, 0.1)])


def test_measurements_are_checked(tension):
    with pytest.raises(UmformError, match="its abscissae and its ordinates"):
        uf.MeasuredCurve("pull", "pull_force", "curve.csv")
    with pytest.raises(UmformError, match="some measurements have a standard deviation"):
        uf.identify(bar, BOUNDS, [curve(tension), uf.MeasuredNumber("pull_force:last", 200.0, 1.0)])
    known = BOUNDS | {"modulus": uf.Sought(start=1500.0, deviation=100.0)}
    with pytest.raises(UmformError, match="some measurements have a standard deviation"):
        uf.identify(bar, known, [curve(tension)])
    with pytest.raises(UmformError, match="a curve is two or more pairs"):
        uf.MeasuredCurve("pull", "pull_force", ([1.0, 2.0], [1.0]))
    with pytest.raises(UmformError, match="one for each ordinate"):
        uf.MeasuredCurve("pull", "pull_force", ([1.0, 2.0], [1.0, 3.0]), [1.0, 1.0, 1.0])
    with pytest.raises(UmformError, match="positive standard deviation"):
        uf.MeasuredCurve("pull", "pull_force", ([1.0, 2.0], [1.0, "b"]))
    huge = ((1e300, 1.0), (1.0, 1e-300), (1e50, 1e-50))
    for value, deviation in ((np.nan, 1.0), (1.0, 0.0), (0.0, None), ("a", None), (1.0, True), *huge):
        with pytest.raises(UmformError, match="positive standard deviation"):
            uf.MeasuredNumber("force", value, deviation)


def test_a_file_has_columns_of_the_history_and_perhaps_deviations(tmp_path):
    file = tmp_path / "curve.csv"
    file.write_text("pull,Pull Force,deviation\n0.001,200.0,1.5\n0.002,300.0,2.5\n")
    read = uf.MeasuredCurve.read(file, "pull", "pull_force")
    assert read.numbers[1].tolist() == [1.5, 2.5]
    assert uf.MeasuredCurve.read(file, "pull", "pull_force", 4.0).numbers[1].tolist() == [4.0, 4.0]
    with pytest.raises(UmformError, match="the column force is missing"):
        uf.MeasuredCurve.read(file, "pull", "force")
    file.write_text("pull,force\n0.001,200.0\n")
    with pytest.raises(UmformError, match="two or more pairs") as refused:
        uf.MeasuredCurve.read(file, "pull", "force")
    assert str(file) in str(refused.value)


def measured(case):
    """Quantities of a run of a bend."""
    problem = problem_of(case).build()
    how = {"solver": problem.solver, "options": problem.options, "frames": 1, "progress": False}
    return {one.name: one.value for one in outcome_of(case, uf.solve(problem.model, problem.steps, **how)).quantities}


def of_metal(case, strength, exponent):
    law = case.material
    curve = replace(law.hardening, strength=strength, exponent=exponent)
    return replace(case, material=replace(law, hardening=curve))


@pytest.fixture(scope="module")
def bend():
    """A bend of the metal of the card, and the same of the coil: 12 % stronger, exponent 5 % smaller."""
    card = AirBending(stroke=6.1, elements_per_thickness=1.0, layers=1, increment=0.025)
    return card, of_metal(card, 1.12 * 520.0, 0.95 * 0.22)


def test_one_measured_bend_corrects_the_card_for_other_strokes_and_tools(bend, tmp_path):
    card, coil = bend
    truth = measured(coil)
    data = [  # each a standard deviation off
        uf.MeasuredNumber("angle", truth["angle"] + 0.1, 0.1),
        uf.MeasuredNumber("force", truth["force"] * 0.99, 0.01 * truth["force"]),
    ]
    sought = {"strength": (400.0, 800.0), "hardening.exponent": (0.1, 0.4)}
    found = uf.identify(card, sought, data)
    assert found.values["material.hardening.strength"] == pytest.approx(1.12 * 520.0, rel=0.03)
    assert found.runs <= 6
    corrected, before = [], []
    for other in ({"stroke": 4.0}, {"stroke": 5.0}, {"punch_radius": 3.0}, {"opening": 24.0, "stroke": 8.0}):
        angles = [measured(replace(case, **other))["angle"] for case in (coil, found.subject, card)]
        corrected.append(abs(angles[1] - angles[0]))
        before.append(abs(angles[2] - angles[0]))
    assert max(corrected) < 0.3
    assert min(before) > 0.3
    found.write(tmp_path)
    deck = load(tmp_path / "deck.toml")
    numbers = {one.path: one.value for one in deck.paths()}
    assert numbers["material.hardening.strength"] == pytest.approx(
        found.values["material.hardening.strength"], rel=1e-6
    )


def test_files(tension, tmp_path):
    found = uf.identify(bar, BOUNDS, [curve(tension, 2.0, 1), uf.MeasuredNumber("pull_force:last", 219.0)])
    files = {file.name for file in found.write(tmp_path)}
    assert files == {"identified.csv", "residuals.csv", "identified.json", "identified.png", "identified.svg"}
    with (tmp_path / "identified.csv").open() as text:
        rows = {row["number"]: row for row in csv.DictReader(text)}
    assert float(rows["modulus"]["value"]) == found.values["modulus"]
    with (tmp_path / "residuals.csv").open() as text:
        assert [row["measurement"] for row in csv.DictReader(text)] == ["pull_force"] * 12 + ["pull_force:last"]
    record = json.loads((tmp_path / "identified.json").read_text())
    assert record["runs"] == found.runs
    assert record["numbers"]["yield_stress"]["standard_error"] == found.deviations["yield_stress"]
