"""Studies of errors: rows of runs, the largest errors, and whether the finest answers lie in the bands."""

from __future__ import annotations

import sys
from types import SimpleNamespace

import pytest

from umform.errors import NoConvergence
from umform.results.quantity import Quantity


@pytest.fixture
def studies(script):
    return script("band_studies")


@pytest.fixture
def bands(script):
    return script("bands")


def part(default, finest, **runs):
    rows = {"default": default, "finest": finest, **{name.replace("_", " "): values for name, values in runs.items()}}
    return {name: {"values": values, "units": {}, "cpu": 1.0} for name, values in rows.items()}


PARTS = {
    "a": part({"force": 100.0, "angle": 10.0}, {"force": 90.0, "angle": 11.0}, mesh={"force": 92.0}),
    "b": part({"force": 50.0, "angle": 80.0}, {"force": 46.0, "angle": 80.5}, coarse={"force": 40.0, "angle": None}),
    "c": part(
        {"force": 10.0, "angle": 90.0, "bend 1: radius": 2.0, "bend 2: radius": 3.0},
        {"force": 9.5, "angle": 90.2, "bend 1: radius": 2.1, "bend 2: radius": 3.3},
        coarse={"force": 8.0},
        penalty={"force": 8.4},
    ),
}


def test_the_root_mean_square_counts(studies):
    """Relative errors of forces: 10, 8 and 5 %; of angles, which differ less themselves: 1.0, 0.5 and 0.2."""
    found = studies.studied(list(PARTS.values()), {"force": "N"})
    force, angle, radius = (found["quantities"][name] for name in ("force", "angle", "radius"))
    assert found["parts"] == 3 and (force["count"], radius["count"]) == (3, 1) and found["exponent"] == 0.0
    assert force["relative"] and force["meshes"] == {"default": 0.0794, "coarse": 0.17}  # 6 of 40; 1.5 of 8
    assert force["sources"] == {"mesh": 0.08, "penalty": 0.05, "all but the mesh": 0.0217}  # 2 of 92
    assert not angle["relative"] and angle["meshes"] == {"default": 0.656}
    assert radius["factor"] == 12.71 and force["factor"] == 3.18
    assert radius["relative"] and radius["meshes"]["default"] == pytest.approx(0.0791)  # of 0.05 and 0.1


def test_a_power_of_the_softness_is_found(studies):
    """Errors of the square root of the softness, and none without."""
    soft = {
        f"{number}": part({"angle": 10.0**number}, {"angle": 10.0**number + 0.1 * number}) for number in range(1, 7)
    }
    for number, one in enumerate(soft.values(), start=1):
        one["default"]["softness"] = {"": float(number**2)}
    found = studies.studied(list(soft.values()), {})
    assert found["exponent"] == 0.5
    assert found["quantities"]["angle"]["meshes"]["default"] == pytest.approx(0.1)
    assert all(inside for *_, inside in studies.held_out(soft, {}, "default", "any"))


def test_errors_in_mm_follow_the_length_of_the_part(studies):
    """A tenth of the thickness in sheets of 1 and 4 mm; an angle does not follow it."""
    thick = {}
    for thickness in (1.0, 4.0):
        one = part({"gap": 0.0, "angle": 0.0}, {"gap": 0.1 * thickness, "angle": 2.0})
        one["default"] |= {"units": {"gap": "mm", "angle": "degrees"}, "length": thickness}
        thick[f"{thickness:g}"] = one
    found = studies.studied(list(thick.values()), {})["quantities"]
    assert {name: row["meshes"]["default"] for name, row in found.items()} == {"gap": 0.1, "angle": 2.0}
    assert all(inside for *_, inside in studies.held_out(thick, {}, "default", "any"))


def test_each_part_is_checked_by_the_others(studies):
    """The factor is 4.3 for two parts: of b and c for a, and so on."""
    checked = studies.held_out(PARTS, {"force": "N"}, "default", "any")
    assert {(name, number): inside for name, number, inside in checked} == {
        ("a", "force"): True,  # 10 within 4.3 x 6.7 % of 100
        ("a", "angle"): True,  # 1.0 within 4.3 x 0.38
        ("b", "force"): True,
        ("b", "angle"): True,
        ("c", "force"): True,
        ("c", "angle"): True,
    }
    worse = PARTS | {"a": part({"force": 100.0, "angle": 10.0}, {"force": 60.0, "angle": 12.0})}
    outside = [one[:2] for one in studies.held_out(worse, {"force": "N"}, "default", "any") if not one[2]]
    assert outside == [("a", "force"), ("a", "angle")]


def test_each_half_is_checked_by_the_other(studies):
    """b for a and c with the factor 12.7 of one part; a and c for b."""
    checked = studies.other_half(PARTS, {"force": "N"}, "default", "any")
    assert [one[:2] for one in checked] == [(name, number) for name in "acb" for number in ("force", "angle")]
    assert all(inside for *_, inside in checked)
    assert studies.other_half({"a": PARTS["a"]}, {}, "default", "any") == []


