"""Hemming: the hem ends at its height or at a force, closed on itself, on an inner sheet or over an insert."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming import Hemming, hemming
from umform.processes.hemming.files import FILES, record, write_files
from umform.processes.hemming.measures import clearances
from umform.processes.hemming.operations import operations_of
from umform.processes.hemming.outcome import names_of
from umform.processes.hemming.problem import problem_of_hem
from umform.processes.hemming.spec import acute
from umform.results.quantity import GIVEN

SHEET = acute(element="BEND18", elements_per_thickness=1.0, layers=1, increment=0.025)
COARSE = Hemming(form="insert", base=13.0, increments=24, sheet=SHEET)
THICK = replace(COARSE, sheet=replace(SHEET, thickness=2.0))
FLAT = Hemming(base=13.0, increments=96, sheet=acute(elements_per_thickness=1.5, layers=1, increment=0.0125))


def test_a_bend_that_its_die_lets_go_keeps_its_derivatives():
    """Its last increment passes the loss of contact with the die, or its force falls to zero: as rounding decides."""
    for stroke in (5.605, 5.61, 5.6, 5.62, 5.595):
        bend = replace(FLAT, sheet=replace(FLAT.sheet, stroke=stroke)).first
        found = uf.derivatives(bend, ["sheet.punch_radius"], ["bend 1: angle"], progress=False)
        slope = found["bend 1: angle", "sheet.punch_radius"].value
        assert found.warnings == [] and slope == pytest.approx(-0.03 + 34.0 * (stroke - 5.61), abs=0.08)
        if found.run["die_active"][-1] == 0:
            return
    pytest.fail("the die lets none of the bends go")


@pytest.fixture(scope="module")
def told():
    return []


@pytest.fixture(scope="module")
def hem(told):
    return hemming(COARSE, tolerance=5.0, frames=12, progress=lambda *tick: told.append(tick))


def test_names_of_a_hem_are_known_before_its_run(hem):
    assert {one.name for one in hem.quantities} <= set(names_of(hem.case))
    with pytest.raises(InvalidValue, match="did you mean springback"):
        uf.derivatives(hem.with_stroke, ["sheet.thickness"], of=["springbak"], progress=False)
    with pytest.raises(InvalidValue, match="did you mean springback"):
        uf.slopes(COARSE, ["sheet.thickness"], of=["springbak"], process=hemming, processes=1, progress=False)


def test_a_stroke_that_leaves_the_flange_open_is_refused_before_it_is_flattened():
    with pytest.raises(InvalidValue, match="closes to 70 degrees") as refused:
        hemming(replace(COARSE, sheet=replace(SHEET, stroke=2.0)), progress=False)
    assert refused.value.where == "sheet.stroke" and "which leaves 1" in refused.value.value


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


def test_nothing_is_left_of_the_force_after_release(hem, flat):
    """A thousandth of the force that closes a flat hem bends its flange by half of its springback."""
    for one in (hem, flat):
        assert abs(one.force[-1]) <= 1e-6 * one.measures.largest_force


def test_a_hem_that_closes_on_itself_has_derivatives(flat):
    """Along the path of its run."""
    case = replace(FLAT, sheet=replace(FLAT.sheet, stroke=flat.first.bends[0].measures.stroke))
    found = uf.derivatives(case, ["sheet.material.E"], ["height", "loop_gap"], progress=False)
    assert found.warnings == []
    assert found["height", "sheet.material.E"].value < 0.0  # stiffer: less springback


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
    assert text["contacts"]["flattening"]["insert"]["rule"].endswith("contact points on each facet")
    write_files(tmp_path, hem)
    assert {file.name for file in tmp_path.iterdir()} == set(FILES)
    page = (tmp_path / "report.html").read_text()
    assert all(f"<td>{value}</td>" in page for _, value, *_ in rows)
    assert page.count("<h2>Balance of forces and energies</h2>") == 1 and "<th>flattening</th>" in page
    assert "V 8, 30 degrees, shoulder 1, punch radius 0.5, 30 degrees; V/t 8" in page


def test_each_number_has_a_band(hem, flat):
    """A plate with a force has studies of its own, errors in mm follow the thickness; a given stroke leaves one out."""
    made, *more = (
        replace(case, sheet=replace(case.sheet, layers=2, element="ANS3DEAS")) for case in (COARSE, FLAT, THICK)
    )
    assert not any(number.band or not number.of_mesh for number in hem.quantities)  # one layer: no studies
    hem, flat = replace(hem, case=made), replace(flat, case=more[0])
    for one in (hem, flat):
        assert all(number.band.error > 0.0 and not number.of_mesh for number in one.quantities)
    pressed, thick = (replace(hem, case=case) for case in (replace(made, force=300.0), more[1]))
    assert [one.name for one in pressed.quantities if one.band == GIVEN] == ["force", "largest_force"]
    assert (hem.studied.process, pressed.studied.process) == ("hem, filled", "hem by force")
    bands = [{number.name: number.band for number in one.quantities} for one in (hem, thick)]
    assert bands[1]["roll_in"].error == pytest.approx(2.0 * bands[0]["roll_in"].error)
    assert bands[1]["angle"] == bands[0]["angle"]
    *rest, angle = replace(hem, case=hem.with_stroke).quantities
    assert all(number.band for number in rest) and angle.band is None and angle.of_mesh


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


def test_a_force_that_stops_the_plate_above_the_gap_is_a_warning(hem):
    """0.01 thicknesses above it and more; a plate that is moved there is where it should be."""

    def said(height, force=20.0):
        case, measures = replace(hem.case, force=force), replace(hem.measures, loaded_height=height, left=0.25)
        return [text for text in replace(hem, case=case, measures=measures).warnings if "stops the plate" in text]

    assert said(3.3) == [
        "the force stops the plate 0.300 mm above the wanted height: 0.250 mm are left between the flange and what it "
        "lies on, under load"
    ]
    assert said(3.009) == said(3.3, force=None) == []


@pytest.fixture(scope="module")
def flat():
    return hemming(FLAT, tolerance=5.0, frames=12, progress=False)


def test_a_flat_hem_is_closed(flat):
    assert flat.is_closed and abs(flat.measures.left) <= 0.01
    assert "closed" in flat.notes[0] and not any("not closed" in text for text in flat.warnings)
    assert all(flat.result[f"{name}_penetration"].max() <= 0.005 for name in ("inside", "table", "plate"))
    assert flat.measures.loaded_height == pytest.approx(2.0, abs=0.02)
    assert flat.measures.height > flat.measures.loaded_height
    assert flat.measures.inner_strain < 0.0 < flat.measures.outer_strain


def test_roll_in_and_creep_are_those_of_the_section(flat):
    end = flat.strip.current[-1, :, 0].mean()
    assert flat.measures.roll_in == pytest.approx(FLAT.base - (end - flat.profile[:, 0].min()))
    assert flat.measures.creep < 0.0  # the fold grows beyond that of the first bend


def test_the_gap_along_the_flange_is_recorded(flat, tmp_path):
    s, pressed, free = np.array(flat.gaps).T
    assert (np.diff(s) > 0.0).all() and s[0] == 0.0 and s[-1] < FLAT.flange
    assert free.max() == pytest.approx(flat.measures.loop_gap, abs=1e-5) and pressed[0] < 0.01
    write_files(tmp_path, flat)
    assert (tmp_path / "gaps.csv").read_text().startswith("from the tip mm")
    text = json.loads((tmp_path / "hem.json").read_text())
    assert text["closed"] is True
    assert {one["rule"] for one in text["contacts"]["flattening"].values()} == {"3 x 3 cells on each facet"}


def test_a_small_force_leaves_a_flat_hem_open():
    hem = hemming(replace(FLAT, force=40.0), tolerance=5.0, frames=1, progress=False)
    assert hem.measures.force == pytest.approx(40.0, rel=1e-6)
    assert not hem.is_closed and any("not closed" in text for text in hem.warnings)
    assert hem.measures.loaded_height > 2.2


def test_an_inner_sheet_is_clamped_between_flange_and_base(tmp_path):
    hem = hemming(replace(FLAT, form="inner", gap=0.5), tolerance=5.0, frames=1, progress=False)
    assert hem.measures.loaded_height == pytest.approx(2.5, abs=0.03)
    assert abs(hem.measures.left) <= 0.02
    (inner,) = hem.beside
    assert np.ptp(inner[:, 1]) == pytest.approx(0.5, abs=0.05)
    loaded = int(np.argmax(hem.force))
    pushed = [hem.result[f"{name}_fz"][loaded] for name in ("above", "below")]
    assert pushed[0] > 0.0 > pushed[1] or pushed[0] < 0.0 < pushed[1]
    write_files(tmp_path, hem)
    assert "[added.inner]" in (tmp_path / "hem.toml").read_text()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"angle": 90.0}, "a number from 20 to 70"),
        ({"gap": 0.0}, "an inner sheet or an insert a thickness"),
        ({"gap": -0.1}, "a number from 0 to"),
        ({"flange": 1e300, "base": 1e301}, "a number from 0.001 to"),
        ({"form": "flat", "gap": 0.5}, "a flat hem has no gap"),
        ({"form": "rope", "gap": 0.0, "loop": 13.0}, "ends before its flange"),
        ({"loop": 3.0}, "ends before its flange"),
        ({"insert_from": 100.0}, "lies below the flange"),
        ({"form": "open", "insert_from": 3.0}, "the form of the hem is open"),
        ({"force": -4.0}, "a number of more than 0"),
        ({"form": "closed"}, "flat"),
        ({"base": 8.0, "flange": 12.0}, "longer than its flange"),
        ({"flange": 5.0}, "too short for the die"),
        ({"angle": 29.0}, "cannot be reached"),
        ({"increments": 2}, "whole number from 6"),
    ],
)
def test_hems_that_cannot_be_made_are_refused(change, message):
    with pytest.raises(InvalidValue, match=message):
        replace(COARSE, **change)


@pytest.mark.parametrize(("form", "gap"), [("open", 1.0), ("flat", 0.0)])
def test_a_hem_is_two_operations(form, gap):
    case = replace(FLAT, form=form, gap=gap, sheet=replace(FLAT.sheet, stroke=6.7))
    assert [one.name for one in operations_of(case)][-1] == "flattening"


@pytest.mark.parametrize(("form", "kind"), [("insert", "points"), ("open", "cells")])
def test_a_hem_that_touches_itself_is_pressed_over_cells(form, kind, hem):
    case = replace(COARSE, form=form)
    contacts = problem_of_hem(case, hem.first)[0].source.data["contacts"]
    assert all(kind in one for one in contacts.values())
