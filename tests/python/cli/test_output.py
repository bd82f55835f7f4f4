"""What a command says where its words or its files find no place: one message, what is kept, a code that is not 0."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from command_line import umform

from umform import cli
from umform.analysis.run import Result
from umform.io.tables import write_csv
from umform.problem.templates import write_template

SOURCE = Path(cli.__file__).parents[2]
FAST = ["--set", "steps.0.increments=4", "--set", "output.pictures=false", "--set", "output.report=false"]
full = pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")


def shell(line, folder):
    """Run umform, as ``$umform``, in a line of the shell."""
    environment = os.environ | {"PYTHONPATH": str(SOURCE), "umform": f"{sys.executable} -m umform"}
    return subprocess.run(["sh", "-c", line], cwd=folder, env=environment, capture_output=True, text=True, check=False)


@pytest.fixture
def deck(tmp_path):
    write_template("cantilever", tmp_path / "deck.toml")
    return tmp_path / "deck.toml"


def disk_full(*arguments, **options):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


# Standard output --------------------------------------------------------------------------------------------


@full
@pytest.mark.parametrize(("lead", "cause"), [(">/dev/full", "no space left"), (">&-", "closed")])
def test_a_run_whose_words_find_no_place_says_where_its_files_are(lead, cause, deck):
    run = shell(f"$umform run deck.toml --out out {' '.join(FAST)} {lead}", deck.parent)
    assert run.returncode == 1
    assert run.stderr.count("remedy:") == 1
    assert "standard output takes no text" in run.stderr
    assert cause in run.stderr
    assert "the files of the run are in out" in run.stderr
    assert "Traceback" not in run.stderr
    assert "Exception ignored" not in run.stderr
    assert {path.name for path in (deck.parent / "out").iterdir()} == {"history.csv", "fields.vtkhdf", "as-run.toml"}


@full
@pytest.mark.parametrize("lead", [">/dev/full", ">&-"])
@pytest.mark.parametrize("words", ["new cantilever", "new", "check deck.toml", "elements"])
def test_other_commands_too(words, lead, deck):
    run = shell(f"$umform {words} {lead}", deck.parent)
    assert run.returncode == 1
    assert "standard output takes no text" in run.stderr
    assert "Traceback" not in run.stderr
    assert "Exception ignored" not in run.stderr


def test_a_run_without_standard_error_is_a_run(deck):
    run = shell(f"$umform run deck.toml --out out {' '.join(FAST)} 2>&-", deck.parent)
    assert run.returncode == 0
    assert "Written to out" in run.stdout


# Files ------------------------------------------------------------------------------------------------------


def test_a_full_disk_names_the_checkpoint_and_resume_writes_the_files(deck, tmp_path, monkeypatch):
    out = tmp_path / "out"
    with monkeypatch.context() as patch:
        patch.setattr(Path, "write_text", disk_full)
        patch.setattr("umform.io.staging.mark", lambda: "")  # which is written as text too
        patch.setattr("umform.io.staging._prepare", lambda *_: made(out))
        run = umform("run", deck, "--out", out, *FAST)
    assert run.exit_code == 1
    assert "the disk is full" in run.stderr
    assert "nobody expected" not in run.stderr
    assert run.stderr.count("remedy:") == 1
    assert f"go on with: umform resume {out / 'checkpoint.h5'}" in run.stderr
    assert {path.name for path in out.iterdir()} == {"checkpoint.h5"}
    going_on = umform("resume", out / "checkpoint.h5")
    assert going_on.exit_code == 0, going_on.output
    assert {path.name for path in out.iterdir()} == {"history.csv", "fields.vtkhdf", "as-run.toml"}


def made(folder):
    (folder / ".umform-run").mkdir(parents=True)
    return folder / ".umform-run"


@pytest.mark.parametrize("writer", ["umform.report.page.write_report", "umform.analysis.run.Result.write"])
def test_what_was_written_before_the_disk_was_full_is_named(writer, deck, tmp_path, monkeypatch):
    monkeypatch.setattr(writer, disk_full)
    words = ["--set", "steps.0.increments=4", "--set", "output.pictures=false"]
    run = umform("run", deck, "--out", tmp_path / "out", *words)
    assert run.exit_code == 1
    assert "the disk is full" in run.stderr
    assert ("kept:   as-run.toml, history.csv, fields.vtkhdf in" in run.stderr) == ("report" in writer)
    assert f"go on with: umform resume {tmp_path / 'out' / 'checkpoint.h5'}" in run.stderr


def test_a_disk_that_is_full_from_the_first_checkpoint_on_keeps_nothing_and_says_so(deck, tmp_path, monkeypatch):
    monkeypatch.setattr(Path, "write_bytes", disk_full)
    monkeypatch.setattr(Result, "write", disk_full)
    run = umform("run", deck, "--out", tmp_path / "out", *FAST)
    assert run.exit_code == 1
    assert "nothing of this run could be kept" in run.stderr
    assert "umform resume" not in run.stderr
    assert not (tmp_path / "out").exists()


def test_a_folder_that_vanishes_during_the_run_is_made_again(deck, tmp_path, monkeypatch):
    add = Result.add

    def vanishing(self, *arguments, **options):
        add(self, *arguments, **options)
        shutil.rmtree(tmp_path / "out", ignore_errors=True)

    monkeypatch.setattr(Result, "add", vanishing)
    run = umform("run", deck, "--out", tmp_path / "out", *FAST)
    assert run.exit_code == 0, run.output
    assert "was removed during the run" in run.stderr
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"history.csv", "fields.vtkhdf", "as-run.toml"}


def test_a_folder_that_vanishes_and_cannot_be_made_again_names_the_checkpoint(deck, tmp_path, monkeypatch):
    add = Result.add

    def vanishing(self, *arguments, **options):
        add(self, *arguments, **options)
        shutil.rmtree(tmp_path / "out", ignore_errors=True)
        (tmp_path / "out").touch()

    monkeypatch.setattr(Result, "add", vanishing)
    run = umform("run", deck, "--out", tmp_path / "out", "--checkpoint", tmp_path / "kept.h5", *FAST)
    assert run.exit_code == 1
    assert "the folder was removed during the run" in run.stderr
    assert f"go on with: umform resume {tmp_path / 'kept.h5'}" in run.stderr
    (tmp_path / "out").unlink()
    assert umform("resume", tmp_path / "kept.h5").exit_code == 0
    assert (tmp_path / "out" / "history.csv").is_file()


def test_an_error_of_the_system_in_any_command_is_one_message(monkeypatch, tmp_path):
    def fails(*arguments, **options):
        write_csv(tmp_path / "a.csv", {"a": [1]})
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(tmp_path / "b.csv"))

    monkeypatch.setattr("umform.processes.bending.showcase.demo", fails)
    run = umform("demo", "free-bending", "--out", tmp_path)
    assert run.exit_code == 1
    assert "a file cannot be read or written" in run.stderr
    assert "no permission" in run.stderr
    assert "nobody expected" not in run.stderr
