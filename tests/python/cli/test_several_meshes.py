"""Numbers of several meshes, and studies of one."""

import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.cli.several_meshes import extrapolates
from umform.errors import InvalidValue


def test_studies_are_those_of_one_mesh():
    assert extrapolates(None, None, None, ())
    assert not extrapolates(None, None, None, (), usual=False)
    assert extrapolates(True, None, None, (), usual=False)
    assert not extrapolates(None, ["theta1=98+-1"], None, ())
    assert not extrapolates(False, None, ["thickness"], ())
    with pytest.raises(InvalidValue, match="no goals, derivatives or scatter"):
        extrapolates(True, None, None, ["thickness=1%"])


@pytest.mark.parametrize("command", [["bead", "--radius", "4", "--height", "3"], ["draw", "u", "--coarse"]])
def test_an_extrapolation_beside_a_study_is_refused_before_the_run(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, [*command, "--extrapolate", "--scatter", "friction=0.01"])
    assert done.exit_code == 1
    assert "--extrapolate" in done.stderr and "--scatter" in done.stderr
    assert not list(tmp_path.iterdir())
