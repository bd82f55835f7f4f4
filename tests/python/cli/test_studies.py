"""Numbers of several meshes, and studies of one."""

import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.cli.scattering import ScatterOptions
from umform.cli.studies import Studies
from umform.errors import InvalidValue


def test_studies_are_those_of_one_mesh():
    none = ScatterOptions({})
    assert Studies(None, None, None, none).extrapolates(None)
    assert not Studies(None, None, None, none).extrapolates(None, usual=False)
    assert Studies(None, None, None, none).extrapolates(True, usual=False)
    assert not Studies(["theta1=98+-1"], ["angle"], None, none).extrapolates(None)
    assert not Studies(None, None, ["thickness"], none).extrapolates(False)
    with pytest.raises(InvalidValue, match="no goals, derivatives or scatter"):
        Studies(None, None, None, ScatterOptions({"sources": ["thickness=1%"]})).extrapolates(True)


@pytest.mark.parametrize("command", [["bead", "--radius", "4", "--height", "3"], ["draw", "u", "--coarse"]])
def test_an_extrapolation_beside_a_study_is_refused_before_the_run(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, [*command, "--extrapolate", "--scatter", "friction=0.01"])
    assert done.exit_code == 1
    assert "--extrapolate" in done.stderr and "--scatter" in done.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", [["bead"], ["draw", "u"], ["draw", "cup"], ["bend", "--stroke", "6"]])
def test_a_deck_is_printed_without_studies_of_a_run(command):
    for study in (["--scatter", "thickness=1%"], ["--derive", "thickness"]):
        done = CliRunner().invoke(app, [*command, "--print-deck", *study])
        assert done.exit_code == 1
        assert study[0] in done.output and "`umform derive` and `umform sigma` take the deck" in done.output
