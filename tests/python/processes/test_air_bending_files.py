"""Error budget, files, and the command `umform bend`."""

from __future__ import annotations

import csv
import json
import re
from base64 import b64decode
from dataclasses import dataclass, replace
from html import escape

import numpy as np
import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.elements import element
from umform.errors import InvalidValue
from umform.materials import J2, Perfect
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.air_bending import budget as budget_module
from umform.processes.air_bending.budget import error_budget, refinements
from umform.processes.air_bending.files import parameters, write_files
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.problem import build, problem_of
from umform.results.budget import Budget
from umform.results.quantity import declared
from umform.spec import parameters as parameters_of

MOST_LAYERS, MOST_POINTS = (parameters_of(AirBending)[name].most for name in ("layers", "contact_points"))

TINY = AirBending(stroke=1.0, elements_per_thickness=1.0, layers=1, increment=0.025)
TYPED = ["--elements-per-thickness", "1", "--layers", "1", "--increment", "0.025"]


@pytest.fixture(scope="module")
def bend():
    return air_bending(TINY, progress=False)


@pytest.fixture(scope="module")
def errors(bend):
    return error_budget(bend, processes=1, progress=False)


def test_each_refinement_changes_one_parameter():
    for label, refined in refinements(TINY).items():
        before, after = TINY.record(), refined.record()
        assert label == "stack" or sum(before[name] != after[name] for name in before) == 1


@pytest.mark.parametrize(("name", "finer"), [("BEND18", 2.0), ("BEND8", 1.0)])
def test_the_stack_has_its_nodes_where_the_sheet_has_them(name, finer):
    case = replace(TINY, element=name, width_elements=1)
    stack = refinements(case)["stack"]
    assert (stack.layers, stack.elements_per_thickness, stack.width_elements) == (MOST_LAYERS, finer, 2)
    changed = {key for key, value in case.record().items() if value != stack.record()[key]}
    assert changed - {"elements_per_thickness"} == {"element", "layers", "thickness_points", "width_elements"}
    assert refinements(replace(case, elements_per_thickness=80.0))["stack"].elements_per_thickness == 80.0


def test_the_stack_tells_what_two_layers_are_off_by():
    """It stands for the reference of docs/verification/air-bend-mesh.md, twelve elements on a thickness."""
    case = AirBending(stroke=5.5, increment=0.0125)
    two, stack = (air_bending(bent, progress=False, frames=1).measures for bent in (case, refinements(case)["stack"]))
    assert stack.angle == pytest.approx(99.1986, abs=0.1)
    assert stack.springback == pytest.approx(1.54299, rel=5e-3)
    assert stack.angle - two.angle > 0.5
    assert stack.springback < 0.98 * two.springback


def test_an_element_of_ones_own_is_recorded_by_its_name():
    case = replace(TINY, element=element("MI9K3DEAS", thickness_order=2, tie_E33=True))
    assert parameters(case)["element"] == "MI9K3DEAS"


def test_automatic_contact_is_refined_from_what_it_comes_to():
    few = replace(TINY, elements_per_thickness=6.0)
    points = max(contact.points for contact in build(few)[0].contacts)
    assert points < MOST_POINTS - 1
    assert refinements(few)["c-pts+2"].contact_points == points + 2
    assert refinements(TINY)["depth/2"].penetration == pytest.approx(0.0025 * TINY.thickness)
    assert refinements(replace(TINY, penetration=0.02))["depth/2"].penetration == 0.01


def test_what_is_given_is_refined_from_there():
    cases = refinements(replace(TINY, penalty=1e5, contact_points=9))
    assert cases["penalty*2"].penalty == 2e5
    assert cases["c-pts+2"].contact_points == MOST_POINTS
    assert refinements(replace(TINY, contact_points=MOST_POINTS))["c-pts-2"].contact_points == MOST_POINTS - 2


def test_what_is_as_fine_as_it_may_be_is_made_coarser():
    cases = refinements(replace(TINY, layers=8, thickness_points=15, elements_per_thickness=80.0, increment=1e-5))
    assert cases["layers-1"].layers == 7
    assert cases["t-pts-2"].thickness_points == 13
    assert cases["mesh*2"].elements_per_thickness == 40.0
    assert cases["step*2"].increment == 2e-5


def test_a_budget_is_the_change_by_each_refinement(bend, errors):
    assert errors.failures == {}
    finer = air_bending(replace(TINY, elements_per_thickness=2.0), progress=False).measures
    for name in ("angle", "largest_force"):
        expected = getattr(finer, name) - getattr(bend.measures, name)
        assert errors.changes["mesh/2"][name] == pytest.approx(expected, abs=2e-3)
    assert errors.total("angle") >= abs(errors.changes["mesh/2"]["angle"]) > 0.0
    assert errors.total("stroke") == 0.0


