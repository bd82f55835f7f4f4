"""Ctrl-C, SIGTERM and kill at any time: messages do not contradict each other, and no hidden files stay behind."""

from __future__ import annotations

import csv
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from command_line import umform

from umform import cli
from umform.analysis.newton.newton import Newton
from umform.analysis.run import run_steps
from umform.analysis.run.open_run import OpenRun
from umform.analysis.steps import Free, Move
from umform.problem.templates import write_template
from umform.processes.air_bending.brake import Brake
from umform.processes.bend_sequence import run as sequence_run
from umform.processes.early_end import what_was_reached

SOURCE = Path(cli.__file__).parents[2]
pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals")
SHORT = ["--set", "steps.0.increments=300", "--set", "output.report=false", "--set", "output.pictures=false"]


def started(*words, code=""):
    """The real command line in a process of its own; after some code if there is any."""
    environment = os.environ | {"PYTHONPATH": str(SOURCE), "OMP_NUM_THREADS": "1"}
    start = ["-c", f"{code}\nfrom umform.cli import main; main()"] if code else ["-m", "umform"]
    command = [sys.executable, *start, *map(str, words)]
    pipes = {"stderr": subprocess.PIPE, "stdout": subprocess.DEVNULL}
    return subprocess.Popen(command, text=True, env=environment, **pipes)


def line_with(run, text):
    """Read what a process says up to a text."""
    for line in run.stderr:
        if text in line:
            return
    raise AssertionError(f"{text} was not said")


@pytest.fixture
def deck(tmp_path):
    write_template("free-bending", tmp_path / "deck.toml")
    return tmp_path / "deck.toml"


def test_sigterm_ends_a_run_as_ctrl_c_does(deck, tmp_path):
    run = started("run", deck, "--out", tmp_path / "out", "-v", *SHORT)
    line_with(run, "step 1  time 0.0")
    run.terminate()
    _, said = run.communicate(timeout=60)
    assert run.returncode == cli.INTERRUPTED, said
    assert "interrupted; the results so far are written" in said
    assert "given up" not in said
    assert f"go on with: umform resume {tmp_path / 'out' / 'checkpoint.h5'}" in said
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {"history.csv", "fields.vtkhdf", "as-run.toml", "checkpoint.h5"}


def test_sigterm_ends_a_demo_with_its_processes_and_leaves_nothing(tmp_path):
    run = started("demo", "free-bending", "--out", tmp_path / "out", "--processes", 2)
    for _ in range(600):
        if list(tmp_path.glob("out/.umform-*")):
            break
        time.sleep(0.05)
    time.sleep(2.0)
    run.terminate()
    _, said = run.communicate(timeout=20)  # ends when no process holds the pipe any more
    assert run.returncode == cli.INTERRUPTED
    assert "interrupted" in said
    assert "Traceback" not in said
    assert not (tmp_path / "out").exists()


def test_what_a_killed_run_has_left_is_removed_by_the_next_one(deck, tmp_path):
    out = tmp_path / "out"
    run = started("run", deck, "--out", out, "-v", *SHORT)
    line_with(run, "step 1  time 0.0")
    run.kill()
    run.communicate()
    assert [path.name for path in out.iterdir()] == [".umform-run"]
    half = out / f".checkpoint.{(out / '.umform-run' / 'owner').read_text()}.00ff00ff.h5"
    half.touch()  # killed while it wrote a checkpoint
    less = ["--set", "steps.0.increments=30", "--set", "steps.0.to.punch=-0.5"]
    answer = umform("run", deck, "--out", out, *SHORT, *less)
    assert answer.exit_code == 0, answer.output
    assert {path.name for path in out.iterdir()} == {"history.csv", "fields.vtkhdf", "as-run.toml"}


def test_two_runs_do_not_write_to_one_folder(deck, tmp_path):
    out = tmp_path / "out"
    run = started("run", deck, "--out", out, "-v", *SHORT)
    try:
        line_with(run, "step 1  time 0.0")
        second = umform("run", deck, "--out", out, *SHORT)
        assert second.exit_code == 1
        assert "another run is writing to this folder" in second.stderr
        assert f"process {run.pid} on" in second.stderr
        assert umform("bend", "--stroke", "1", "--out", out).exit_code == 1
        assert (out / ".umform-run").is_dir()
    finally:
        run.kill()
        run.communicate()


