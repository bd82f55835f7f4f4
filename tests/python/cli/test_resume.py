"""umform resume: runs that were killed or stopped go on to the same bits, from the checkpoint alone."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
from command_line import umform

from umform import cli
from umform.analysis.newton.newton import Newton
from umform.analysis.run import solve
from umform.analysis.run.checkpoint import read_checkpoint
from umform.analysis.steps import Move
from umform.errors import FileProblem
from umform.problem.templates import write_template

SOURCE = Path(cli.__file__).parents[2]
#: Contact, plasticity and a release, in some seconds.
SHORT = ["--set", "steps.0.increments=60", "--set", "steps.0.to.punch=-3.0", "--set", "output.report=false"]
SHORT += ["--set", "output.pictures=false"]


def started(*words):
    """The real command line in a process of its own."""
    environment = os.environ | {"PYTHONPATH": str(SOURCE), "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "umform", *map(str, words)]
    return subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, env=environment)


def waited_for(run, condition):
    """Wait until something has happened while the process runs."""
    for _ in range(6000):
        if condition():
            return
        assert run.poll() is None, run.stderr.read()
        time.sleep(0.01)
    raise AssertionError("nothing has happened in a minute")


def last_displacement(folder):
    with h5py.File(folder / "fields.vtkhdf") as file:
        points = len(file["VTKHDF/Points"])
        return file["VTKHDF/PointData/displacement"][-points:]


def assert_the_same(folder, other):
    assert (folder / "history.csv").read_bytes() == (other / "history.csv").read_bytes()
    assert np.array_equal(last_displacement(folder), last_displacement(other))
    assert (folder / "as-run.toml").read_bytes() == (other / "as-run.toml").read_bytes()


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """A deck, and the folder of its run from beginning to end."""
    folder = tmp_path_factory.mktemp("undisturbed")
    write_template("free-bending", folder / "deck.toml")
    run = started("run", folder / "deck.toml", "--out", folder / "out", *SHORT)
    assert run.wait(120) == 0, run.stderr.read()
    run.stderr.close()
    assert {path.name for path in (folder / "out").iterdir()} == {"history.csv", "fields.vtkhdf", "as-run.toml"}
    return folder


def rows(path):
    """Rows of the history in a checkpoint."""
    try:
        return len(read_checkpoint(path)["result"]["history"][0])
    except FileProblem:
        return 0


def test_a_run_that_is_killed_goes_on_to_the_same_bits(undisturbed, tmp_path):
    kept = tmp_path / "out" / "checkpoint.h5"
    run = started("run", undisturbed / "deck.toml", "--out", tmp_path / "out", "--every", 0, *SHORT)
    try:
        waited_for(run, lambda: rows(kept) > 20)
    finally:
        run.kill()
        run.wait()
        run.stderr.close()
    assert not (tmp_path / "out" / "history.csv").exists()
    assert rows(kept) < 60
    going_on = started("resume", kept)
    assert going_on.wait(120) == 0, going_on.stderr.read()
    going_on.stderr.close()
    assert_the_same(tmp_path / "out", undisturbed / "out")
    assert not kept.exists()


def test_ctrl_c_ends_after_the_increment_with_whole_files_and_says_how_to_go_on(undisturbed, tmp_path):
    out, kept = tmp_path / "out", tmp_path / "a run.h5"
    run = started("run", undisturbed / "deck.toml", "--out", out, "--checkpoint", kept, "-v", *SHORT)
    try:
        for line in run.stderr:
            if "step 1  time 0.1" in line:  # well on its way
                break
        run.send_signal(signal.SIGINT)
        said = run.stderr.read()
        assert run.wait(60) == 130, said
    finally:
        run.kill()
        run.stderr.close()
    assert "the results so far are written" in said
    assert f"go on with: umform resume '{kept}'" in said
    assert {path.name for path in out.iterdir()} == {"history.csv", "fields.vtkhdf", "as-run.toml"}
    reached = (out / "history.csv").read_text().splitlines()
    whole = (undisturbed / "out" / "history.csv").read_text().splitlines()
    assert 2 < len(reached) < len(whole)
    assert reached == whole[: len(reached)]
    answer = umform("resume", kept)
    assert answer.exit_code == 0, answer.output
    assert_the_same(out, undisturbed / "out")
    assert kept.exists()  # somebody has asked for it


@pytest.fixture
def stopped(tmp_path, monkeypatch):
    """A run of a deck with a mesh file, stopped after three increments; its checkpoint."""
    folder = tmp_path / "here"
    folder.mkdir()
    write_template("own-mesh", folder / "deck.toml")
    changes = ["--set", "steps.0.increments=6", "--set", "output.report=false", "--set", "output.pictures=false"]
    whole, calls = Newton.solve, []

    def interrupted(self, *args, **how):
        calls.append(1)
        if len(calls) == 4:
            signal.raise_signal(signal.SIGINT)
        return whole(self, *args, **how)

    with monkeypatch.context() as patch:
        patch.setattr(Newton, "solve", interrupted)
        answer = umform("run", folder / "deck.toml", "--out", folder / "results", *changes)
    assert answer.exit_code == 130, answer.output
    assert f"go on with: umform resume {folder / 'results' / 'checkpoint.h5'}" in answer.output
    return folder / "results" / "checkpoint.h5"


def test_a_run_that_begins_anew_writes_over_a_checkpoint_only_if_that_is_asked_for(stopped, caplog):
    words = ["run", stopped.parents[1] / "deck.toml", "--out", stopped.parent, "--set", "steps.0.increments=6"]
    refused = umform(*words)
    assert refused.exit_code == 1
    assert "the folder holds the results of another run" in refused.output
    assert f"umform resume {stopped} goes on with that run" in refused.output
    assert stopped.exists()
    answer = umform(*words, "--overwrite")
    assert answer.exit_code == 0, answer.output
    assert f"{stopped} will be overwritten; umform resume would continue it" in caplog.text
    assert not stopped.exists()


def test_the_mesh_file_is_found_again_also_where_all_has_moved(stopped, tmp_path, monkeypatch):
    shutil.copytree(tmp_path / "here", tmp_path / "copy")
    monkeypatch.chdir(tmp_path / "here" / "results")
    answer = umform("resume", "checkpoint.h5")
    assert answer.exit_code == 0, answer.output
    shutil.move(tmp_path / "here", tmp_path / "kept")
    monkeypatch.chdir(tmp_path)
    answer = umform("resume", "copy/results/checkpoint.h5")
    assert answer.exit_code == 0, answer.output
    assert_the_same(tmp_path / "copy" / "results", tmp_path / "kept" / "results")


def test_a_mesh_that_has_changed_or_is_gone_is_one_message(stopped):
    mesh = next(stopped.parents[1].glob("*.inp"))
    assert "2, 0.0000, 0.0000, 0.5000" in mesh.read_text()
    mesh.write_text(mesh.read_text().replace("2, 0.0000, 0.0000, 0.5000", "2, 0.0000, 0.0000, 0.500001"))
    answer = umform("resume", stopped)
    assert answer.exit_code == 1
    assert "belongs to another run" in answer.output
    assert "value:  different: mesh" in answer.output
    assert answer.output.count("remedy:") == 1
    mesh.unlink()
    answer = umform("resume", stopped)
    assert answer.exit_code == 1
    assert "mesh file cannot be read" in answer.output
    assert answer.output.count("remedy:") == 1
    assert stopped.exists()


def test_what_is_no_checkpoint_of_a_deck_is_one_message(tmp_path, build):
    model, end = build.bar()
    solve(model, Move(end, 0.01, steps=1), checkpoint=tmp_path / "python.h5", progress=False)
    (tmp_path / "text.h5").write_text("no HDF5")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["something"] = 1.0
    for name, said in {
        "missing.h5": "there is no checkpoint of umform of this name",
        "text.h5": "the checkpoint of umform is damaged",
        "other.h5": "this is not a checkpoint of umform",
        "python.h5": "the checkpoint has no deck",
    }.items():
        answer = umform("resume", tmp_path / name)
        assert answer.exit_code == 1
        assert said in answer.output
        assert answer.output.count("remedy:") == 1
        assert "Traceback" not in answer.output


def test_the_folder_of_a_run_stands_for_its_checkpoint(tmp_path):
    for name, said in ((None, "this folder has no checkpoint.h5"), ("state.h5", "the run in this folder is finished")):
        if name:
            (tmp_path / name).touch()
        answer = umform("resume", tmp_path)
        assert answer.exit_code == 1
        assert said in answer.output
        assert "cause:" in answer.output
    (tmp_path / "checkpoint.h5").write_text("no HDF5")
    answer = umform("resume", tmp_path)
    assert f"where:  {tmp_path / 'checkpoint.h5'}" in answer.output
    assert "Errno" not in answer.output
    assert "0x" not in answer.output


def test_a_checkpoint_that_cannot_be_written_is_refused_before_the_run(stopped, tmp_path):
    answer = umform("run", stopped.parents[1] / "deck.toml", "--checkpoint", tmp_path / "no" / "folder" / "c.h5")
    assert answer.exit_code == 1
    assert "c.h5" in answer.output
    answer = umform("run", stopped.parents[1] / "deck.toml", "--every", "-1", "--out", tmp_path / "out")
    assert answer.exit_code == 1
    assert "where:  every" in answer.output


def test_ctrl_c_ends_a_bend_after_the_increment_with_what_was_reached(tmp_path):
    run = started("bend", "--stroke", 6, "--out", tmp_path, "-v")
    try:
        for line in run.stderr:
            if "step 2  time 1.2" in line:  # well on its way
                break
        run.send_signal(signal.SIGINT)
        said = run.stderr.read()
    finally:
        run.kill()
        run.stderr.close()
    assert run.wait() == 130
    assert "results so far are in" in said
    assert "Traceback" not in said
    assert len((tmp_path / "history.csv").read_text().splitlines()) > 5
    with h5py.File(tmp_path / "bend.vtkhdf") as file:
        assert file["VTKHDF/Steps"].attrs["NSteps"] >= 2


# Twenty kills ---------------------------------------------------------------------------------------------

#: A strip that a punch draws over the radius of a die, under a holder closed by its force; then all tools open.
DECK = """
[mesh]
generator = "strip"
length = 40.0
width = 1.0
thickness = 1.0
cells = [20, 1]
[element]
name = "BEND8"
[material]
law = "J2"
E = 70e3
nu = 0.33
hardening = { curve = "Voce", yield_stress = 126.0, saturation = 315.0, rate = 12.0 }
[tools.die]
shape = "UDie"
opening = 26.0
depth = 60.0
shoulder_radius = 5.0
bottom_radius = 5.0
origin = [0.0, 0.0, -0.5]
[tools.holder]
shape = "Plane"
point = [0.0, 0.0, 0.6]
normal = "-z"
[tools.punch]
shape = "Box"
centre = [0.0, 0.0, 50.5]
size = [23.0, 100.0, 100.0]
radius = 5.0
"""
STEPS = """
[[supports]]
kind = "symmetry"
nodes = "x0"
normal = "x"
[[supports]]
kind = "symmetry"
nodes = "y0"
normal = "y"
[[supports]]
kind = "symmetry"
nodes = "y1"
normal = "y"
[controls.hold]
kind = "press"
contact = "holder"
direction = "-z"
[controls.stroke]
kind = "tool"
contact = "punch"
direction = "-z"
[[steps]]
kind = "close"
control = "hold"
force = 10.0
[[steps]]
kind = "move"
to = { stroke = 6.0 }
increments = 100
[output]
report = false
pictures = false
"""
KILLS = 20


def contacts():
    """Friction on all three tools."""
    common = "friction = 0.1\npoints = 3\npenalty = 300.0\n"
    return "".join(
        f'[contacts.{name}]\ntool = "{name}"\nfaces = "{faces}"\n{common}'
        for name, faces in (("die", "lower"), ("holder", "upper"), ("punch", "upper"))
    )


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """A deck, and the folder of its run from beginning to end."""
    folder = tmp_path_factory.mktemp("undisturbed")
    (folder / "deck.toml").write_text(DECK + contacts() + STEPS, encoding="utf-8")
    finish(started("run", folder / "deck.toml", "--out", folder / "out", "--every", 0))
    return folder


def written(path):
    """When a checkpoint was written last."""
    return path.stat().st_mtime_ns if path.exists() else 0


def finish(run):
    """Wait for the end of a run that nobody kills."""
    assert run.wait(120) == 0, run.stderr.read()
    run.stderr.close()


@pytest.mark.long
def test_a_draw_with_friction_that_is_killed_twenty_times_comes_to_the_same_bits(drawn, tmp_path):
    kept, seeds = tmp_path / "out" / "checkpoint.h5", random.Random(20)
    for kill in range(KILLS):
        command = ("run", drawn / "deck.toml", "--out", tmp_path / "out", "--every", 0)
        run = started(*command) if kill == 0 else started("resume", kept, "--every", 0)
        try:
            for _ in range(seeds.randint(1, 4)):
                before = written(kept)
                waited_for(run, lambda before=before: written(kept) != before)
            time.sleep(seeds.uniform(0.0, 0.03))  # anywhere in an increment or in a checkpoint
        finally:
            run.kill()
            run.wait()
            run.stderr.close()
    assert not (tmp_path / "out" / "history.csv").exists()
    finish(started("resume", kept))
    assert_the_same(tmp_path / "out", drawn / "out")
