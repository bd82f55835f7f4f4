"""Hemming: the hem ends at its height, over an insert; an open one that would touch itself is refused."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from umform.errors import InvalidValue
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming import Hemming, hemming
from umform.processes.hemming.files import FILES, record, write_files
from umform.processes.hemming.measures import clearances
from umform.processes.hemming.run import _refuse_touch
from umform.processes.hemming.spec import acute

COARSE = Hemming(base=13.0, increments=24, sheet=acute(elements_per_thickness=1.0, layers=1, increment=0.025))


@pytest.fixture(scope="module")
def told():
    return []


@pytest.fixture(scope="module")
def hem(told):
    return hemming(COARSE, tolerance=5.0, frames=12, progress=lambda *tick: told.append(tick))


def test_progress_is_told_for_each_increment_of_the_plate(hem, told):
    fractions = [fraction for name, fraction, *_ in told if name == "flattening"]
    assert len(fractions) == int((hem.result["step"] <= 12).sum()) - 1
    assert fractions == sorted(fractions) and fractions[-1] == pytest.approx(1.0)


def test_the_hem_has_its_height_under_load(hem):
    assert hem.measures.loaded_height == pytest.approx(COARSE.height, abs=0.02)


def test_it_opens_a_little_when_it_is_released(hem):
    m = hem.measures
    assert 0.0 < m.springback < 0.1
    assert m.tip_gap == pytest.approx(COARSE.gap, abs=0.05)
    assert m.loop_gap >= m.tip_gap
    assert abs(m.angle) < 2.0


def test_force_is_balanced_between_plate_and_table(hem):
    loaded = int(np.argmax(hem.force))
    forces = [hem.result[f"{tool}_fz"][loaded] for tool in ("plate", "table", "insert")]
    assert abs(sum(forces)) < 1e-6 * max(map(abs, forces))
    assert hem.force[-1] < 0.01 * hem.measures.largest_force


def test_flange_and_base_keep_their_length(hem):
    """Outside of the bend nothing is stretched: the length of the mid-surface changes by its neutral shift only."""
    middle = hem.strip.middle
    length = float(np.linalg.norm(np.diff(middle, axis=0), axis=1).sum())
    assert length == pytest.approx(COARSE.flange + COARSE.base, abs=0.7)
    assert hem.measures.outer_strain > 0.3


def test_the_record_is_json(hem, tmp_path):
    text = json.loads(json.dumps(record(hem), allow_nan=False))
    assert text["measures"]["height"] == hem.measures.height
    rows = hem.tables["Measures"][1:]
    assert len(rows) == len(text["measures"])
    assert list(text["balance"]) == list(text["contacts"]) == ["first bend", "flattening"]
    assert text["balance"]["flattening"]["works"]["plate"] > 0.0
    assert "insert" in text["contacts"]["flattening"]
    write_files(tmp_path, hem)
    assert {file.name for file in tmp_path.iterdir()} == set(FILES)
    page = (tmp_path / "report.html").read_text()
    assert all(f"<td>{value}</td>" in page for _, value, _ in rows)
    assert page.count("<h2>Balance of forces and energies</h2>") == 1 and "<th>flattening</th>" in page
    assert "V 8, 30 degrees, shoulder 1, punch radius 0.5, 30 degrees; V/t 8" in page


def folded(gap):
    """A strip folded flat with a gap between flange and base, bend line at 12."""
    s = np.linspace(0.0, 42.0, 85)
    reference = np.stack([np.stack([s, np.full_like(s, z)], axis=1) for z in (0.0, 1.0)], axis=1)
    current = reference.copy()
    current[s < 12.0, :, 0] = 24.0 - reference[s < 12.0, :, 0]
    current[s < 12.0, :, 1] = 2.0 + gap - reference[s < 12.0, :, 1]
    return Strip(reference, current, 1)


def test_clearance_is_the_gap():
    assert clearances(COARSE, folded(0.7)) == pytest.approx(0.7)


def test_an_open_hem_that_goes_through_itself_is_refused():
    case = replace(COARSE, insert=False)
    _refuse_touch(case, folded(0.1), 0.0)
    with pytest.raises(InvalidValue, match="no contact with itself") as refused:
        _refuse_touch(case, folded(-0.1), 1.5)
    assert "about 2.5" in refused.value.cause


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"angle": 90.0}, "a number from 20 to 70"),
        ({"gap": 0.0}, "must be positive"),
        ({"base": 8.0, "flange": 12.0}, "longer than its flange"),
        ({"flange": 5.0}, "too short for the die"),
        ({"angle": 29.0}, "cannot be reached"),
        ({"increments": 2}, "whole number from 6"),
    ],
)
def test_hems_that_cannot_be_made_are_refused(change, message):
    with pytest.raises(InvalidValue, match=message):
        replace(COARSE, **change)