SLOW_IMPORT = """
import os, signal, sys, threading
class Slow:
    def find_spec(self, name, path, target=None):
        if name == {name!r}:
            os.kill(os.getpid(), signal.{signal})
            import time; time.sleep(10)
sys.meta_path.insert(0, Slow())
"""


@pytest.mark.parametrize("name", ["typer", "umform.cli.check", "umform.problem", "numpy"])
@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM"])
def test_a_signal_during_the_imports_is_one_line(name, number, deck):
    run = started("check", deck, code=SLOW_IMPORT.format(name=name, signal=number))
    _, said = run.communicate(timeout=30)
    assert run.returncode == cli.INTERRUPTED
    assert said.startswith("umform: interrupted")
    assert len(said.splitlines()) == 1


BEND = ["--stroke", "1.2", "--increment", "0.0125", "--elements-per-thickness", "1", "--layers", "1"]


def table_interrupted_by(error, monkeypatch, tmp_path):
    unload, calls = Brake.unload, []

    def interrupted(self):
        calls.append(1)
        if len(calls) == 3:
            raise error
        return unload(self)

    monkeypatch.setattr(Brake, "unload", interrupted)
    typed = ["--material", "DC04", "--table", "0.4:1.2:0.2", "--out", tmp_path / "out"]
    return umform("bend", *BEND, *typed)


