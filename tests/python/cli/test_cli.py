import json
import os
import signal
import subprocess
import sys
import time

import pytest
from typer.testing import CliRunner

import umform
from umform import cli
from umform.errors import InvalidValue
from umform.processes.bending import showcase

RUN = ["--mesh", "24x1", "--contact", "2", "--steps", "30", "--stroke", "2", "--no-unload"]


def umform_cli(*arguments):
    return CliRunner().invoke(cli.app, [str(argument) for argument in arguments])


def test_version_without_loading_numpy():
    code = (
        "import sys; from umform.cli import main; sys.argv = ['umform', '--version']\n"
        "try: main()\nexcept SystemExit: print('numpy' in sys.modules, 'rich' in sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["umform", umform.__version__, "False", "False"]


def test_elements_are_listed():
    run = umform_cli("elements")
    assert run.exit_code == 0
    for name in ("DISP3D", "ANS3DEAS", "MI9K3DEAS"):
        assert name in run.stdout


def test_a_restricted_run_gives_the_force_of_the_reference(tmp_path):
    run = umform_cli("demo", "free-bending", "--out", tmp_path, *RUN)
    assert run.exit_code == 0, run.output
    assert "ANS3DEAS 24x1 2x2" in run.stdout
    assert "reconstruction" in run.stdout
    record = json.loads((tmp_path / "free_bending.json").read_text())
    assert [row["run"] for row in record["runs"]] == ["ANS3DEAS 24x1 2x2"]
    assert record["runs"][0]["F_2"] == pytest.approx(18.793, rel=2e-3)


@pytest.mark.parametrize(
    ("options", "exit_code", "message"),
    [
        (["--element", "FOO"], 1, "unknown element"),
        (["--penalty", "-1", "--mesh", "24x1"], 1, "penalty must be positive"),
        (["--thickness-order", "3", "--thickness-points", "3", "--contact", "2"], 1, "needs at least 4"),
        (["--mesh", "24"], 2, "24x1"),
        (["--contact", "2x3"], 2, "nodes"),
        (["--steps", "many"], 2, "Usage"),
        (["--nonsense"], 2, "nonsense"),
    ],
)
def test_errors_are_messages(options, exit_code, message, tmp_path):
    run = umform_cli("demo", "free-bending", "--out", tmp_path, "--processes", 1, *options)
    assert run.exit_code == exit_code
    assert message in run.stderr
    assert "Traceback" not in run.output


def test_errors_in_other_processes_are_messages_too(tmp_path):
    run = umform_cli("demo", "free-bending", "--out", tmp_path, "--processes", 2, "--yield-stress", "-1")
    assert run.exit_code == 1
    assert "yield" in run.stderr
    assert "Traceback" not in run.output


def broken(*arguments, **options):
    raise ZeroDivisionError("a bug")


def refused(*arguments, **options):
    raise InvalidValue("refused", where="here")


@pytest.mark.parametrize(("place", "shown"), [("before", True), ("after", True), ("nowhere", False)])
@pytest.mark.parametrize("failure", [broken, refused])
def test_tracebacks_only_when_asked_for(failure, place, shown, monkeypatch, tmp_path):
    monkeypatch.setattr(showcase, "demo", failure)
    before, after = ["--debug"] * (place == "before"), ["--debug"] * (place == "after")
    run = umform_cli(*before, "demo", "free-bending", *after)
    assert run.exit_code == 1
    assert ("Traceback" in run.stderr) == shown
    if failure is broken:
        assert "ZeroDivisionError: a bug" in run.stderr
        assert "--debug" in run.stderr
    else:
        assert "refused" in run.stderr
        assert "where:  here" in run.stderr


def test_interrupt_of_a_command(monkeypatch):
    def interrupted(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(showcase, "demo", interrupted)
    run = umform_cli("demo", "free-bending")
    assert run.exit_code == 130
    assert "interrupted" in run.stderr


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_ends_all_processes(tmp_path):
    command = [sys.executable, "-m", "umform.cli", "demo", "free-bending", "--out", tmp_path, "--processes", "2"]
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True, text=True
    )
    time.sleep(3.0)
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=20)  # ends when no process holds the pipes any more
    assert process.returncode == 130
    assert "interrupted" in errors
    assert "Traceback" not in errors


def test_log_of_increments(tmp_path):
    command = [sys.executable, "-m", "umform.cli", "-v", "demo", "free-bending", "--out", tmp_path, *RUN]
    run = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=True)
    assert "step 1  time" in run.stderr
    assert "umform.newton" not in run.stdout
