"""Goals of `umform bend`, and the folder of a run."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from umform.cli import app


def test_a_table_alone_ends_at_its_last_stroke(tmp_path):
    fast = ["--layers", "1", "--elements-per-thickness", "1", "--increment", "0.05"]
    done = CliRunner().invoke(app, ["bend", "--table", "0.4:0.8:0.4", *fast, "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert json.loads((tmp_path / "bend.json").read_text())["measures"]["stroke"] == 0.8
    assert len((tmp_path / "table.csv").read_text().splitlines()) == 3


@pytest.mark.parametrize(
    "refused",
    [
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
