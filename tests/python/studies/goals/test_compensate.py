"""Parameters for wanted results: few runs, bounds kept, undetermined parameters refused."""

import sys

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.problem import DeckError, load
from umform.problem.templates import template_file
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.bend_sequence import Bend, BendSequence
from umform_book.derivatives.chains import HEM, PART

BEND = AirBending(stroke=3.0, layers=1, elements_per_thickness=1.0)
STRIP = uf.mesh.strip(20.0, 1.0, 0.5, (8, 1))


def cantilever(way, E):
    model = uf.Model(STRIP, material=uf.SVK(E=E, nu=0.3))
    model.fix("x0")
    return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-way, steps=3)


@pytest.fixture(scope="module")
def bend():
    want = {"angle": uf.Wanted(128.0, 0.02), "largest_force": uf.Wanted(95.0, 0.05)}
    return uf.compensate(BEND, want, ["stroke", "opening"])


def test_two_results_of_a_bend_are_reached_by_two_parameters_in_three_more_runs(bend):
    found = bend
    assert found.reached
    assert not found.warnings
    assert len(found.trials) <= 4
    assert [trial.derived for trial in found.trials] == [True] + [False] * (len(found.trials) - 1)
    # the case that is returned has the results
    again = air_bending(found.subject)
    assert again["angle"].value == pytest.approx(128.0, abs=0.02)
    assert again["largest_force"].value == pytest.approx(95.0, abs=0.05)


def test_the_compensated_tools_are_written_and_read_again(bend, tmp_path):
    files = {file.name for file in bend.write(tmp_path)}
    assert files >= {"compensation.csv", "compensated.dxf", "compensation.png", "compensation.html"}
    case = bend.subject
    die = uf.VDie(case.opening, case.die_angle, case.die_radius)
    again = uf.Extruded(uf.Profile.from_dxf(tmp_path / "compensated.dxf", "die"))
    x = np.random.default_rng(3).uniform(-12.0, 12.0, (200, 3))
    np.testing.assert_allclose(again.gap(x)[0], die.gap(x)[0], atol=1e-6)
    page = (tmp_path / "compensation.html").read_text()
    assert "all results are reached" in page
    assert "128 ± 0.02" in page
    assert "out of the compensated tools" in page


def test_shapes_are_those_in_the_tools_and_out_of_them(bend):
    for trial in (bend.trials[0], bend.trials[bend.best]):
        formed, sprung = (float(np.ptp(line[:, 1])) for line in (trial.shapes.formed, trial.shapes.sprung))
        assert sprung < formed  # it springs back
    assert np.ptp(bend.trials[bend.best].shapes.sprung[:, 1]) != np.ptp(bend.trials[0].shapes.sprung[:, 1])


def test_without_the_extra_the_tools_are_left_out_with_one_message(bend, tmp_path, monkeypatch, caplog):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    files = {file.name for file in bend.write(tmp_path)}
    assert not files & {"compensated.dxf", "compensated.step"}
    assert [one.getMessage() for one in caplog.records] == [
        'compensated.dxf and compensated.step not written: pip install "umform[cad]"'
    ]


def test_a_bound_is_kept_and_said(tmp_path):
    found = uf.compensate(BEND, {"angle": uf.Wanted(128.0, 0.02)}, ["stroke"], bounds={"stroke": (2.5, 3.1)})
    assert not found.reached
    assert found.parameters["stroke"].value == pytest.approx(3.1, abs=1e-9)
    assert found.warnings == [
        "the wanted results are not reached in 2 runs: wider bounds, another start or other parameters"
    ]
    found.write(tmp_path)
    assert "not all results are reached" in (tmp_path / "compensation.html").read_text()


def test_a_force_of_a_function_is_reached():
    found = uf.compensate(lambda way: cantilever(way, 210e3), {"tip_force": uf.Wanted(-2.0, 1e-6)}, {"way": 0.5})
    assert found.reached
    assert found.results[0].value == pytest.approx(-2.0, abs=1e-6)


def wavy(way):
    """Its force is that of a cantilever, with waves that turn the derivative around at the start."""
    return cantilever(way, 210e3 * (1.0 + 0.05 * np.sin(way / 0.01)))


