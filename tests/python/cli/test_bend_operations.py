"""What `umform bend` with bottoming or a sequence, and `umform hem`, refuse before anything runs."""

from __future__ import annotations

import json
from pathlib import Path
from unittest.mock import Mock

import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.errors import InvalidValue
from umform.processes.bend_sequence.collisions import Collision

PRESS = ["--bottoming", "--die-angle", "88", "--punch-angle", "88"]


@pytest.mark.parametrize(
    ("typed", "message"),
    [
        (["bend", "--angle", "90", "--force-per-metre", "400"], "needs bottoming"),
        (["bend", *PRESS], "one of them"),
        (["bend", *PRESS, "--force-per-metre", "400", "--travel", "0"], "one of them"),
        (["bend", *PRESS, "--force-per-metre", "400", "--angle", "90"], "no search for an angle"),
        (["bend", *PRESS, "--force-per-metre", "400", "--budget"], "no budget"),
        (["bend", *PRESS, "--travel", "2"], "more than half of its thickness"),
        (["bend", "--bottoming", "--force-per-metre", "400", "--punch-angle", "88"], "of a sharper die"),
        (["bend", "--sequence", "no.toml"], "cannot be read"),
        (["bend", "--sequence", "no.toml", "--stroke", "3"], "of their own"),
        (["bend", "--sequence", "no.toml", "--budget"], "of their own"),
        (["bend", "--angle", "90", "--flat-only"], "stand in a file"),
        (["hem", "--form", "open", "--gap", "0"], "has a gap"),
        (["hem", "--gap", "0.5"], "a flat hem has no gap"),
        (["hem", "--flange", "3"], "too short for the die"),
        (["hem", "--base", "5"], "longer than its flange"),
        (["hem", "--thickness", "-3"], "the thickness of the sheet"),
        (["hem", "--thickness", "2", "--opening", "8", "--angle", "29"], "V/t = 4"),
    ],
)
def test_the_command_refuses(typed, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, [*typed, "--out", str(tmp_path / "out")])
    assert done.exit_code == 1
    assert message in done.stderr
    assert not (tmp_path / "out").exists()


def test_keys_of_a_file_are_not_called_options(tmp_path):
    (tmp_path / "part.toml").write_text("length = 40.0\n[[bends]]\nat = 18.0\nstroke = 0.4\n")
    done = CliRunner().invoke(app, ["bend", "--sequence", str(tmp_path / "part.toml"), "--out", str(tmp_path / "out")])
    assert done.exit_code == 1
    assert "die_angle, die_radius, punch_angle" in done.stderr and "part.toml, bend 1" in done.stderr


def test_outside_dimensions_give_the_flat_length(tmp_path):
    file = tmp_path / "part.toml"
    file.write_text("flanges = [50.0, 50.0]\nk_factor = 0.44\n[[bends]]\nangle = 90.0\n")
    typed = ["bend", "--sequence", str(file), "--flat-only", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, typed)
    assert done.exit_code == 0 and "Flat length: 96.284 mm" in done.stdout  # 100 - 2 * 4.56 + 1.5708 * 3.44
    assert "48.142" in done.stdout and not (tmp_path / "out").exists()
    file.write_text("flanges = [50.0, 50.0]\nk_factor = 0.44\ntable = 'b.csv'\n[[bends]]\nangle = 90.0\n")
    assert "one source" in CliRunner().invoke(app, typed).stderr
    file.write_text("length = 90.0\n[[bends]]\nposition = 45.0\nangle = 90.0\n")
    assert "in this file already" in CliRunner().invoke(app, typed).stderr


def test_a_part_that_collides_is_not_done(tmp_path, monkeypatch):
    (tmp_path / "part.toml").write_text("length = 40.0\n[[bends]]\nposition = 18.0\nstroke = 0.4\n")
    coarse = ["--elements-per-thickness", "1", "--layers", "1", "--increment", "0.025"]
    typed = ["bend", "--sequence", str(tmp_path / "part.toml"), *coarse, "--out", str(tmp_path / "out"), "--overwrite"]
    assert CliRunner().invoke(app, typed).exit_code == 0
    hits = [Collision("punch", 0.3, 9.0)]
    monkeypatch.setattr("umform.processes.bend_sequence.one_bend.collisions", lambda *given: hits)
    monkeypatch.setattr("umform.processes.bend_sequence.foreseen_collisions.collisions", lambda *given: hits)
    done = CliRunner().invoke(app, typed)
    assert done.exit_code == 1
    assert "bend 1: by its geometry the part will collide with the body of the punch" in done.stderr
    assert done.stderr.count("this part cannot be bent so: bend 1: the part collides") == 1
    (said,) = json.loads((tmp_path / "out" / "sequence.json").read_text())["collisions"]
    assert "at 27 mm from the left end" in said


