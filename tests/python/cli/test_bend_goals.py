"""Goals of `umform bend`, and the folder of a run."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.processes.air_bending import AirBending, find_stroke


def test_a_table_alone_ends_at_its_last_stroke(tmp_path):
    fast = ["--layers", "1", "--elements-per-thickness", "1", "--increment", "0.05"]
    done = CliRunner().invoke(app, ["bend", "--table", "0.8,0.4", *fast, "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert json.loads((tmp_path / "bend.json").read_text())["measures"]["stroke"] == 0.8
    assert len((tmp_path / "table.csv").read_text().splitlines()) == 3


def test_a_table_of_angles_has_the_bends_to_each_of_them(tmp_path):
    fast = ["--layers", "1", "--elements-per-thickness", "1", "--increment", "0.05", "--tolerance", "0.1"]
    done = CliRunner().invoke(app, ["bend", "--angles", "150:170:10", *fast, "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    with (tmp_path / "table.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["angle degrees"]) for row in rows] == pytest.approx([170.0, 160.0, 150.0], abs=0.1)
    case = AirBending(layers=1, elements_per_thickness=1, increment=0.05)
    for row in rows[1:]:  # the last one is the bend itself
        single = find_stroke(case, round(float(row["angle degrees"]), -1), tolerance=0.1).measures
        assert float(row["stroke mm"]) == single.stroke
        assert float(row["springback degrees"]) == single.springback
    assert json.loads((tmp_path / "bend.json").read_text())["measures"]["stroke"] == float(rows[-1]["stroke mm"])
    both = CliRunner().invoke(
        app, ["bend", "--angles", "160", "--angle", "170", *fast, "--out", str(tmp_path / "both")]
    )
    assert both.exit_code == 0, both.output
    with (tmp_path / "both" / "table.csv").open() as file:
        assert [row["stroke mm"] for row in csv.DictReader(file)] == [rows[1]["stroke mm"]]


@pytest.mark.parametrize(("typed", "environment"), [(["--csv", "german"], {}), ([], {"UMFORM_CSV": "german"})])
def test_tables_for_german_spreadsheets(typed, environment, tmp_path):
    fast = ["--stroke", "0.4", "--table", "0.4:0.4:1", "--layers", "1", "--elements-per-thickness", "1"]
    done = CliRunner().invoke(app, ["bend", *fast, *typed, "--out", str(tmp_path)], env=environment)
    assert done.exit_code == 0, done.output
    for name in ("table.csv", "curve.csv", "quantities.csv"):
        text = (tmp_path / name).read_text(encoding="utf-8-sig")
        assert ";" in text.splitlines()[0] and "," not in text.splitlines()[0]
        assert "0,4;" in text and "0.4" not in text


def test_an_unknown_style_of_tables_is_refused(tmp_path):
    done = CliRunner().invoke(app, ["bend", "--stroke", "1", "--csv", "swiss", "--out", str(tmp_path / "out")])
    assert done.exit_code == 1 and "--csv, UMFORM_CSV" in done.stderr and "german" in done.stderr


@pytest.mark.parametrize(
    "refused",
    [
        ["--angles", "80:90:10"],
        ["--angle", "80"],
        ["--stroke", "6", "--young", "5", "--yield-stress", "1"],
        ["--bottoming", "--die-angle", "88", "--punch-angle", "88", "--force-per-metre", "-4"],
    ],
)
def test_the_folder_of_a_run_that_does_not_start_is_not_named(refused, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "results" / "bend").mkdir(parents=True)
    (tmp_path / "results" / "bend" / "curve.csv").touch()
    done = CliRunner().invoke(app, ["bend", *refused])
    assert done.exit_code == 1
    assert "this run writes to" not in done.stderr


GPA = ["--young", "210", "--poisson", "0.3", "--curve", "Swift,520,0.004,0.22"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--stroke", "4", *GPA, "--want", "angle=120+-1", "--by", "stroke"], "E of steel is 210e3"),
        (["--stroke", "4", *GPA, "--find", "E", "--quantity", "angle=120+-1"], "E of steel is 210e3"),
        (["--sequence", "part.toml", *GPA], "E of steel is 210e3"),
        (["--stroke", "4", "--want", "angle=120+-1", "--want", "angle=110+-1", "--by", "stroke"], "wanted twice"),
        (["--stroke", "4", "--want", "angle=120+-1", "--by", "stroke", "--by", "stroke=2:3"], "follows twice"),
        (["--stroke", "4", "--want", "angle=120+-1", "--by", "stroke=5:3"], "the two exchanged"),
        (["--angle", "120", "--want", "radius=3+-1", "--by", "punch_radius"], "begins with a stroke"),
        (["--stroke", "4", "--want", "angle=120", "--by", "stroke"], "as springback=2+-0.05"),
        (["--stroke", "4", "--want", "angle=120+-1", "--by", "stroke", "--table", "3:9:1"], "beyond air bending"),
        (["--stroke", "4", "--find", "E", "--scatter", "thickness=1%"], "--scatter"),
        (["--stroke", "4", "--find", "E", "--timing"], "--all or --timing beside it"),
        (["--stroke", "4", "--processes", "2"], "--budget is missing"),
        (["--stroke", "4", "--width-elements", "5"], "--width is missing"),
        (["--stroke", "4", "--tolerance", "0.1"], "--angle, --angles or --sequence is missing"),
        (
            ["draw", "u", "--want", "theta1=90+-1", "--by", "friction", "--limit-curve", "no.csv"],
            "forming limit cannot",
        ),
        (["draw", "u", "--limit-curve", "limit.csv"], "row 3 is no pair of numbers"),
        (["draw", "u", "--limit-curve", "empty.csv"], "umform: the forming limit cannot be read"),
        (["draw", "u", "--penalty", "1e300"], "a softer penalty"),
        (["--thickness", "0.002", "--opening", "0.016", "--stroke", "0.004"], "if these are metres: thickness 2.000"),
        (["--thickness", "0.08", "--opening", "0.6", "--stroke", "0.2"], "if these are inches: thickness 2.032"),
        (["--stroke", "4", "--scatter", "thickness=1%", "--tolerance-of", "thickness=0.1"], "cannot scatter twice"),
    ],
)
def test_what_is_wrong_with_studies_is_said_before_the_first_run(words, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("part.toml").write_text("length = 45.0\n[[bends]]\nposition = 20.0\nstroke = 4.0\n")
    Path("limit.csv").write_text("minor,major\n-0.2,0.4\n0.0 mm,0.3\n0.2,0.4\n")
    Path("empty.csv").touch()
    monkeypatch.setattr("umform.analysis.run.open_run.OpenRun.take", lambda *given: pytest.fail("a run"))
    done = CliRunner().invoke(app, words if words[0] == "draw" else ["bend", *words])
    assert done.exit_code == 1
    assert said in done.stderr
    assert not Path("results").exists()


def test_wanted_results_that_are_not_reached_end_with_code_1(tmp_path):
    coarse = ["--layers", "1", "--elements-per-thickness", "1", "--increment", "0.05", "--out", str(tmp_path / "out")]
    words = ["bend", "--stroke", "1", "--want", "angle=100+-1", "--by", "stroke=0.9:1.1", *coarse]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 1
    assert "not reached in 2 runs" in done.stderr
    assert (tmp_path / "out" / "bend.json").is_file()
