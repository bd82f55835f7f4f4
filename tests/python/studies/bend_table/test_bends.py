"""Bends of a table: from a run, or from the store."""

from __future__ import annotations

import importlib
import math
import sys
from dataclasses import replace

import pytest

from umform.errors import InvalidValue
from umform.materials import J2, Perfect, Swift
from umform.problem.metal_file import write_metal
from umform.processes.air_bending import find_stroke
from umform.studies.bend_table import bend, bend_key, bend_table, setups, stored_bends
from umform.studies.bend_table.stored import RESULTS


def test_a_bend_is_that_of_a_search_for_its_angle(table, store):
    part = table.parts[0]
    one = part.bends[1]
    found = find_stroke(part.setup.case, one.wanted, tolerance=table.tolerance)
    assert found.measures == one.measures
    assert found.case.stroke == one.case.stroke


def test_a_bend_is_asked_twice_and_computed_once(table, store, monkeypatch):
    monkeypatch.setattr("umform.studies.bend_table.stored.Brake", None)
    setups = [part.setup for part in table.parts]
    again = bend_table(setups, [120, 135, 150], store=store, processes=1)
    assert table.computed == 6 and again.computed == 0
    for part, other in zip(table.parts, again.parts, strict=True):
        assert [one.measures for one in part.bends] == [one.measures for one in other.bends]


def test_stored_bends_are_there_without_a_run(table, store, monkeypatch):
    monkeypatch.setattr("umform.studies.bend_table.stored.Brake", None)
    part = table.parts[0]
    found = stored_bends(part.setup.case, [150.0, 121.5, 120.0], store=store)
    assert [one.wanted for one in found] == [150.0, 120.0] and not any(one.computed for one in found)
    assert found[1].measures == part.bends[0].measures


def test_numbers_of_the_store_are_those_of_this_version(case, store):
    """A change of the code that changes these numbers must increase RESULTS: old entries are wrong then."""
    m = bend(case, 120.0, store=store).measures
    found = (RESULTS, m.stroke, m.radius, m.k_factor, m.bend_allowance)
    assert found == pytest.approx((2, 2.08297202, 1.86732563, 0.41913029, 2.39437771), rel=1e-6)


def test_a_table_of_one_setup_shows_each_bend(table, store):
    shown = []
    bend_table([table.parts[0].setup], [120, 135, 150], store=store, progress=lambda *told: shown.append(told[1]))
    assert shown[:3] == pytest.approx([1 / 3, 2 / 3, 1.0])


def test_a_sheet_is_once_in_a_table_and_its_name_is_its_own(case, tmp_path):
    assert [one.metal for one in setups(["DC04", "1.0338", "DC04"], case)] == ["DC04"]
    coils = [tmp_path / name / "metal.toml" for name in ("one", "two")]
    for strength, coil in zip((500.0, 520.0), coils, strict=True):
        coil.parent.mkdir()
        write_metal(coil, J2(206e3, 0.3, hardening=Swift(strength, 0.005, 0.2)), [])
    with pytest.raises(InvalidValue, match="two metals of a table have one name") as error:
        setups([str(coil) for coil in coils], case)
    assert error.value.where == str(coils[1]) and error.value.value == "metal"


def test_the_key_is_of_all_that_determines_the_bend(case):
    changed = [
        replace(case, thickness=1.1),
        replace(case, punch_radius=1.6),
        replace(case, layers=2),
        replace(case, increment=0.01),
        replace(case, material=replace(case.material, hardening=Perfect(200.0))),
    ]
    keys = [bend_key(one, 120.0) for one in (case, *changed)] + [bend_key(case, 121.0), bend_key(case, 120.0, 0.01)]
    assert len(set(keys)) == len(keys)
    assert bend_key(replace(case, thickness=1, stroke=2.0), 120) == keys[0]


def test_the_key_is_of_the_code_of_a_class_of_the_user(case, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    text = (
        "from dataclasses import dataclass\nfrom umform.materials import Perfect\n\n@dataclass(frozen=True)\n"
        "class Flat:\n    at: float\n\n    def curve(self):\n        return Perfect(self.at{}).curve()\n"
    )
    keys = []
    for more in ("", "", " + 100.0"):
        (tmp_path / "curves_of_a_table.py").write_text(text.format(more))
        sys.modules.pop("curves_of_a_table", None)
        metal = J2(206e3, 0.3, hardening=importlib.import_module("curves_of_a_table").Flat(200.0))
        keys.append(bend_key(replace(case, material=metal), 120.0))
    assert keys[0] == keys[1] != keys[2]


def test_definitions_agree(table):
    for part in table.parts:
        for one in part.bends:
            R, T, theta = one.radius, one.case.thickness, math.radians(180.0 - one.measures.angle)
            assert one.allowance == pytest.approx(theta * (R + one.k_factor * T), abs=1e-9)
            assert one.allowance == pytest.approx(theta * (R + one.k_din * T / 2.0), abs=1e-9)
            assert one.deduction == pytest.approx(2.0 * one.measures.setback - one.allowance, abs=1e-9)
            assert abs(one.measures.angle - one.wanted) <= table.tolerance


@pytest.mark.parametrize(("angle", "word"), [(14.0, "15 to 165"), (166.0, "15 to 165"), (80.0, "punch and die is 85")])
def test_an_angle_that_no_tool_bends_is_refused(case, store, angle, word):
    with pytest.raises(InvalidValue, match=word):
        bend(case, angle, store=store)


def test_an_angle_that_the_sheet_does_not_reach_leaves_the_others(table, store):
    setup = table.parts[0].setup
    (part,) = bend_table([setup], [85.1, 150.0], store=store, processes=1).parts
    assert [one.wanted for one in part.bends] == [150.0] and not part.bends[0].computed
    assert "lies against a flank" in part.failed[85.1]
