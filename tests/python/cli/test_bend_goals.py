"""Goals of `umform bend`, and the folder of a run."""

from __future__ import annotations

import csv
import json

import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.processes.air_bending import AirBending, find_stroke


def test_a_table_alone_ends_at_its_last_stroke(tmp_path):
    fast = ["--layers", "1", "--elements-per-thickness", "1", "--increment", "0.05"]
    done = CliRunner().invoke(app, ["bend", "--table", "0.4:0.8:0.4", *fast, "--out", str(tmp_path)])
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
