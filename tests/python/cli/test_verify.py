"""``umform verify``: lists, runs, shows, and says what is wrong."""

from __future__ import annotations

import importlib.metadata

import pytest
from command_line import umform as umform_cli

from umform.cli import plugins

ONE = "linear-hemisphere"


def test_without_a_case_they_are_listed():
    run = umform_cli("verify")
    assert run.exit_code == 0
    assert ONE in run.stdout


def test_one_case_is_run_and_shown(tmp_path):
    run = umform_cli("verify", ONE, "--short", "--out", tmp_path / "book")
    assert run.exit_code == 0
    assert "Pinched hemisphere" in run.stdout
    assert "green" in run.stdout
    assert (tmp_path / "book" / f"{ONE}.md").exists()
    assert (tmp_path / "book" / "images" / f"{ONE}-convergence.svg").exists()


def test_an_unknown_case(tmp_path):
    run = umform_cli("verify", "linear-hemispher", "--out", tmp_path / "book")
    assert run.exit_code == 1
    assert f"did you mean {ONE}?" in run.stderr
    assert "Traceback" not in run.stderr
    assert not (tmp_path / "book").exists()


@pytest.mark.parametrize("cases", [[ONE], [ONE, "plastic-cook"], ["--all"]])
def test_a_number_of_processes_that_is_none(cases, tmp_path):
    run = umform_cli("verify", *cases, "--short", "--out", tmp_path / "book", "--processes", 0)
    assert run.exit_code == 1
    assert "where:  --processes" in run.stderr
    assert "remedy:" in run.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    run = umform_cli("verify", ONE, "--short", "--out", tmp_path / "file" / "book")
    assert run.exit_code == 1
    assert "the folder cannot be made" in run.stderr


def test_without_the_book_one_message_says_how_to_get_it(monkeypatch):
    real = importlib.metadata.entry_points
    others = [point for point in real(group=plugins.GROUP) if point.dist.name != "umform-book"]
    monkeypatch.setattr(importlib.metadata, "entry_points", lambda **group: others)
    plugins.plugins.cache_clear()
    try:
        run = umform_cli("verify", "--help")
        assert umform_cli("verfy").exit_code == 2
    finally:
        plugins.plugins.cache_clear()
    assert run.exit_code == 1
    assert run.stdout == ""
    assert run.stderr.startswith("umform: the verification book is not installed [value.invalid]\n")
    assert "remedy: pip install ./book" in run.stderr