def test_a_refined_run_that_fails_says_so(bend, monkeypatch):
    def fails(case):
        raise ValueError("no")

    monkeypatch.setattr(budget_module, "_run", fails)
    errors = error_budget(bend, processes=1, progress=False)
    assert set(errors.failures) == set(refinements(TINY))
    assert np.isnan(errors.total("angle"))


def test_tables_have_a_column_for_each_refinement(bend, errors):
    wide = replace(bend, budget=errors, case=replace(bend.case, width=50.0, width_elements=2))
    header, *rows = wide.tables["Measures"]
    assert header == ["quantity", "value", "error", *errors.changes, "unit"]
    assert {len(row) for row in rows} == {len(header)}
    labels = [one.label for one in declared(Measures).values()]
    assert [row[0] for row in rows if row[0] != "force on the width"] == labels
    total = next(row for row in rows if row[0] == "force on the width")
    assert "K-factor (for the flat pattern)" in [row[0] for row in bend.tables["Measures"]]
    assert f"± {errors.total('angle'):.2f}" in next(row for row in rows if row[0] == "angle")
    assert float(total[1]) == pytest.approx(bend.measures.largest_force * 0.05, abs=0.006)


def test_the_total_force_is_the_largest_one_on_the_length_of_the_bend(bend):
    long = replace(bend, bend_length=500.0, measures=replace(bend.measures, force=7.0, largest_force=90.0))
    assert long.total_force == 45e3 and long["total_force"].value == 45.0
    assert bend.total_force is None  # plane strain