def test_the_error_budget_of_a_deck_is_checked(studies):
    """Changes from the default mesh by the coarser one, from the coarser one by others; a number may be unknown."""
    runs = {"default": 10.0, "mesh*2": 13.0, "step*2": 9.0, "finest": 17.4}
    numbers = {"a": runs, "b": runs | {"finest": 17.6}, "c": runs | {"step*2": None}}
    deck = {run: {"values": {name: one[run] for name, one in numbers.items()}} for run in runs}
    assert studies.budgets({"box": deck}) == [("box", "a", True), ("box", "b", False)]  # 1.5 x hypot(3, 4)


def test_the_change_from_the_coarse_mesh_is_checked(studies):
    """1.5 times the change of 4 contains an error of 6, and not one of 7; a number that is not on it is left out."""
    runs = {"default": 10.0, "coarse": 14.0, "finest": 16.0}
    numbers = {"a": runs, "b": runs | {"finest": 17.0}, "c": runs | {"coarse": None}}
    one = part(*({name: row[run] for name, row in numbers.items()} for run in ("default", "finest")))
    one |= part({}, {}, coarse={name: row["coarse"] for name, row in numbers.items()}) | one
    assert studies.by_coarse({"box": one}) == [("box", "a", True), ("box", "b", False)]


def test_the_band_of_two_meshes_is_checked(studies):
    """A number that falls with the square of the size, and one that jumps on the finest mesh."""
    values = {"quick": 11.0, "default": 10.25, "finest": 10.05}
    jump = values | {"finest": 20.0}
    both = {"theta1": values, "theta2": jump}
    runs = {run: {"values": {name: one[run] for name, one in both.items()}} for run in values}
    checked, halves = studies.extrapolated({"a": runs, "b": runs}, {})
    assert [inside for name, _, inside in checked if name == "a"] == [True, False] and halves == checked
    checked, _ = studies.extrapolated({"a": runs, "b": runs | {"mesh": {"values": {"theta2": 19.0}}}}, {})
    assert [inside for name, _, inside in checked if name == "a"] == [True, True]  # 12.7 x 1 of b


def test_runs_that_are_known_are_not_repeated(bands, monkeypatch, tmp_path, capsys):
    made = []

    def run(case):
        made.append(case)
        if case == "penalty":
            raise NoConvergence("it does not converge")
        return SimpleNamespace(quantities=[Quantity("force", "N", value=1.5)])

    job = SimpleNamespace(process="cup", name="a", cases={name: name for name in ("default", "penalty")})
    other = SimpleNamespace(process="hem", name="b", cases={"default": "hem"})
    monkeypatch.setattr(bands, "JOBS", (job, other))
    monkeypatch.setattr(bands, "run", run)
    file = tmp_path / "new" / "rows.jsonl"
    bands.run_missing(file, ["cup"])
    bands.run_missing(file, ["cup"])
    rows = bands.read(file)
    assert made == ["default", "penalty"] and "cup, a, default" in capsys.readouterr().out
    assert rows[0]["values"] == {"force": 1.5} and rows[0]["units"] == {"force": "N"} and rows[0]["error"] is None
    assert "does not converge" in rows[1]["error"] and rows[1]["values"] == {}
    job.cases["default"] = "other parameters"
    bands.run_missing(file, ["cup"])
    assert made == ["default", "penalty", "other parameters"]


def test_the_page_says_what_is_missed(script, studies, bands):
    worse = PARTS | {"a": part({"force": 100.0, "angle": 10.0}, {"force": 60.0, "angle": 12.0})}
    rows = [run | {"process": "cup"} for one in worse.values() for run in one.values()]
    text = script("bands_page").page(
        rows, {"cup": worse}, {"cup": {}}, {"cup": studies.studied(list(worse.values()), {})}
    )
    assert "answers lie in their bands" in text and "the goal is missed." in text
    assert "* cup, estimated, default mesh: a: force, angle" in text
    assert "| force | 24 | % of it | 3 |" in text


def test_jobs_have_names_of_their_own_and_all_refinements(script):
    jobs = script("band_jobs")
    names = [(job.process, job.name) for job in jobs.JOBS]
    assert len(set(names)) == len(names)
    for process in dict.fromkeys(process for process, _ in names):
        job = next(job for job in jobs.JOBS if job.process == process)
        assert {jobs.DEFAULT, jobs.FINEST} <= set(job.cases)
        single = (
            {"mesh*2", "step*2", "depth*2"} if process == "deck" else {jobs.COARSE, "mesh", "increments", "penalty"}
        )
        without = ("bend sequence", "hem, flat", "hem, open", "hem, rope")
        assert process in without or single <= set(job.cases)


def test_studies_and_page_are_those_of_the_stored_runs(bands, monkeypatch, tmp_path):
    """The stored runs make both again."""
    kept = bands._DATA, bands._DATA.parents[3] / "docs" / "bands.md"
    made = tmp_path / "studies.json"
    made.write_text(kept[0].read_text(encoding="utf-8"), encoding="utf-8")
    monkeypatch.setattr(bands, "_DATA", made)
    monkeypatch.setattr(sys, "argv", ["bands.py", "--stored", "--page", str(tmp_path / "bands.md")])
    bands.main()
    for new, there in zip((made, tmp_path / "bands.md"), kept, strict=True):
        assert new.read_text(encoding="utf-8") == there.read_text(encoding="utf-8")
