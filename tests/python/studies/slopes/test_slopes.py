"""Slopes of results from whole runs."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue, SolveError
from umform.processes.air_bending import AirBending, air_bending
from umform.results.outcome import Outcome
from umform.results.quantity import Quantity
from umform.spec.types import Positive
from umform.studies.slopes import slopes
from umform.studies.slopes.study import planned_runs


@dataclass(frozen=True)
class Wavy:
    """A case whose results are known."""

    length: float = 10.0
    strength: Positive = 2.0
    friction: float = 0.0
    cells: int = 3


@dataclass(frozen=True)
class Known(Outcome):
    """Its outcome: a straight line, a line with steps, a number that is missing in short cases."""

    case: Wavy
    title = "known"
    stages = {}
    warnings = ()

    @property
    def quantities(self):
        case = self.case
        late = None if case.length < 10.0 else 1.0
        steps = 0.05 if case.length in (9.9, 10.1) else -0.05
        return [
            Quantity("straight", "mm", 3, name="straight", value=3.0 * case.length + case.strength**2),
            Quantity("steps", "kN", 3, name="steps", value=0.5 * case.length + steps),
            Quantity("late", "", 3, name="late", value=late),
        ]


def known(case):
    if case.strength > 2.03:
        raise SolveError("it bursts")
    return Known(case)


def bent(way):
    model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-way, steps=1)


@pytest.fixture(scope="module")
def found():
    return slopes(Wavy(), ["length", "strength"], process=known, processes=1, progress=False)


def test_a_straight_line_has_its_slope_and_no_band(found):
    one = found["straight", "length"]
    assert one.value == pytest.approx(3.0)
    assert one.band == pytest.approx(0.0, abs=1e-9)
    assert one.relative == pytest.approx(30.0 / 34.0)
    assert one.unit == "mm per unit of the parameter"  # a length of the test, which declares none


def test_a_band_has_the_width_of_students_distribution(found):
    """Distances from the line of the runs at 9.8, 9.9, 10, 10.1, 10.2, with three degrees of freedom: t = 3.182."""
    one = found["steps", "length"]
    away = np.array([-0.2, -0.1, 0.0, 0.1, 0.2])
    jumps = np.array([-0.05, 0.05, -0.05, 0.05, -0.05])
    assert one.value == pytest.approx(0.5)
    rest = jumps - jumps.mean()
    assert one.band == pytest.approx(3.1824 * math.sqrt(rest @ rest / 3.0 / (away @ away)), rel=1e-3)
    row = next(row for row in found.table if row[0] == "steps")
    assert row[2] == f"+0.05 ± {0.1 * one.band:.2g}"


def test_a_run_that_fails_is_a_warning_and_its_line_has_one_point_less(found):
    assert found.warnings == ["the run with strength = 2.04 has failed: it bursts [solve]"]
    assert found.notes[0].startswith("slopes of lines through up to 5 whole runs")
    assert len(found.points("straight", "strength")) == 4
    assert found["straight", "strength"].value == pytest.approx(4.0, abs=0.1)


def test_a_number_of_less_than_three_runs_has_no_slope():
    few = slopes(Wavy(), ["strength"], width=0.2, each_side=1, process=known, processes=1, progress=False)
    one = few["straight", "strength"]
    assert one.value is None and one.band is None and "fewer than three" in one.why
    assert not any(row[0] == "straight" for row in few.table)
    half = slopes(Wavy(), ["length"], process=known, processes=1, progress=False)
    assert len(half.points("late", "length")) == 3


def test_files_have_slopes_and_runs(found, tmp_path):
    files = found.write(tmp_path)
    assert [file.name for file in files] == ["slopes.csv", "slopes-runs.csv", "slopes.png"]
    runs = files[1].read_text().splitlines()
    assert runs[0] == "parameter,parameter_value,straight,steps,late"
    assert len(runs) == 1 + 7
    assert files[0].read_text().startswith("response,response_value,parameter,parameter_value,value,relative,unit,band")


@pytest.mark.parametrize(
    ("name", "options", "text"),
    [
        ("friction", {}, "zero has no range"),
        ("cells", {}, "no derivative"),
        ("lenght", {}, "no number of this path"),
        ("strength", {"width": 2.0}, "width"),
        ("length", {"each_side": 0}, "each_side"),
    ],
)
def test_what_has_no_slope_is_refused_before_any_run(name, options, text):
    with pytest.raises(InvalidValue) as refused:
        planned_runs(Wavy(), [name], **options)
    assert text in str(refused.value)


def test_slopes_of_a_smooth_process_are_its_derivatives():
    case = AirBending(stroke=4.0, layers=1, elements_per_thickness=1.0, increment=0.025)
    base = air_bending(case, progress=False)
    lines = slopes(case, ["die_radius"], process=air_bending, base=base, processes=1, progress=False)
    exact = uf.derivatives(case, ["die_radius"], ["springback", "angle"], progress=False)
    for name in ("springback", "angle"):
        slope, derivative = lines[name, "die_radius"], exact[name, "die_radius"].value
        assert slope.value == pytest.approx(derivative, rel=0.01)
        assert slope.band < 0.01 * abs(derivative)


def test_a_number_that_does_not_change_has_no_row(found):
    one = slopes(Wavy(length=11.0), ["strength"], process=known, processes=1, progress=False)
    assert (one["late", "strength"].value, one["late", "strength"].band) == (0.0, 0.0)
    assert [row[0] for row in one.table[1:]] == ["straight"]


def test_wanted_names_of_a_process():
    few = slopes(Wavy(), ["length"], ["steps"], process=known, processes=1, progress=False)
    assert [one.name for one in few.responses] == ["steps"]
    with pytest.raises(InvalidValue, match="no such quantity"):
        slopes(Wavy(), ["length"], ["stepps"], process=known, base=known(Wavy()), processes=1, progress=False)


def test_a_model_of_a_function_is_built_anew_for_each_run():
    found = slopes(bent, {"way": 0.01}, ["tip_force:last"], each_side=1, progress=False)
    assert found["tip_force:last", "way"].relative == pytest.approx(1.0, rel=1e-3)
    cached = bent(0.01)
    with pytest.raises(InvalidValue, match="the same model twice"):
        slopes(lambda way: cached, {"way": 0.01}, ["tip_force:last"], progress=False)


def test_a_function_that_other_processes_do_not_find_is_refused_before_the_runs():
    with pytest.raises(InvalidValue, match="not known to other processes"):
        slopes(Wavy(), ["length"], process=lambda case: Known(case), processes=2, progress=False)
    with pytest.raises(InvalidValue, match="no parameter for slopes"):
        slopes(Wavy(), [], process=known, processes=1, progress=False)


def test_the_outcome_of_another_case_values_and_half_processes_are_refused():
    given = {"process": known, "progress": False}
    with pytest.raises(InvalidValue, match="outcome of another case") as refused:
        slopes(Wavy(), "length", base=known(Wavy(strength=1.0)), processes=1, **given)
    assert refused.value.where == "base" and "strength" in refused.value.value
    with pytest.raises(InvalidValue, match="those of a function"):
        slopes(Wavy(), {"length": 9.0}, processes=1, **given)
    with pytest.raises(InvalidValue, match="a whole number"):
        slopes(Wavy(), "length", processes=1.5, **given)


def test_a_text_is_a_list_of_one(found):
    one = slopes(Wavy(), "length", "straight", process=known, base=known(Wavy()), processes=1, progress=False)
    assert one["straight", "length"].value == found["straight", "length"].value


def test_an_error_of_the_program_ends_the_study():
    def end(case):
        if case.length > 10.0:
            raise AssertionError
        return Known(case)

    with pytest.raises(AssertionError):
        slopes(Wavy(), ["length"], process=end, processes=1, progress=False)


def test_responses_have_names_of_their_own():
    with pytest.raises(InvalidValue, match="two responses have the same name"):
        slopes(bent, {"way": 0.01}, [lambda r: 1.0, lambda r: 2.0], progress=False)
