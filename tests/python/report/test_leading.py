"""The first curve of a report: the control that works, not a load over itself."""

from types import SimpleNamespace

import numpy as np

import umform as uf
from umform.report.key_numbers import key_numbers
from umform.report.looks import MILLIMETRES
from umform.results.forming.tool_distance import pose_in
from umform.results.leading_controls import leading_controls


class Named:
    def __init__(self, name):
        self.name = name


class Rows(dict):
    """Columns of a history, with the controls of a model."""

    def __init__(self, **columns):
        super().__init__({name: np.array(values, dtype=float) for name, values in columns.items()})
        self.columns = self.keys
        self.model = SimpleNamespace(controls=[Named(name) for name in columns if f"{name}_force" in columns])


def leading(**columns):
    return [control.name for control in leading_controls(Rows(**columns))]


def test_the_control_with_the_largest_work_is_first_and_a_load_is_none():
    hold = {"hold": [0, 1e4, 1e4], "hold_force": [0, 1e4, 1e4]}
    lid = {"lid": [0, 1, 1], "lid_force": [0, -5, -900]}
    punch = {"punch": [0, 0, 10], "punch_force": [0, 0, -100]}
    still = {"still": [2, 2, 2], "still_force": [0, 5, 9]}
    assert leading(**hold, **lid, **punch, **still) == ["punch", "lid"]


def test_a_control_that_was_added_after_the_run_is_none():
    rows = Rows(tool=[0, 1], tool_force=[0, 3])
    rows.model.controls.append(Named("tool_left"))
    assert [control.name for control in leading_controls(rows)] == ["tool"]


def test_a_way_that_was_added_after_the_run_is_zero_in_it():
    down, left = Named("down"), Named("left")
    tool = SimpleNamespace(ways=[down, left], pose=lambda values, time: (values, time))
    assert pose_in(tool, {"down": -3.0, "time": 0.5}) == ({down: -3.0, left: 0.0}, 0.5)


def test_a_tool_that_moves_without_force_counts():
    assert leading(tool=[0, 1], tool_force=[0, 0]) == ["tool"]


def test_a_tool_that_turns_has_an_angle_and_a_moment():
    strip = uf.mesh.strip(length=10, width=2, thickness=1, cells=(10, 1))
    model = uf.Model(strip, material=uf.SVK(E=1e3, nu=0.3))
    model.fix("x0")
    wiper = model.contact("lower", uf.Cylinder((8.0, 0.0, -1.5), "y", 1.0), penalty=100.0)
    model.turn(wiper, axis="y", about=(12.0, 0.0, -1.5), name="wiper")
    result = uf.solve(model, uf.Move(model.controls[0], to=0.05, steps=2), progress=False)
    found = {one.name: one.unit for one in key_numbers(result, MILLIMETRES)[:2]}
    assert found == {"largest wiper moment": "N mm", "wiper at the end": "rad"}
    assert key_numbers(result, MILLIMETRES)[1].value == 0.05
