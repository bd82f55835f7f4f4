"""Random jobs arrive and balance; what does not arrive is told apart, and has to be explained."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from umform.errors import InvalidValue, NoConvergence
from umform.results.balance import Balance

#: How many jobs the samples have.
SAMPLE, DRAWS = 42, 19
#: Those that jump at the end of a stable path.
JUMPS = {104, 166}


@pytest.fixture
def robust(script):
    return script("robust")


@pytest.fixture
def bends(robust):
    return robust.LOTS["bends"]


@pytest.mark.parametrize("which", range(SAMPLE))
def test_the_sample_arrives(robust, bends, which):
    ended = robust.outcome(bends.lot.job(bends.sample[which]))
    assert (ended["outcome"], ended["reason"]) == ("arrived", "")
    assert ended["increments"] > 0
    assert (ended["jumps"] > 0) == (ended["number"] in JUMPS)


@pytest.mark.parametrize("which", range(DRAWS))
def test_the_sample_of_drawing_and_forming_arrives(robust, which):
    draws = robust.LOTS["draws"]
    ended = robust.outcome(draws.lot.job(draws.sample[which]))
    assert (ended["outcome"], ended["reason"]) == ("arrived", "")


@pytest.mark.parametrize(("name", "count"), [("bends", SAMPLE), ("draws", DRAWS)])
def test_the_samples_have_jobs_of_all_kinds(robust, name, count):
    rated = robust.LOTS[name]
    assert len(set(rated.sample)) == len(rated.sample) == count
    assert {rated.lot.job(number).kind for number in rated.sample} == set(rated.lot.kinds)


@pytest.mark.parametrize("name", ["bends", "draws"])
def test_a_number_is_always_the_same_job(robust, name):
    lot = robust.LOTS[name].lot
    row = len(lot.row)
    for number in range(row):
        job, next_one = lot.job(number), lot.job(number + row)
        assert job == lot.job(number)
        assert job.keys != next_one.keys
        assert job.kind == next_one.kind


def test_finer_jobs_have_increments_of_half_the_size(robust, bends):
    strip, bend = bends.lot.job(13), bends.lot.job(0)
    assert strip.finer().keys["steps"] == 2 * strip.keys["steps"]
    assert bend.finer().keys["increment"] == 0.5 * bend.keys["increment"]
    hats = [robust.LOTS["draws"].lot.job(20 * row) for row in range(10)]
    paced = next(hat for hat in hats if "pace" in hat.keys)
    assert paced.finer().keys["pace"] == 0.5 * paced.keys["pace"]


@pytest.mark.parametrize(
    ("error", "ended"),
    [
        (NoConvergence("no", where="step 1", cause="chatter"), "no convergence"),
        (InvalidValue("a word"), "refused"),
    ],
)
def test_errors_are_told_apart(robust, bends, monkeypatch, error, ended):
    def failing(task):
        raise error

    monkeypatch.setattr(robust.Job, "run", failing)
    found = robust.outcome(bends.lot.job(0))
    assert found["outcome"] == ended
    assert (error.cause or error.what) in found["reason"]


def result(force=0.0, drift=0.0, warnings=()):
    """A run that does not balance."""
    rows = [9.0, 9.0, force]  # the start need not be in equilibrium, and before a first touch there is round-off alone
    zero = np.zeros(3)
    balance = Balance(
        step=zero,
        time=zero,
        external_work=zero,
        elastic=np.array([5.0, 1e-14, 1.0]),
        plastic=zero,
        contact=zero,
        friction=zero,
        drift=np.array([0.0, 0.0, -drift]),
        force_imbalance=np.array(rows),
        moment_imbalance=zero,
        works={},
    )
    return SimpleNamespace(balance=lambda: balance, warnings=warnings)


def test_a_run_without_balance_is_wrong(robust, bends, monkeypatch):
    task = bends.lot.job(13)
    assert robust.imbalance(task, robust.Done([result()])) == ""
    assert robust.imbalance(task, robust.Done([result(force=1e-3)])) == "forces off by 0.001, 1e-06 allowed"
    assert robust.imbalance(task, robust.Done([result(force=1e-3)], forces=0.01)) == ""
    told = ["step 1: the residual 4e-05 of the forces is above the tolerance 1e-09: ..."]
    assert robust.imbalance(task, robust.Done([result(force=1e-3, warnings=told)])) == ""
    assert robust.imbalance(task, robust.Done([result(force=2e-2, warnings=told)]))
    assert robust.imbalance(task, robust.Done([], {"angle": (0.2, 0.1)})) == "angle off by 0.2, 0.1 allowed"
    assert robust.imbalance(task, robust.Done([], {"angle": (np.nan, 0.1)}))
    for finer, said in ((0.02, ""), (0.08, "energies with increments of half the size off by 0.08, 0.048 allowed")):
        monkeypatch.setattr(robust.Job, "run", lambda job, finer=finer: robust.Done([result(drift=finer)]))
        assert robust.imbalance(task, robust.Done([result(drift=0.08)])) == said


def test_a_process_that_takes_too_long_or_dies_is_told(robust, bends, monkeypatch, tmp_path):
    slow = tmp_path / "slow.py"
    slow.write_text(
        "import sys\n"
        f"sys.path.insert(0, {str(robust.__file__).removesuffix('/robust.py')!r})\n"
        "import robust\n"
        "def forever(task):\n"
        "    while True: pass\n"
        "robust.Job.run = forever\n"
        "robust.inside(robust.LOTS['bends'].lot.job(3), 2)\n"
    )
    dying = tmp_path / "dying.py"
    dying.write_text("import os\nos.abort()\n")
    monkeypatch.setattr(robust, "__file__", str(slow))
    assert robust.in_a_process(bends, 3)["outcome"] == "out of time"
    monkeypatch.setattr(robust, "__file__", str(dying))
    assert robust.in_a_process(bends, 3)["outcome"] == "crash"


def outcome(number: int, ended: str = "arrived") -> dict[str, object]:
    """What a job of the page needs."""
    return {
        "number": number,
        "kind": "air bend" if number < 8 else "plate under a tool",
        "outcome": ended,
        "reason": "why" if ended != "arrived" else "",
        "CPU s": 1.0 + number,
        "evaluations": 10,
        "share discarded": 0.5,
    }


def test_failures_must_be_explained_and_explanations_must_be_needed(script, bends):
    page = script("robust_page")
    outcomes = [outcome(0), outcome(1, "no convergence")]
    page.check(bends, outcomes, {1: "a limit point"})
    for known in ({}, {0: "old", 1: "a limit point"}):
        with pytest.raises(SystemExit, match=r"no explanation of the jobs \[1?\]; jobs \[0?\] arrive"):
            page.check(bends, outcomes, known)


def test_the_page_has_the_rate_and_each_failure(script, bends, monkeypatch):
    page = script("robust_page")
    monkeypatch.setattr(page, "explanations", lambda rated: {1: "a limit point"})
    text = page.page(bends, [outcome(0), outcome(1, "no convergence"), outcome(28), outcome(29)])
    assert "\n75.0% finish; the goal is 99.5% and no job that hangs: missed.\n" in text
    assert "| air bend | 2 | 50.0% | 2.0 | 2.0 | 20 | 50% |" in text
    assert "* **Job 1**, air bend, no convergence: a limit point" in text
    assert "\nJobs: none. The stable path ends" in text
    jumped = outcome(29) | {"jumps": 1}
    assert "\nJobs: 29. The stable path ends" in page.page(bends, [outcome(0), outcome(1, "no convergence"), jumped])


@pytest.mark.parametrize("name", ["bends", "draws"])
def test_explanations_are_of_the_jobs_that_are_drawn(script, robust, name, monkeypatch):
    page, rated = script("robust_page"), robust.LOTS[name]
    page.explanations(rated)
    monkeypatch.setitem(vars(rated.lot), "drawn", "other")
    with pytest.raises(SystemExit, match="drawn in another way"):
        page.explanations(rated)


def test_a_refusal_of_the_check_counts_for_drawn_jobs_alone(script, robust):
    page = script("robust_page")
    refused = [outcome(0, "refused"), outcome(1)]
    assert page.rate(robust.LOTS["draws"], refused) == 1.0
    assert page.rate(robust.LOTS["bends"], refused) == 0.5


def test_a_number_of_which_its_run_warns_is_marked(script):
    page = script("robust_page")
    warned = {"warnings": ["contact on_die: the penetration of 0.1 exceeds the 0.02 allowed"]}
    assert page.marked(outcome(0) | warned)
    assert not page.marked(outcome(0) | {"warnings": ["another"]})
    assert not page.marked(outcome(0, "no convergence") | warned)