def test_ctrl_c_keeps_the_rows_of_a_bending_table(monkeypatch, tmp_path):
    run = table_interrupted_by(KeyboardInterrupt(), monkeypatch, tmp_path)
    assert run.exit_code == cli.INTERRUPTED
    assert run.stderr.count("umform: ") - run.stderr.count("umform: warning") == 1
    assert f"results so far are in {tmp_path / 'out'}: table.csv" in run.stderr
    with (tmp_path / "out" / "table.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["stroke mm"]) for row in rows] == pytest.approx([0.4, 0.6])


def test_ctrl_c_in_the_budget_keeps_the_bend(monkeypatch, tmp_path):
    def interrupted(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr("umform.processes.air_bending.budget.error_budget", interrupted)
    run = umform("bend", *BEND, "--budget", "--out", tmp_path / "out")
    assert run.exit_code == cli.INTERRUPTED
    assert "all but the budget" in run.stderr
    assert {"bend.json", "curve.csv", "report.html"} <= {path.name for path in (tmp_path / "out").iterdir()}
    assert not list((tmp_path / "out").glob(".*"))


@pytest.mark.parametrize(
    ("words", "states"),
    [
        (["hem", "--thickness", "1"], "hem.vtkhdf"),
        (["draw", "cup", "--coarse"], "draw.vtkhdf"),
        (["draw", "u", "--coarse"], "draw.vtkhdf"),
        (["bead", "--no-extrapolate"], "bead.vtkhdf"),
        (["bend", "--sequence", "part.toml"], "part.vtkhdf"),
    ],
)
@pytest.mark.usefixtures("stopped")
def test_ctrl_c_keeps_what_an_operation_has_reached(words, states, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    Path("part.toml").write_text("length = 60.0\n[[bends]]\nposition = 20.0\nangle = 120.0\n")
    place = tmp_path / "out"
    run = umform(*words, "--material", "DC04", "--out", place)
    assert run.exit_code == cli.INTERRUPTED
    assert f"results so far are in {place}: history.csv, {states}" in run.stderr
    assert len((place / "history.csv").read_text().splitlines()) > 2 and (place / states).is_file()
    assert umform(*words, "--material", "DC04", "--out", place).exit_code == 1  # they are not overwritten


def interrupted_in(kind, monkeypatch):
    """Ctrl-C in the second increment of the first run of a step of a kind."""
    finish, solve, calls = run_steps._finish, Newton.solve, []

    def noted(run, step):
        calls.extend([0] * (not calls and isinstance(step, kind)))
        return finish(run, step)

    def interrupted(self, *arguments, **options):
        calls.extend([1] * bool(calls))
        if len(calls) == 3:
            raise KeyboardInterrupt
        return solve(self, *arguments, **options)

    monkeypatch.setattr(run_steps, "_finish", noted)
    monkeypatch.setattr(Newton, "solve", interrupted)


def test_ctrl_c_while_the_tools_open_keeps_the_drawing(monkeypatch, tmp_path):
    interrupted_in(Free, monkeypatch)
    run = umform("draw", "u", "--coarse", "--stroke", 3, "--material", "DC04", "--out", tmp_path)
    assert run.exit_code == cli.INTERRUPTED
    with (tmp_path / "history.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert float(rows[0]["stroke"]) == 0.0 and float(rows[-1]["stroke"]) == pytest.approx(3.0)


def test_ctrl_c_in_a_second_bend_keeps_the_first_one(monkeypatch, tmp_path):
    bent = sequence_run._bent

    def second_is_interrupted(sequence, number, *others):
        if number == 1:
            interrupted_in(Move, monkeypatch)
        return bent(sequence, number, *others)

    monkeypatch.setattr(sequence_run, "_bent", second_is_interrupted)
    bends = "[[bends]]\nposition = 20.0\nstroke = 1.0\n[[bends]]\nposition = 40.0\nstroke = 2.0\n"
    (tmp_path / "part.toml").write_text(f"length = 60.0\n{bends}")
    typed = ["bend", "--sequence", tmp_path / "part.toml", "--material", "DC04", "--out", tmp_path / "out"]
    run = umform(*typed)
    assert run.exit_code == cli.INTERRUPTED and "in bend 2 of 2" in run.stderr
    assert f"results so far are in {tmp_path / 'out'}: bend1.csv, history.csv, part.vtkhdf" in run.stderr
    with (tmp_path / "out" / "bend1.csv").open() as file:
        assert max(float(row["stroke"]) for row in csv.DictReader(file)) == pytest.approx(1.0)


def test_ctrl_c_while_a_hem_is_flattened_keeps_its_first_bend(monkeypatch, tmp_path):
    class Interrupted(OpenRun):
        def take(self, *steps, **options):
            raise KeyboardInterrupt

    monkeypatch.setattr("umform.processes.hemming.run.OpenRun", Interrupted)
    run = umform("hem", "--thickness", 1, "--material", "DC04", "--out", tmp_path)
    assert run.exit_code == cli.INTERRUPTED
    assert f"results so far are in {tmp_path}: bend1.csv" in run.stderr and (tmp_path / "bend1.csv").is_file()


def test_a_whole_run_leaves_no_history_of_one_that_was_stopped(tmp_path):
    old = [tmp_path / name for name in ("history.csv", "bend1.csv")]
    other = tmp_path / "bends.csv"
    for path in (*old, other):
        path.write_text("half")
    with pytest.raises(KeyboardInterrupt), what_was_reached(tmp_path, "bend.vtkhdf"):
        raise KeyboardInterrupt
    assert all(path.exists() for path in old)
    with what_was_reached(tmp_path, "bend.vtkhdf"):
        pass
    assert list(tmp_path.iterdir()) == [other]


def test_a_handler_of_the_program_is_left_alone():
    """Our handler is removed after the block; one that a program has set is kept."""
    from umform.analysis.run.interrupt import gentle_interrupt

    before = signal.getsignal(signal.SIGTERM)
    with gentle_interrupt() as stop:
        signal.raise_signal(signal.SIGTERM)
        assert stop.asked
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGTERM) is before

    def own(number, frame):
        pass

    signal.signal(signal.SIGTERM, own)
    try:
        with gentle_interrupt() as stop:
            signal.raise_signal(signal.SIGTERM)
            assert not stop.asked
        assert signal.getsignal(signal.SIGTERM) is own
    finally:
        signal.signal(signal.SIGTERM, before)