def test_secants_take_the_place_of_derivatives_of_a_wave():
    start = 0.01 * np.pi * 17  # the slope of the wave is -5 times that of the mean
    found = uf.compensate(wavy, {"tip_force": uf.Wanted(-2.5, 0.02)}, {"way": start}, most=16)
    assert found.reached
    assert [trial.derived for trial in found.trials] == [True] + [False] * (len(found.trials) - 1)
    assert "wavy" in found.warnings[0]


def test_an_unknown_derivative_is_a_secant_of_one_run_more(monkeypatch):
    module = sys.modules["umform.studies.goals.compensate"]

    def unknown(*given, **more):
        found = derivatives(*given, **more)
        found.values[:] = np.nan
        return found

    derivatives = module.derivatives
    monkeypatch.setattr(module, "derivatives", unknown)
    found = uf.compensate(lambda way: cantilever(way, 210e3), {"tip_force": uf.Wanted(-2.0, 1e-6)}, {"way": 0.5})
    assert found.reached
    assert found.trials[1].parameters[0] == pytest.approx(0.5 * 1.09)


@pytest.mark.parametrize("refused", [lambda error: error, lambda error: DeckError([error])])
def test_a_search_that_ends_at_a_run_that_fails_keeps_its_runs(refused):
    def short(way):
        if way > 1.0:
            raise refused(InvalidValue("the way ends in a stop", where="way"))
        return cantilever(way, 210e3)

    found = uf.compensate(short, {"tip_force": uf.Wanted(-4.0, 1e-3)}, {"way": 0.8})
    assert not found.reached and found.parameters["way"].value <= 1.0
    assert found.warnings[0].startswith(f"the wanted results are not reached in {len(found.trials)} runs")
    assert "the next run failed: the way ends in a stop" in found.warnings[1]


def test_a_search_that_is_interrupted_tells_its_best_run():
    def stopped(way):
        if way > 0.85:
            raise KeyboardInterrupt
        return cantilever(way, 210e3)

    with pytest.raises(KeyboardInterrupt) as stop:
        uf.compensate(stopped, {"tip_force": uf.Wanted(-4.0, 1e-3)}, {"way": 0.8})
    [note] = stop.value.__notes__
    assert note.startswith("  the best of 1 runs so far: way = 0.8, tip_force = -")


def test_more_parameters_than_results_are_refused():
    by = {"way": 0.5, "E": 210e3}
    with pytest.raises(InvalidValue, match="more parameters follow than results are wanted"):
        uf.compensate(cantilever, {"tip_force": uf.Wanted(-2.0, 1e-6)}, by)


@pytest.mark.parametrize(
    ("by", "more", "where"),
    [
        ({"stroke": (2.0, 3.5)}, {}, "by"),
        ("stroke", {"bounds": {"stroke": 5.0}}, "bounds"),
        ("stroke", {"bounds": {"stroke": (None, 3.2)}}, "bounds"),
        ("stroke", {"bounds": {"opening": (10.0, 20.0)}}, "bounds"),
        ("stroke", {"most": 1.5}, "most"),
    ],
)
def test_what_is_no_goal_is_refused_before_a_run(by, more, where):
    with pytest.raises(InvalidValue) as refused:
        uf.compensate(BEND, {"angle": uf.Wanted(128.0, 0.02)}, by, **more)
    assert refused.value.where == where


@pytest.mark.parametrize("given", [("a", 1.0), (1.0, "a"), (1.0, 0.0), (None, 1.0), (1e300, 1.0), (1.0, 1e-300)])
def test_a_wanted_result_is_two_numbers(given):
    with pytest.raises(InvalidValue, match="a wanted result has"):
        uf.Wanted(*given)


def test_the_angles_of_a_bracket_are_reached_by_its_strokes_in_three_more_runs():
    sheet = AirBending(elements_per_thickness=1, layers=1, increment=0.0125)
    bends = (Bend(25.0, stroke=3.0), Bend(55.0, stroke=3.0, direction="down"))
    want = {f"bend {number}: final_angle": uf.Wanted(angle, 0.05) for number, angle in ((1, 125.0), (2, 130.0))}
    found = uf.compensate(BendSequence(80.0, bends, sheet), want, ["bends.0.stroke", "bends.1.stroke"])
    assert found.reached
    assert len(found.trials) <= 4
    assert not any(trial.derived for trial in found.trials)
    assert found.trials[found.best].results == pytest.approx((125.0, 130.0), abs=0.05)
    assert found.trials[0].shapes.formed is None


