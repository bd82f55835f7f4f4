"""``umform sweep`` on the command line."""

import csv

import pytest
from typer.testing import CliRunner

from umform import cli
from umform.problem.templates import write_template

SMALL = ("--set", "mesh.cells=[4,1]", "--set", "steps.0.increments=2", "--processes", "1")


@pytest.fixture
def deck(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_template("cantilever", tmp_path / "deck.toml")
    return tmp_path / "deck.toml"


def umform(*words):
    return CliRunner().invoke(cli.app, ["sweep", *map(str, words)])


def rows(deck):
    with (deck.parent / "results" / "deck-sweep" / "sweep.csv").open() as file:
        return list(csv.DictReader(file))


def test_a_table_of_all_jobs_with_failures_by_their_reasons(deck):
    done = umform(
        deck, *SMALL, "--vary", "thickness=0.1:0.2:0.1", "--vary", "name=ANS3DEAS,NONE", "--measure", "force:max"
    )
    assert done.exit_code == 0, done.output
    assert "4 jobs: 2 done, 2 refused" in done.stdout
    assert "2 x " in done.stdout
    assert [(row["thickness"], row["name"]) for row in rows(deck)][:2] == [("0.1", "ANS3DEAS"), ("0.1", "NONE")]
    assert [row["force:max"] for row in rows(deck)] == ["4.0", "", "4.0", ""]
    assert "done" in done.stderr


def test_jobs_of_a_table(deck):
    (deck.parent / "jobs.csv").write_text('thickness,cells\n0.1,"[4, 1]"\n0.2,"[6, 1]"\n')
    twice = umform(deck, *SMALL, "--jobs", "jobs.csv")
    assert twice.exit_code == 1 and "mesh.cells" in twice.stderr and "varied as cells" in twice.stderr
    done = umform(deck, *SMALL[2:], "--jobs", "jobs.csv", "--measure", "elastic_energy")
    assert done.exit_code == 0, done.output
    assert [row["cells"] for row in rows(deck)] == ["[4, 1]", "[6, 1]"]
    assert len({row["elastic_energy"] for row in rows(deck)}) == 2


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--vary", "thickness"], "this varies no key"),
        (["--vary", "thicknes=1"], "did you mean thickness"),
        (["--vary", "thickness=1:2:0"], "a range does not reach its end"),
        (["--vary", "kind=fix"], "ambiguous"),
        (["--jobs", "missing.csv"], "the jobs cannot be read"),
        (["--jobs", "ragged.csv"], "this is no table of jobs"),
        ([], "a sweep varies nothing"),
        (["--vary", "E=1e6", "--processes", "0"], "where:  --processes"),
        (["--vary", "E=1e6", "--measure", "force:mx"], "where:  --measure"),
    ],
)
def test_what_makes_no_sweep_is_said_before_anything_runs(deck, words, said):
    (deck.parent / "ragged.csv").write_text("thickness,E\n0.1\n")
    done = umform(deck, *words)
    assert done.exit_code == 1
    assert said in done.stderr
    assert not (deck.parent / "results").exists()


def test_a_sweep_of_failures_only_ends_with_an_error(deck):
    done = umform(deck, *SMALL, "--vary", "name=NONE,NOTHING")
    assert done.exit_code == 1
    assert [row["outcome"] for row in rows(deck)] == ["refused", "refused"]


def test_a_key_that_is_varied_twice_is_refused(deck):
    done = umform(deck, *SMALL, "--vary", "thickness=0.1:0.2:0.1", "--vary", "thickness=0.3")
    assert done.exit_code == 1
    assert "a key is varied twice" in done.stderr
