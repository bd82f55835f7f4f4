"""What `umform bend` with bottoming or a sequence, and `umform hem`, refuse before anything runs."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.errors import InvalidValue

PRESS = ["--bottoming", "--die-angle", "88", "--punch-angle", "88"]


@pytest.mark.parametrize(
    ("typed", "message"),
    [
        (["bend", "--angle", "90", "--force-per-metre", "400"], "one of bottoming"),
        (["bend", *PRESS], "one of them"),
        (["bend", *PRESS, "--force-per-metre", "400", "--travel", "0"], "one of them"),
        (["bend", *PRESS, "--force-per-metre", "400", "--angle", "90"], "no search for an angle"),
        (["bend", *PRESS, "--force-per-metre", "400", "--budget"], "no budget"),
        (["bend", *PRESS, "--travel", "2"], "more than half of its thickness"),
        (["bend", "--bottoming", "--force-per-metre", "400", "--punch-angle", "88"], "of a sharper die"),
        (["bend", "--sequence", "no.toml"], "cannot be read"),
        (["bend", "--sequence", "no.toml", "--stroke", "3"], "of their own"),
        (["bend", "--sequence", "no.toml", "--budget"], "of their own"),
        (["hem", "--gap", "0"], "must be positive"),
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


@pytest.mark.parametrize("thickness", [1.0, 3.0])
def test_sizes_of_a_hem_follow_the_thickness(thickness, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = []

    def end(case):
        found.append(case)
        raise InvalidValue("no run")

    monkeypatch.setattr("umform.processes.hemming.hemming", end)
    CliRunner().invoke(app, ["hem", "--thickness", str(thickness)])
    (case,) = found
    sheet = case.sheet
    sizes = [sheet.opening, sheet.die_radius, sheet.punch_radius, case.gap, case.flange, case.base]
    assert sizes == [size * thickness for size in (8.0, 1.0, 0.5, 1.0, 12.0, 30.0)]
