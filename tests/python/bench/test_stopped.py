"""Jobs that are stopped keep what they have reached, as the commands do."""

import json
import os
import subprocess
import sys

import pytest
from visits import wait

from umform.bench import draws, strips, work
from umform.bench.folders import LIVE, ORDER, OUTCOME, RESULTS
from umform.bench.wanted import Wanted


def files_of(folder):
    return {path.name for path in (folder / RESULTS).iterdir()}


@pytest.mark.parametrize("work", ["cup", "u"])
def test_a_drawn_part(work, stopped, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        draws.run_draw(tmp_path, "part", Wanted.read({"work": work, "mesh": "quick"}))
    assert files_of(tmp_path) == {"history.csv", "draw.vtkhdf"}


ACUTE = {"opening": 8.0, "die_angle": 30.0, "die_radius": 1.0, "punch_angle": 30.0, "punch_radius": 0.5}
BENDS = [{"position": 18.0, "angle": 165.0, "direction": "down"}]


@pytest.mark.parametrize(
    ("form", "states"),
    [
        ({"work": "sequence", "strip_length": 40.0, "bends": BENDS}, "part.vtkhdf"),
        ({"work": "hem", "thickness": 1.0, **ACUTE}, "hem.vtkhdf"),
    ],
)
def test_a_strip(form, states, stopped, tmp_path):
    wanted = Wanted.read({"mesh": "quick", "stroke": None, **form})
    with pytest.raises(KeyboardInterrupt):
        strips.run_strip(tmp_path, "strip", wanted, wanted.case(), "")
    assert files_of(tmp_path) == {"history.csv", states}


def bend(folder, **form):
    order = {"kind": "bend", "title": "bend", "parameters": {"mesh": "quick", "angle": None, "stroke": 1.0, **form}}
    return work._bend(folder, order)


def test_a_bend(stopped, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        bend(tmp_path)
    assert files_of(tmp_path) == {"history.csv", "bend.vtkhdf"}


def test_a_bend_in_its_budget_is_whole(monkeypatch, tmp_path):
    def interrupted(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(work, "error_budget", interrupted)
    with pytest.raises(KeyboardInterrupt):
        bend(tmp_path, budget=True)
    assert {"bend.json", "curve.csv", "bend.vtkhdf", "report.html"} <= files_of(tmp_path)


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_a_process_that_is_stopped_between_two_runs_has_an_outcome_and_the_bend(tmp_path):
    order = {"kind": "bend", "title": "bend", "parameters": {"mesh": "quick", "angle": None, "stroke": 1.0}}
    order["parameters"]["budget"] = True
    (tmp_path / ORDER).write_text(json.dumps(order))
    job = subprocess.Popen([sys.executable, "-m", "umform.bench.work", str(tmp_path)], stderr=subprocess.PIPE)
    live = tmp_path / LIVE
    wait(lambda: live.is_file() and json.loads(live.read_text())["phase"] == "budget")
    job.terminate()
    job.communicate(timeout=60)
    assert job.returncode == 0
    assert json.loads((tmp_path / OUTCOME).read_text())["state"] == "stopped"
    assert {"bend.json", "report.html"} <= files_of(tmp_path)
