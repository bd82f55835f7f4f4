"""Folders of results: one run at a time, none over the results of another one, and nothing hidden left behind."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

from umform.errors import FileProblem, InvalidValue
from umform.io import staging as staging_module
from umform.io.atomic import PendingFile, remove_left_behind
from umform.io.folders import folder_for
from umform.io.owner import is_left_behind, mark, pid_of
from umform.io.staging import WAITING, is_taken, staging

NAMES = ("history.csv", "checkpoint.h5")


def never(message):
    pytest.fail(message)


@pytest.fixture
def dead():
    """The mark of a process of this machine that has ended."""
    done = subprocess.Popen([sys.executable, "-c", ""])
    done.wait()
    return f"{mark().rpartition('-')[0]}-{done.pid}"


@pytest.fixture
def other():
    """The mark of a process that runs."""
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as running:
        yield f"{mark().rpartition('-')[0]}-{running.pid}"


def held_by(owner, folder):
    (folder / WAITING).mkdir(parents=True)
    (folder / WAITING / "owner").write_text(owner)
    (folder / WAITING / "half.csv").touch()
    return folder


def test_a_folder_that_is_free_is_taken_as_it_is(tmp_path):
    assert folder_for(None, tmp_path / "a", NAMES, overwrite=False, say=never) == tmp_path / "a"
    assert folder_for(str(tmp_path), tmp_path / "a", NAMES, overwrite=False, say=never) == tmp_path


def test_a_default_folder_with_results_gets_a_number(tmp_path):
    said = []
    for name in ("run", "run-2"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "history.csv").touch()
    folder = folder_for(None, tmp_path / "run", NAMES, overwrite=False, say=said.append)
    assert folder == tmp_path / "run-3"
    assert len(said) == 1
    assert f"{tmp_path / 'run'} holds history.csv of 20" in said[0]
    assert f"writes to {folder}" in said[0]
    assert folder_for(None, tmp_path / "run", NAMES, overwrite=True, say=never) == tmp_path / "run"


def test_a_named_folder_with_results_is_refused(tmp_path):
    (tmp_path / "checkpoint.h5").touch()
    with pytest.raises(FileProblem, match="results of another run") as caught:
        folder_for(tmp_path, Path("x"), NAMES, overwrite=False, say=never)
    assert "--overwrite" in caught.value.remedy
    assert f"umform resume {tmp_path / 'checkpoint.h5'}" in caught.value.remedy
    assert folder_for(tmp_path, Path("x"), NAMES, overwrite=True, say=never) == tmp_path
    with pytest.raises(InvalidValue, match="no name"):
        folder_for("", Path("x"), NAMES, overwrite=True, say=never)


def test_other_files_are_no_results(tmp_path):
    (tmp_path / "notes.txt").touch()
    assert folder_for(tmp_path, Path("x"), NAMES, overwrite=False, say=never) == tmp_path


def test_one_run_at_a_time(tmp_path, other):
    folder = held_by(other, tmp_path / "a")
    said = []
    assert is_taken(folder)
    with pytest.raises(FileProblem, match="another run is writing") as caught, staging(folder, NAMES):
        pass
    assert str(pid_of(other)) in caught.value.value
    assert (folder / WAITING / "half.csv").exists()
    assert folder_for(None, folder, NAMES, overwrite=False, say=said.append) == tmp_path / "a-2"
    assert "has not ended" in said[0]


@pytest.mark.skipif(os.name != "posix", reason="numbers of processes")
def test_what_a_killed_run_has_left_goes(tmp_path, dead):
    folder = held_by(dead, tmp_path)
    assert not is_taken(folder)
    with staging(folder, NAMES) as stage:
        assert [path.name for path in stage.waiting.iterdir()] == ["owner"]
        assert is_left_behind(folder, dead)
    assert list(folder.iterdir()) == []


def test_a_run_before_with_the_number_of_this_process_has_ended(tmp_path):
    """In a container each run has the same one."""
    folder = held_by(mark(), tmp_path)
    assert not is_taken(folder)
    with staging(folder, NAMES):
        pass


def test_runs_of_other_machines_and_of_unknown_ones_are_left_alone(tmp_path):
    folder = held_by("elsewhere-1", tmp_path / "a")
    with pytest.raises(FileProblem, match="another run is writing"), staging(folder, NAMES):
        pass
    folder = held_by("", tmp_path / "b")  # it is just about to write down whose it is
    with pytest.raises(FileProblem, match="another run is writing"), staging(folder, NAMES):
        pass
    old = (folder / WAITING).stat().st_mtime - 3600.0
    os.utime(folder / WAITING, (old, old))
    with staging(folder, NAMES):
        pass


def test_a_folder_that_this_process_holds_has_room_within(tmp_path):
    with staging(tmp_path, NAMES) as outer:
        assert not is_taken(tmp_path)
        with staging(tmp_path, NAMES) as inner:
            (inner.waiting / "history.csv").write_text("inner")
            assert inner.commit(["history.csv"]) == [tmp_path / "history.csv"]
        assert outer.waiting.is_dir()
        assert inner.named == [tmp_path / "history.csv"]
    assert [path.name for path in tmp_path.iterdir()] == ["history.csv"]
    assert not staging_module._held


def test_a_folder_that_vanishes_is_made_again(tmp_path):
    with staging(tmp_path / "a", NAMES) as stage:
        assert not stage.make_again()
        (stage.waiting / "owner").unlink()
        stage.waiting.rmdir()
        (tmp_path / "a").rmdir()
        assert stage.make_again()
        (stage.waiting / "history.csv").touch()
        stage.commit(NAMES)
    assert [path.name for path in (tmp_path / "a").iterdir()] == ["history.csv"]


@pytest.mark.skipif(os.name != "posix", reason="numbers of processes")
def test_temporary_files_of_killed_processes_go_and_others_stay(tmp_path, dead, other):
    target = tmp_path / "run.h5"
    with PendingFile(target) as own:
        names = [f".run.{dead}.0a0b0c0d.h5", f".run.{other}.0a0b0c0d.h5", ".run.elsewhere-7.0a0b0c0d.h5", ".run.h5"]
        for name in (*names, f".runs.{dead}.0a0b0c0d.h5"):
            (tmp_path / name).touch()
        remove_left_behind(target)
        assert {path.name for path in tmp_path.iterdir()} == {*names[1:], f".runs.{dead}.0a0b0c0d.h5", own.name}
    remove_left_behind(tmp_path / "no" / "folder.h5")


def test_the_mark_of_a_process_fits_into_a_name(monkeypatch):
    monkeypatch.setattr(platform, "node", lambda: "a/b.c-d " + 80 * "x")
    assert "/" not in mark()
    assert len(mark()) < 40
    assert pid_of(mark()) == os.getpid()