def test_a_flange_of_a_bracket_is_reached_by_its_bend_line(tmp_path):
    """Other results than angles, and other parameters than strokes, have derivatives."""
    found = uf.compensate(PART, {"flange 2": uf.Wanted(25.5, 1e-3)}, ["bends.1.position"])
    assert found.reached
    assert [trial.derived for trial in found.trials] == [True, False]
    # tools of several operations stand in no common place
    assert {file.name for file in found.write(tmp_path)} == {"compensation.csv", "compensation.html"}


@pytest.mark.long
def test_a_height_of_a_hem_is_reached_by_its_insert():
    found = uf.compensate(HEM, {"height": uf.Wanted(3.2, 0.01)}, ["gap"])
    assert found.reached
    assert len(found.trials) <= 3


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"want": {}}, "want"),
        ({"want": {"angle": (128.0, 0.02)}}, "want"),
        ({"want": {"angel": uf.Wanted(128.0, 0.02)}}, "want"),
        ({"by": []}, "by"),
        ({"by": ["stroke", "stroke"]}, "by"),
        ({"by": ["stroke", "punch_radius"]}, "by"),
        ({"bounds": {"stroke": (5.0, 2.0)}}, "by"),
        ({"most": 0}, "most"),
    ],
)
def test_what_cannot_be_wanted_is_refused_by_name(change, where):
    given = {"want": {"angle": uf.Wanted(128.0, 0.02)}, "by": ["stroke"]} | change
    with pytest.raises(InvalidValue) as refused:
        uf.compensate(BEND, **given)
    assert refused.value.where == where


def test_a_part_that_does_not_respond_is_refused(monkeypatch):
    search = sys.modules["umform.studies.goals.compensate"]._Search
    monkeypatch.setattr(search, "_plain", lambda self, x: np.array(self.trials[0].results))
    with pytest.raises(InvalidValue, match="changes no wanted result"):
        uf.compensate(BEND, {"angle": uf.Wanted(128.0, 0.02)}, ["stroke"])


def test_a_run_with_all_results_within_their_tolerances_ends_the_search(monkeypatch):
    """Although the sum of squares was smaller before, when one of them was not."""
    search = sys.modules["umform.studies.goals.compensate"]._Search
    derived = search._derived

    def first(self, x):
        derived(self, x)
        self.trials.clear()
        return self._keep(x, [1.05, 0.0], None, None, derived=True), np.array([[1.0], [3.0]])

    monkeypatch.setattr(search, "_derived", first)
    monkeypatch.setattr(search, "_plain", lambda self, x: self._keep(x, [0.9, 0.9], None, None))
    want = {"tip": uf.Wanted(0.0, 1.0), "tip_force": uf.Wanted(0.0, 1.0)}
    found = uf.compensate(lambda way: cantilever(way, 210e3), want, {"way": 0.5})
    assert found.reached and len(found.trials) == 2


def test_a_start_outside_of_its_bounds_is_refused():
    with pytest.raises(InvalidValue, match="starts outside of its bounds"):
        uf.compensate(BEND, {"angle": uf.Wanted(128.0, 0.02)}, ["stroke"], bounds={"stroke": (4.0, 5.0)})


def test_a_bound_whose_square_overflows_is_none():
    bounds = {"E": (1e-300, 1e300)}
    found = uf.compensate(
        lambda E: cantilever(0.5, E), {"tip_force": uf.Wanted(-2.0, 1e-6)}, {"E": 210e3}, bounds=bounds
    )
    assert found.reached


def test_a_deck_is_compensated_and_written(tmp_path):
    coarse = {"mesh.cells": [14, 1], "steps.0.to.stroke": 1.0, "steps.0.increments": 10}
    problem = load(template_file("air-bending"), coarse)
    want = {"stroke_force:peak": uf.Wanted(45.0, 0.01)}
    found = uf.compensate(problem, want, ["to.stroke"], bounds={"to.stroke": (0.5, 2.0)})
    assert found.reached
    found.write(tmp_path)
    deck = tmp_path / "compensated.toml"
    assert "looked for beside it" in deck.read_text().splitlines()[0]
    again = load(deck).build().solve()
    assert abs(again["stroke_force"]).max() == pytest.approx(45.0, abs=0.01)