def test_all_files_are_written(tmp_path, bend, errors):
    files = write_files(tmp_path / "out", replace(bend, table=(bend.measures,), budget=errors))
    assert sorted(file.name for file in files) == sorted(
        ["curve.csv", "table.csv", "quantities.csv", "bend.json", "bend.vtkhdf", "bend.toml", "report.html"]
        + [f"{name}.{ending}" for name in ("curve", "shape", "drawing") for ending in ("png", "svg")]
    )
    record = json.loads((tmp_path / "out" / "bend.json").read_text())
    assert record["measures"]["angle"] == bend.measures.angle
    assert record["budget"]["changes"]["mesh/2"]["angle"] == errors.changes["mesh/2"]["angle"]
    (balance,) = record["balance"].values()
    assert balance["force_imbalance"] < 1e-6 and balance["moment_imbalance"] < 1e-6
    assert set(record["contacts"]["bend"]) == {"die", "punch"}
    with (tmp_path / "out" / "curve.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(bend.stroke)
    assert float(rows[-1]["stroke mm"]) == bend.stroke[-1]
    page = (tmp_path / "out" / "report.html").read_text()
    assert "% discarded" in page and "<td>work of punch</td>" in page
    assert all(one.label in page for one in declared(Measures).values())
    assert all(f'id="{part}"' in page for part in ("shape-canvas", "curves", "scene", "history-csv"))
    deck = (tmp_path / "out" / "bend.toml").read_text()
    assert deck == problem_of(bend.case).toml()
    assert escape(deck) in page


def columns_of(path):
    with path.open() as file:
        header = file.readline().strip().split(",")
        return dict(zip(header, np.loadtxt(file, delimiter=",").T, strict=True))


def test_a_curve_of_the_user_leaves_out_the_deck(tmp_path, bend):
    @dataclass(frozen=True)
    class OwnCurve:
        """A curve that no module has: decks have no words for it."""

        stress: float

        def curve(self):
            return Perfect(self.stress).curve()

    case = replace(bend.case, material=J2(E=210e3, nu=0.3, hardening=OwnCurve(200.0)))
    with pytest.raises(InvalidValue, match="no words"):
        problem_of(case).toml()
    files = write_files(tmp_path, replace(bend, case=case))
    assert "bend.toml" not in {file.name for file in files}
    assert "for umform run" not in (tmp_path / "report.html").read_text()


@pytest.mark.parametrize(
    ("scale", "changes"),
    [
        (2.0 / 2.0, ["--stroke", "1", *TYPED]),
        (2.0 / 5.0, ["--angle", "170", "--tolerance", "0.5", "--width", "10", "--width-elements", "2",
         "--penetration", "0.02", "--contact-points", "5", "--yield-stress", "200",
         "--hardening-modulus", "500", *TYPED]),
    ],
    ids=["plane strain", "finite width"],
)  # fmt: skip
def test_the_printed_deck_gives_the_curve_of_the_bend_and_its_way_back(scale, changes, tmp_path):
    printed = CliRunner().invoke(app, ["bend", *changes, "--print-deck"])
    assert printed.exit_code == 0, printed.output
    (tmp_path / "deck.toml").write_text(printed.stdout)
    bent = CliRunner().invoke(app, ["bend", *changes, "--out", str(tmp_path / "bend")])
    assert bent.exit_code == 0, bent.output
    assert (tmp_path / "bend" / "bend.toml").read_text() == printed.stdout
    run = CliRunner().invoke(app, ["run", str(tmp_path / "deck.toml"), "--out", str(tmp_path / "run")])
    assert run.exit_code == 0, run.output
    curve, history = columns_of(tmp_path / "bend" / "curve.csv"), columns_of(tmp_path / "run" / "history.csv")
    assert set(curve["step"]) == {0.0, 1.0, 2.0}
    assert np.array_equal(curve["stroke mm"], history["stroke"])
    assert np.array_equal(curve["force kN/m"], scale * history["stroke_force"])


def test_a_failed_refinement_does_not_spoil_the_files(tmp_path, bend):
    changes = {"mesh/2": dict.fromkeys(declared(Measures), float("nan"))}
    write_files(tmp_path, replace(bend, budget=Budget(changes, {"mesh/2": "it did not converge"}, "refinements")))
    record = json.loads((tmp_path / "bend.json").read_text())
    assert record["budget"] == {"changes": {}, "failures": {"mesh/2": "it did not converge"}}
    assert "it did not converge" in (tmp_path / "report.html").read_text()


def test_the_command_bends_to_a_stroke(tmp_path):
    typed = ["bend", "--stroke", "1", "--table", "0.5:1:0.5", "--swift", "520,0.004,0.22", "--width", "10"]
    done = CliRunner().invoke(app, [*typed, "--width-elements", "2", *TYPED, "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert "force on the width" in done.output
    assert "Bending table" in done.output
    assert (tmp_path / "report.html").exists()
    assert len((tmp_path / "table.csv").read_text().splitlines()) == 3


@pytest.mark.parametrize(("stroke", "ratio"), [("0.0001", None), ("0.01", 0.0)])
def test_a_sheet_that_springs_back_flat_gives_what_is_known(stroke, ratio, tmp_path):
    typed = ["bend", "--stroke", stroke, "--table", "0.005:0.015:0.01", *TYPED, "--out", str(tmp_path)]
    done = CliRunner().invoke(app, typed)
    assert done.exit_code == 0, done.output
    assert "K-factor and what follows cannot be determined" in done.stderr
    assert re.search(r"bend deduction .*–", done.stdout)
    record = json.loads((tmp_path / "bend.json").read_text())
    measures = record["measures"]
    assert measures["angle"] == 180.0
    assert measures["springback"] == pytest.approx(180.0 - measures["loaded_angle"])
    assert (measures["force"] > 0.0) == (ratio is not None)  # not before the first contact point
    assert measures["springback_ratio"] == ratio
    assert {measures[name] for name in ("radius", "k_factor", "bend_deduction")} == {None}
    assert record["table"][0]["k_factor"] is None
    assert "cannot be determined" in (tmp_path / "report.html").read_text()


def test_the_command_takes_a_metal_of_the_library(tmp_path):
    typed = ["bend", "--all", "--stroke", "1", "--material", "DC04", *TYPED, "--length", "500", "--out", str(tmp_path)]
    done = CliRunner().invoke(app, typed)
    assert done.exit_code == 0, done.output
    assert "DC04: EN 10130" in done.output
    page = (tmp_path / "report.html").read_text()
    assert "DC04: EN 10130" in page and "Air bending: DC04" in page and "on a bend length of 500 mm" in page
    record = json.loads((tmp_path / "bend.json").read_text())
    assert record["total_force"] == pytest.approx(500.0 * record["measures"]["largest_force"])
    reached = re.findall(r"contact (\w+): penetration up to (\S+), 0.01 allowed;", done.output)
    assert [name for name, _ in reached] == ["die", "punch"]
    assert max(float(depth) for _, depth in reached) == pytest.approx(record["penetration"], rel=1e-2)
    assert 270.0 <= record["tensile_strength"] <= 350.0


def test_the_command_finds_an_angle(tmp_path):
    typed = ["bend", "--angle", "160", "--tolerance", "0.1", "--yield-stress", "200", "--hardening-modulus", "500"]
    done = CliRunner().invoke(app, [*typed, *TYPED, "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    record = json.loads((tmp_path / "bend.json").read_text())
    assert record["measures"]["angle"] == pytest.approx(160.0, abs=0.2)
    assert "500" in record["parameters"]["material"]


def test_the_chart_of_the_report_has_the_force_of_the_table(bend, tmp_path):
    write_files(tmp_path, bend)
    page = (tmp_path / "report.html").read_text()
    assert 'data-x="stroke" data-y="force kN/m"' in page
    (coded,) = re.findall(r'href="data:text/csv;base64,([^"]*)"', page)
    rows = list(csv.DictReader(b64decode(coded).decode().splitlines()))
    assert max(float(row["force kN/m"]) for row in rows) == bend.measures.largest_force
