"""Parameters for wanted results: few runs, bounds kept, undetermined parameters refused."""

import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.problem import load
from umform.problem.templates import template_file
from umform.processes.air_bending import AirBending, air_bending

BEND = AirBending(stroke=3.0, layers=1, elements_per_thickness=1.0)
STRIP = uf.mesh.strip(20.0, 1.0, 0.5, (8, 1))


def cantilever(way, E):
    model = uf.Model(STRIP, material=uf.SVK(E=E, nu=0.3))
    model.fix("x0")
    return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-way, steps=3)


def test_two_results_of_a_bend_are_reached_by_two_parameters_in_three_more_runs():
    want = {"angle": uf.Wanted(128.0, 0.02), "largest_force": uf.Wanted(95.0, 0.05)}
    found = uf.compensate(BEND, want, ["stroke", "opening"])
    assert found.reached
    assert len(found.trials) <= 4
    assert [trial.derived for trial in found.trials] == [True] + [False] * (len(found.trials) - 1)
    # the case that is returned has the results
    again = air_bending(found.subject)
    assert again["angle"].value == pytest.approx(128.0, abs=0.02)
    assert again["largest_force"].value == pytest.approx(95.0, abs=0.05)


def test_a_bound_is_kept_and_said(tmp_path):
    found = uf.compensate(BEND, {"angle": uf.Wanted(128.0, 0.02)}, ["stroke"], bounds={"stroke": (2.5, 3.1)})
    assert not found.reached
    assert found.parameters["stroke"].value == pytest.approx(3.1, abs=1e-9)
    assert [file.name for file in found.write(tmp_path)] == ["compensation.csv"]


def test_a_force_of_a_function_is_reached():
    found = uf.compensate(lambda way: cantilever(way, 210e3), {"tip_force": uf.Wanted(-2.0, 1e-6)}, {"way": 0.5})
    assert found.reached
    assert found.results[0].value == pytest.approx(-2.0, abs=1e-6)


def test_more_parameters_than_results_are_refused():
    by = {"way": 0.5, "E": 210e3}
    with pytest.raises(InvalidValue, match="do not determine the parameters"):
        uf.compensate(cantilever, {"tip_force": uf.Wanted(-2.0, 1e-6)}, by)


def test_a_start_outside_of_its_bounds_is_refused():
    with pytest.raises(InvalidValue, match="starts outside of its bounds"):
        uf.compensate(BEND, {"angle": uf.Wanted(128.0, 0.02)}, ["stroke"], bounds={"stroke": (4.0, 5.0)})


def test_a_deck_is_compensated_and_written(tmp_path):
    coarse = {"mesh.cells": [14, 1], "steps.0.to.stroke": 1.0, "steps.0.increments": 10}
    problem = load(template_file("air-bending"), coarse)
    want = {"stroke_force:peak": uf.Wanted(45.0, 0.01)}
    found = uf.compensate(problem, want, ["to.stroke"], bounds={"to.stroke": (0.5, 2.0)})
    assert found.reached
    _, deck = found.write(tmp_path)
    again = load(deck).build().solve()
    assert abs(again["stroke_force"]).max() == pytest.approx(45.0, abs=0.01)