@pytest.mark.parametrize("thickness", [1.0, 3.0])
def test_sizes_of_a_hem_follow_the_thickness(thickness, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = []

    def end(case):
        found.append(case)
        raise InvalidValue("no run")

    monkeypatch.setattr("umform.processes.hemming.hemming", end)
    CliRunner().invoke(app, ["hem", "--form", "insert", "--thickness", str(thickness)])
    (case,) = found
    sheet = case.sheet
    sizes = [sheet.opening, sheet.die_radius, sheet.punch_radius, case.gap, case.flange, case.base]
    assert sizes == [size * thickness for size in (8.0, 1.0, 0.5, 1.0, 12.0, 30.0)]


@pytest.fixture
def one_bend(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("part.toml").write_text("length = 45.0\n[[bends]]\nposition = 20.0\nangle = 140\n")
    return ["bend", "--sequence", "part.toml", "--layers", "1", "--elements-per-thickness", "1", "--increment", "0.05"]


def test_derivatives_of_a_part(one_bend):
    done = CliRunner().invoke(app, [*one_bend, "--derive", "strength", "--timing"], env={"COLUMNS": "160"})
    assert done.exit_code == 0, done.output
    assert "Where the time went" in done.stdout
    assert done.stderr.count("times as many increments") == 1  # during the run, and not again as a warning of bend 1
    assert "bend 1: angle is constant: bends.0.stroke follows" in done.stdout
    assert "derivatives-history.csv" in done.stdout
    assert "bends.0.stroke" in Path("results/sequence/derivatives.csv").read_text()


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--scatter", "height=2%"], "there is no number of this path"),
        (["--find", "strength"], "the bends of a file have angles and strokes of their own"),
        (["--want", "angle=90"], "a wanted result needs a parameter that follows"),
        (["--angles", "90,120"], "the bends of a file have angles and strokes of their own"),
    ],
)
def test_studies_that_a_part_refuses_before_the_run(one_bend, more, said):
    done = CliRunner().invoke(app, [*one_bend, *more])
    assert done.exit_code == 1
    assert said in done.stderr
    assert not Path("results").exists()


def test_slopes_of_a_hem_that_jumps_are_refused_before_the_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["hem", "--form", "rope", "--derive", "gap"])
    assert done.exit_code == 1
    assert "a number that is zero has no range" in done.stderr
    assert not Path("results").exists()


@pytest.mark.parametrize(("form", "study"), [("rope", "slopes"), ("open", "derivatives")])
def test_hems_that_jump_have_slopes_and_others_derivatives(form, study, tmp_path, monkeypatch):
    """Which study `--derive` takes."""

    def end(*given, **named):
        raise InvalidValue(f"the {study}", where="here")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("umform.processes.hemming.hemming", lambda case: Mock(with_stroke=case))
    monkeypatch.setattr("umform.processes.hemming.files.write_files", lambda *given: [])
    monkeypatch.setattr(f"umform.studies.{study}.{study}", end)
    done = CliRunner().invoke(app, ["hem", "--form", form, "--derive", "thickness"])
    assert done.exit_code == 1
    assert f"the {study}" in done.stderr


def test_the_scatter_of_a_hem_is_refused_before_the_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["hem", "--form", "insert", "--scatter", "opening_angle=2%"])
    assert done.exit_code == 1
    assert "there is no number of this path" in done.stderr
    assert not Path("results").exists()


def test_a_hem_in_other_units_is_refused(tmp_path, monkeypatch):
    """Without the remedy of other commands: its --force is that of the plate."""
    monkeypatch.chdir(tmp_path)
    words = ["--young", "210", "--poisson", "0.3", "--curve", "Swift,520,0.004,0.22"]
    done = CliRunner().invoke(app, ["hem", *words])
    assert done.exit_code == 1
    assert "E of steel is 210e3" in done.stderr
    assert "--force" not in done.stderr
    assert not Path("results").exists()
