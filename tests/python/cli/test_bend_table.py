"""``umform bend table``, ``umform bend correct`` and ``umform store``."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time

import pytest
from typer.testing import CliRunner

from umform.cli.bend_table import values_of
from umform.cli.commands import application
from umform.io.store import Store

COARSE = "--elements-per-thickness 1 --layers 1 --thickness-points 5 --increment 0.02"
SMALL = f"bend table --material DC04 --thickness 1 --opening 8 --angle 135,150 --jobs 1 {COARSE}"


@pytest.fixture(autouse=True, scope="module")
def store(tmp_path_factory):
    """A store of this file."""
    before, folder = os.environ.get("UMFORM_STORE"), tmp_path_factory.mktemp("store")
    os.environ["UMFORM_STORE"] = str(folder)
    yield Store(folder)
    os.environ.pop("UMFORM_STORE")
    os.environ.update({} if before is None else {"UMFORM_STORE": before})


def umform(text, *more):
    return CliRunner().invoke(application(), [*text.split(), *more], prog_name="umform")


def test_a_range_has_the_numbers_that_a_list_has():
    assert values_of("90:90.5:0.1", "--angle") == [90.0, 90.1, 90.2, 90.3, 90.4, 90.5]
    assert values_of("0.8,1,.5,2:1:-0.5", "--thickness") == [0.8, 1.0, 0.5, 2.0, 1.5, 1.0]


def test_a_table_is_written_and_continues_from_the_store(tmp_path):
    out = tmp_path / "tables"
    first = umform(f"{SMALL} --format csv,json,inventor --out {out}")
    assert first.exit_code == 0 and "2 bends, 2 computed now" in first.stdout and "coarse mesh" in first.stderr
    assert sorted(path.name for path in out.iterdir()) == ["DC04-V8-r1.5-d2.inventor.txt", "bends.csv", "bends.json"]
    again = umform(f"{SMALL.replace('135,150', '120:150:15')} --out {out} --overwrite")
    assert again.exit_code == 0 and "3 bends, 1 computed now, 2 from the store" in again.stdout
    refused = umform(f"{SMALL} --out {out}")
    assert refused.exit_code == 1 and "--overwrite" in refused.stderr


@pytest.mark.parametrize(
    "command", [SMALL, f"bend correct --material DC04 --stroke 5 --measured-angle 107 --jobs 1 {COARSE}"]
)
def test_a_number_of_jobs_is_refused_by_the_name_of_its_option(command):
    refused = umform(command.replace("--jobs 1", "--jobs 0"))
    assert refused.exit_code == 1 and "where:  --jobs" in refused.stderr


def test_a_table_is_issued_again_with_a_corrected_card(tmp_path):
    umform(f"{SMALL} --out {tmp_path / 'before'}")
    typed = f"bend correct --material DC04 --stroke 5 --thickness 2 {COARSE} --measured-angle 107.5+-.1 --jobs 1"
    done = umform(f"{typed} --issue-again {tmp_path / 'before' / 'bends.json'} --out {tmp_path / 'after'}")
    assert done.exit_code == 0, done.stderr
    card = tmp_path / "after" / "metal.toml"
    assert card.read_text().startswith("# DC04, corrected by one measured bend: angle 107.5 +- 0.1")
    data = json.loads((tmp_path / "after" / "bends.json").read_text())
    assert data["notes"][0].startswith("DC04, corrected by one measured bend")
    assert [one["wanted_angle"] for one in data["setups"][0]["bends"]] == [135.0, 150.0]
    assert "# DC04, corrected" in (tmp_path / "after" / "bends.csv").read_text()
    bent = umform(f"bend --stroke 1 --material {card} {COARSE} --print-deck")
    assert bent.exit_code == 0 and 'curve = "Swift"' in bent.stdout
    other = umform(f"{typed.replace('DC04', '1.4301')} --issue-again {tmp_path / 'before' / 'bends.json'}")
    assert other.exit_code == 1 and "no bends of this metal" in other.stderr


def test_a_store_that_is_none_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    for name, said in (("file", "it is a file"), ("missing", "no such folder")):
        refused = umform(f"store list --store {tmp_path / name}")
        assert refused.exit_code == 1 and said in refused.stderr


def test_the_store_is_listed_exported_and_pruned(store, tmp_path):
    umform(f"{SMALL} --out {tmp_path / 'out'}")
    count = len(list(store.entries()))
    assert count >= 2
    assert umform("store path").stdout.strip() == str(store.folder)
    listed = umform("store list")
    assert f"{count} bends in" in listed.stdout and "Swift" in listed.stdout
    for name in ("bends.csv", "bends.json"):
        assert f"{count} bends written" in umform(f"store export {tmp_path / name}").stdout
    assert len(json.loads((tmp_path / "bends.json").read_text())) == count
    assert umform(f"store export {tmp_path / 'bends.csv'}").exit_code == 1
    assert umform(f"store export {tmp_path / 'bends.txt'}").exit_code == 1
    assert "0 files removed" in umform("store prune").stdout
    assert umform("store prune --older-than -1").exit_code == 1
    assert f"{count} files removed" in umform("store prune --all").stdout
    assert not list(store.entries())


WRONG = [
    ("--angle 14", ["15 to 165", "--angle"]),
    ("--angle 80", ["DC04-V8-r1.5-d2-t1", "smaller angle"]),
    ("--angle 90:80:5", ["does not reach its end", "--angle"]),
    ("--thickness 1,x", ["no list of numbers", "--thickness"]),
    ("--thickness -1", ["--thickness"]),
    ("--opening 1000", ["--opening"]),
    ("--material DC05", ["perhaps DC04 is meant", "--material"]),
    ("--material missing.toml", ["the file of a metal cannot be read"]),
    ("--material AA6016-T4", ["--rolling"]),
    ("--format step", ["--format", "inventor"]),
    ("--tolerance 100", ["--tolerance"]),
    ("--jobs 0", ["processes"]),
    ("--store /dev/null/x", ["UMFORM_STORE"]),
]


@pytest.mark.parametrize(("typed", "said"), WRONG)
def test_a_wrong_table_is_refused_with_one_message(typed, said, tmp_path):
    done = umform(f"{SMALL} --out {tmp_path / 'out'} {typed}")
    assert done.exit_code == 1 and done.stderr.startswith("umform: ") and done.stderr.count("umform: ") == 1
    for words in said:
        assert words in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("typed", ["", "--stroke 5 --measured-angle 92,3", "--stroke 5 --measured-angle -90"])
def test_a_wrong_measurement_is_refused(typed):
    done = umform(f"bend correct --material DC04 --measured-angle 90 {typed}")
    assert done.exit_code == 1 and "remedy" in done.stderr


@pytest.mark.parametrize(
    ("typed", "owner"),
    [
        (f"{SMALL} --width-elements 4", "--width"),
        ("bend correct --material DC04 --stroke 5 --measured-angle 107 --width-elements 4", "--width"),
        ("bend correct --material DC04 --stroke 5 --measured-angle 107 --format csv", "--issue-again"),
        ("bend correct --material DC04 --stroke 5 --measured-angle 107 --store bends", "--issue-again"),
    ],
)
def test_an_option_that_does_nothing_is_refused(typed, owner):
    done = umform(typed)
    assert (
        done.exit_code == 1 and f"where:  {typed.split()[-2]}" in done.stderr and f"{owner} is missing" in done.stderr
    )


def test_an_option_before_the_name_of_a_command_is_refused():
    done = umform("bend --stroke 3 table")
    assert done.exit_code == 1 and "stand behind its name" in done.stderr and "--stroke" in done.stderr


def test_a_bend_that_fails_is_named_and_the_others_are_written(tmp_path):
    done = umform(f"{SMALL.replace('135,150', '85.1,150')} --out {tmp_path / 'out'}")
    assert done.exit_code == 1 and "not computed: DC04-V8-r1.5-d2-t1, 85.1 degrees" in done.stderr
    assert "not computed: 85.1 degrees" in (tmp_path / "out" / "bends.csv").read_text()


def test_a_stopped_table_goes_on_from_the_store(tmp_path):
    folder, angles = tmp_path / "store", "100:165:5"
    typed = f"{SMALL.replace('135,150', angles)} --out {tmp_path / 'out'} --store {folder}"
    process = subprocess.Popen(
        [sys.executable, "-m", "umform", *typed.split()], stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    while process.poll() is None and not list(Store(folder).entries()):
        time.sleep(0.01)
    process.terminate()
    process.communicate(timeout=60)
    kept = len(list(Store(folder).entries()))
    assert 1 <= kept < 14
    done = umform(typed)
    assert done.exit_code == 0 and f"{14 - kept} computed now, {kept} from the store" in done.stdout
