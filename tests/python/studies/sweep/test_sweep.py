"""Sweeps of a small deck: table, failures, going on, executors."""

import csv
import json
import pickle
import signal
from concurrent.futures import Executor, Future

import numpy as np
import pytest

import umform as uf
from umform.errors import FileProblem, InvalidValue
from umform.problem import DeckError, load, running
from umform.problem.templates import write_template
from umform.results.history import History
from umform.results.quantity import Quantity
from umform.studies.sweep import jobs as jobs_module


@pytest.fixture
def ran(monkeypatch):
    """What was run, and not only read from the disk."""
    names, run_job = [], jobs_module.run_job
    monkeypatch.setattr(jobs_module, "run_job", lambda job: names.append(dict(job.varied)) or run_job(job))
    return names


def sweep(deck, vary=None, **options):
    return uf.sweep(deck, vary, **{"processes": 1, "progress": False} | options)


def length(result):
    return np.ptp(result.model.mesh.points[:, 0])


def stretch(result):
    """A number of the test with its unit and limit."""
    return Quantity("stretch of the strip", "mm", 2, value=float(result["pull"].max()), limit=0.15)


def fails(result):
    raise RuntimeError("this measure has a bug")


def test_the_table_has_what_each_deck_gives_alone(deck):
    vary = {"thickness": [1.0, 0.8], "E": np.array([70e3, 210e3])}
    found = sweep(deck, vary, measures=["pull_force:max", "pull_force", "springback", length])
    assert found.varied == ["thickness", "E"]
    assert list(zip(found["thickness"], found["E"])) == [(1.0, 70e3), (1.0, 210e3), (0.8, 70e3), (0.8, 210e3)]
    assert found["outcome"] == ["done"] * 4
    for row in found.rows:
        alone = load(deck, {"mesh.thickness": row["thickness"], "material.E": row["E"]}).build().solve(progress=False)
        assert row["pull_force:max"] == alone["pull_force"].max() > 0.0
        assert row["pull_force"] == alone["pull_force"][-1]
        assert row["length"] == 10.0
    with (deck.parent / "results" / "pull-sweep" / "sweep.csv").open() as file:
        kept = list(csv.DictReader(file))
    assert [float(row["pull_force:max"]) for row in kept] == found["pull_force:max"]
    assert {file.name for file in found.files} >= {"sweep.csv", "sweep.png"}


def springback(result):
    return 42.0


def test_a_function_is_what_it_computes_whatever_its_name(deck):
    assert sweep(deck, {"pull": [0.1]}, measures=[springback])["springback"] == [42.0]
    for twice in ([springback, "springback"], [lambda result: 1.0, lambda result: 2.0]):
        with pytest.raises(InvalidValue, match="name of another column"):
            sweep(deck, {"pull": [0.1]}, measures=twice)


def test_a_function_may_give_a_quantity(deck):
    found = sweep(deck, {"pull": [0.1, 0.2]}, measures=[stretch])
    assert found["stretch"] == pytest.approx([0.1, 0.2])
    quantities = [row["quantities"]["stretch"] for row in found.rows]
    assert [one.missed for one in quantities] == [False, True] and {one.unit for one in quantities} == {"mm"}
    with (deck.parent / "results" / "pull-sweep" / "sweep.csv").open() as file:
        assert "stretch mm" in next(csv.reader(file))


def test_springback_is_that_of_the_whole_part_without_its_rigid_motion(deck):
    """Half of the strip is 0.1 longer when loaded; laid into its middle, each end of the whole is off by 0.1."""
    found = sweep(deck, {"pull": [0.1, 0.2]}, measures=["springback"])
    assert found["springback"] == pytest.approx([0.1, 0.2], rel=1e-6)
    move = {"kind": "move", "to": {"pull": 0.1}, "increments": 1}
    twice = {"steps": [move, {"kind": "release", "control": "pull"}] * 2, "steps.0.to.pull": 0.3}
    found = sweep(deck, {"E": [1e5]}, changes=twice, measures="springback")
    assert found["springback"] == pytest.approx([0.1], rel=1e-6)
    without = {"steps": [move, {"kind": "release", "control": "pull"}, move]}
    with pytest.raises(InvalidValue, match="no springback"):
        sweep(deck, {"E": [1e5]}, changes=without, measures=["springback"])


def test_without_measures_there_are_peaks_springback_and_last_values(deck):
    found = sweep(deck, {"E": "70e3,210e3"})
    assert found.measures[:3] == ["pull_force:peak", "springback", "pull"]
    assert {"pull_force", "elastic_energy", "iterations:sum"} <= set(found.measures)
    assert found["pull_force:peak"][1] == pytest.approx(3 * found["pull_force:peak"][0])


def pull(result):
    return float(result["pull"][-1])


def test_a_column_of_the_history_with_the_name_of_a_key_has_its_statistic_behind_it(deck):
    for measures in ([], ["pull", "pull_force:peak"]):
        found = sweep(deck, {"pull": [0.1, 0.2]}, measures=measures)
        assert found["pull"] == [0.1, 0.2] and found["pull:last"] == pytest.approx([0.0, 0.0], abs=1e-9)
    with pytest.raises(InvalidValue, match="name of another column"):
        sweep(deck, {"pull": [0.1, 0.2]}, measures=[pull])


def test_failures_are_rows_with_their_reason_and_the_others_go_on(deck):
    found = sweep(deck, {"thickness": [-1.0, 1.0], "max_iterations": [1, 25]}, changes={"steps.0.cuts": 0})
    assert found["outcome"] == ["refused", "refused", "stopped", "done"]
    assert "mesh.thickness" in found["reason"][0]
    assert "solve.no-convergence" in found["reason"][2]
    assert found["reason"][3] == ""
    assert found["pull_force:peak"][:3] == [None] * 3
    unknown = sweep(deck, {"material": "no such steel,DC04"}, measures=["pull_force:max"])
    assert unknown["outcome"] == ["refused", "done"]
    with pytest.raises(DeckError, match=r"mesh\.thicknes"):
        sweep(deck, {"mesh.thicknes": [1.0, 2.0]})


def test_an_unexpected_error_is_a_failure_and_runs_again(deck, ran):
    found = sweep(deck, {"E": [1e5]}, measures=[fails])
    assert found["outcome"] == ["failed"]
    assert found["reason"] == ["RuntimeError: this measure has a bug"]
    sweep(deck, {"E": [1e5]})
    sweep(deck, {"E": [1e5]})
    assert len(ran) == 2


def test_finished_jobs_are_not_run_again(deck, ran):
    first = sweep(deck, {"E": [1e5, 2e5]})
    again = sweep(deck, {"E": [1e5, 2e5]}, measures=["pull_force:min"])  # another measure needs no run
    assert [row["E"] for row in ran] == [1e5, 2e5]
    assert again["seconds"] == first["seconds"]
    more = sweep(deck, {"E": "100000:300000:100000"})  # whole numbers are the same values
    assert [row["E"] for row in ran] == [1e5, 2e5, 3e5]
    assert more["folder"][:2] == first["folder"]
    deck.write_text(deck.read_text().replace("length = 10.0", "length = 12.0"))
    sweep(deck, {"E": [1e5]})
    assert len(ran) == 4


def test_the_table_of_another_study_stays_and_fewer_jobs_are_the_same_study(deck, ran, caplog):
    first = sweep(deck, {"E": [1e5, 2e5]}).files[0]
    text = first.read_text()
    for _ in range(2):
        caplog.clear()
        other = sweep(deck, {"E": [1e5]}, changes={"mesh.thickness": 2.0})
        assert other.files[0].parent.name == "pull-sweep-2" and "another sweep" in caplog.text
    assert first.read_text() == text and len(ran) == 3
    with pytest.raises(FileProblem, match="another sweep"):
        sweep(deck, {"E": [3e5]}, out=first.parent)
    fewer = sweep(deck, {"E": [1e5]}, measures="pull_force:min")
    assert fewer.measures == ["pull_force:min"] and fewer.files[0] == first and len(ran) == 3
    assert sweep(deck, {"E": [3e5]}, out=first.parent, overwrite=True).files[0] == first


def test_a_key_of_a_law_that_is_varied_too_belongs_to_each_law(deck):
    vary = {"E": [1e5, 2e5], "material": "DC04,S355"}
    one, other = (sweep(deck, dict(list(vary.items())[::way]), measures=["pull_force:max"]) for way in (1, -1))
    assert len(set(one["pull_force:max"])) == 4
    assert one["pull_force:max"] == [other["pull_force:max"][n] for n in (0, 2, 1, 3)]


def test_a_key_with_a_value_for_all_jobs_is_not_varied(deck):
    with pytest.raises(InvalidValue, match="for all jobs"):
        sweep(deck, {"thickness": [1.0]}, changes={"mesh.thickness": 2.0})


def test_files_that_the_deck_reads_are_part_of_what_was_run_and_its_title_is_none(tmp_path):
    path, _ = write_template("own-mesh", tmp_path / "own.toml")

    def place():
        return jobs_module.job(load(path), {}, {}, tmp_path, files=False).folder

    before = place()
    path.write_text(path.read_text().replace("title = ", "title = 'Another one'  # "))
    assert place() == before
    (tmp_path / "sheet.inp").write_text((tmp_path / "sheet.inp").read_text() + "** more\n")
    assert place() != before


def test_classes_of_the_user_are_part_of_what_was_run(deck, tmp_path):
    module = tmp_path / "curves_of_a_sweep.py"
    module.write_text(
        "from dataclasses import dataclass\nimport umform as uf\n\n@dataclass(frozen=True)\nclass Flat:\n"
        "    at: float\n\n    def curve(self):\n        return uf.Perfect(self.at).curve()\n"
    )
    curve = 'law = "J2"\nhardening = { curve = "curves_of_a_sweep:Flat", at = 200.0 }'
    deck.write_text(deck.read_text().replace('law = "SVK"', curve))

    def place():
        return jobs_module.job(load(deck, trust=True), {}, {}, tmp_path, files=False).folder

    before = place()
    assert place() == before
    module.write_text(module.read_text().replace("self.at", "2.0 * self.at"))
    assert place() != before


def test_objects_of_python_are_rows_with_their_words(deck):
    """A deck has no words for them: such jobs are refused, each for itself."""
    strain = np.linspace(0.0, 1.0, 400)
    curves = [uf.Table(strain, 200.0 + 100.0 * strain**more) for more in (0.5, 0.5, 0.4)]
    metal = {"law": "J2", "E": 2e5, "nu": 0.3, "hardening": {"curve": "Perfect", "yield_stress": 200.0}}
    found = sweep(deck, {"material.hardening": curves}, changes={"material": metal})
    assert found["outcome"] == ["refused"] * 3 and "an object of Python" in found["reason"][0]
    assert len(set(found["folder"])) == 2
    assert [text.rpartition(", ")[2] for text in found["material.hardening"]] == ["1", "1", "2"]


def test_a_job_that_comes_twice_runs_once(deck, ran):
    found = sweep(deck, {"E": [1e5, 2e5, 1e5]}, measures=["pull_force:max"])
    assert [row["E"] for row in ran] == [1e5, 2e5]
    assert found["pull_force:max"][0] == found["pull_force:max"][2] != found["pull_force:max"][1]


def test_jobs_that_were_refused_run_again_by_force(deck, ran):
    vary = {"thickness": [2000.0]}  # a sheet thicker than it is long
    assert sweep(deck, vary)["outcome"] == ["refused"]
    assert sweep(deck, vary)["outcome"] == ["refused"]
    assert sweep(deck, vary, force=True)["outcome"] == ["done"]
    assert len(ran) == 2


def test_jobs_that_did_not_converge_run_again_if_that_is_wanted(deck, ran):
    changes = {"steps.0.cuts": 0}
    for retry in (False, False, True):
        found = sweep(deck, {"max_iterations": [1]}, changes=changes, retry=retry)
        assert found["outcome"] == ["stopped"]
    assert len(ran) == 2


def test_a_sweep_that_was_interrupted_goes_on_within_its_job(deck, monkeypatch):
    options = {"changes": {"steps.0.increments": 5}, "measures": ["elastic_energy:max"]}
    add, count = History.add, []

    def stop(self, *arguments, **keys):
        add(self, *arguments, **keys)
        count.append(1)
        if len(count) == 4:
            signal.raise_signal(signal.SIGINT)

    with monkeypatch.context() as patch:
        patch.setattr(History, "add", stop)
        with pytest.raises(KeyboardInterrupt) as caught:
            sweep(deck, {"E": [1e5, 2e5]}, **options)
    assert "0 of 2 jobs" in caught.value.__notes__[-1]
    with (deck.parent / "results" / "pull-sweep" / "sweep.csv").open() as file:
        assert [row["outcome"] for row in csv.DictReader(file)] == ["open", "open"]
    resumed, resume = [], running.resume
    monkeypatch.setattr(running, "resume", lambda *a, **k: resumed.append(a) or resume(*a, **k))
    found = sweep(deck, {"E": [1e5, 2e5]}, **options)
    assert len(resumed) == 1
    assert (
        found.table()["elastic_energy:max"]
        == sweep(deck, {"E": [1e5, 2e5]}, out="afresh", **options)["elastic_energy:max"]
    )


def test_a_list_of_jobs_varies_keys_together(deck):
    jobs = [{"thickness": 1.0, "E": 1e5}, {"thickness": 2.0, "E": 2e5}]
    found = sweep(deck, {"pull": [0.1, 0.2]}, jobs=jobs, measures=["pull_force:max"])
    rows = list(zip(*(found[name] for name in ("thickness", "E", "pull"))))
    assert rows == [(1.0, 1e5, 0.1), (1.0, 1e5, 0.2), (2.0, 2e5, 0.1), (2.0, 2e5, 0.2)]
    assert found["pull_force:max"][2] == pytest.approx(4 * found["pull_force:max"][0])


def test_jobs_of_a_file(deck, tmp_path):
    path = tmp_path / "jobs.csv"
    path.write_text("thickness,E\n1.0,1e5\n2.0,2e5\n", encoding="utf-8")
    found = sweep(deck, jobs=path, measures=["pull_force:max"])
    assert list(zip(found["thickness"], found["E"])) == [(1.0, 1e5), (2.0, 2e5)]
    assert found["pull_force:max"][1] == pytest.approx(4 * found["pull_force:max"][0])
    assert sweep(deck, jobs=str(path), measures=["pull_force:max"]).rows == found.rows
    with pytest.raises(FileProblem, match="cannot be read"):
        sweep(deck, jobs=tmp_path / "other.csv")
    path.write_text("thickness,E\n1.0\n", encoding="utf-8")
    with pytest.raises(FileProblem, match="no table of jobs"):
        sweep(deck, jobs=path)
    path.write_text("thickness,thickness\n1.0,2.0\n", encoding="utf-8")
    with pytest.raises(FileProblem, match="a key is varied twice"):
        sweep(deck, jobs=path)
    with pytest.raises(InvalidValue, match="it is a key of the list of jobs, too"):
        sweep(deck, {"E": [1e5]}, jobs=[{"E": 2e5}])


class Elsewhere(Executor):
    """An executor of a user, whose jobs travel as pickles as those of other machines do."""

    def __init__(self):
        self.submitted = 0

    def submit(self, function, /, *arguments, **keys):
        self.submitted += 1
        future = Future()
        try:
            function, arguments = pickle.loads(pickle.dumps((function, arguments)))
            future.set_result(pickle.loads(pickle.dumps(function(*arguments, **keys))))
        except Exception as error:
            future.set_exception(error)
        return future


def test_an_executor_of_the_user_runs_the_jobs(deck):
    executor, threads, said = Elsewhere(), uf.threads(), []
    vary = {"E": [1e5, 2e5], "thickness": [0.5, -1.0]}
    found = uf.sweep(deck, vary, executor=executor, progress=False, on_job=said.append)
    assert executor.submitted == len(said) == 2
    assert uf.threads() == threads
    here = sweep(deck, vary, out="here")
    names = [name for name in here.table() if name != "seconds"]
    assert all(found[name] == here[name] for name in names)
    with pytest.raises(InvalidValue, match="executor"):
        uf.sweep(deck, vary, executor=executor, processes=2)


def test_a_measure_that_is_not_there_is_refused_before_the_first_job(deck, ran):
    with pytest.raises(InvalidValue, match="did you mean pull_force"):
        sweep(deck, {"E": [1e5, 2e5]}, measures=["pul_force:max"])
    with pytest.raises(InvalidValue, match="did you mean max"):
        sweep(deck, {"E": [1e5]}, measures=["pull_force:maxi"])
    assert not ran
    sweep(deck, {"E": [1e5, 2e5]}, measures=["pull_force:max", "drift of the energies"])
    assert len(ran) == 2


def test_a_measure_that_only_other_jobs_lack_is_refused_after_them(deck, ran):
    moves = [{"kind": "move", "to": {"pull": 0.1}, "increments": 1}]
    with pytest.raises(InvalidValue, match="no springback"):
        sweep(deck, {"steps": [[*moves, {"kind": "release", "control": "pull"}], moves]}, measures=["springback"])
    assert len(ran) == 2


@pytest.mark.parametrize("vary", [{}, {"E": []}, {"E": [1e5], "material.E": [2e5]}])
def test_a_sweep_over_nothing_or_over_a_key_twice_is_refused(deck, vary):
    with pytest.raises(InvalidValue, match="varie"):
        sweep(deck, vary)


def test_files_of_each_job_if_they_are_wanted(deck):
    found = sweep(deck, {"E": [1e5]}, files=True, changes={"output.report": False, "output.pictures": False})
    folder = deck.parent / "results" / "pull-sweep" / "jobs" / found["folder"][0]
    assert {file.name for file in folder.iterdir()} == {"job.json", "as-run.toml", "history.csv", "fields.vtkhdf"}
    assert json.loads((folder / "job.json").read_text())["outcome"] == "done"
    assert "# run with --set material.E=100000.0\n" in (folder / "as-run.toml").read_text()


def test_the_plot_has_a_panel_for_each_measure_and_a_line_for_each_other_value(deck):
    found = sweep(deck, {"material": "DC04,S355", "thickness": [2.0, 1.0]}, measures=["pull_force:max", "plastic_work"])
    upper, lower = found.plot().axes
    assert [axes.get_ylabel() for axes in (upper, lower)] == ["pull_force:max", "plastic_work"]
    assert lower.get_xlabel() == "thickness"
    assert [line.get_label() for line in upper.lines] == ["material DC04", "material S355"]
    assert upper.lines[0].get_xdata().tolist() == [1.0, 2.0]
    assert upper.lines[0].get_ydata().tolist() == found["pull_force:max"][1::-1]


def test_the_table_as_parquet(deck):
    parquet = pytest.importorskip("pyarrow.parquet")
    found = sweep(deck, jobs=[{"E": 1e5, "cells": [4, 1]}, {"E": -1.0}])
    kept = parquet.read_table(next(file for file in found.files if file.suffix == ".parquet")).to_pydict()
    assert kept["cells"] == ["[4, 1]", None]
    assert kept["outcome"] == ["done", "refused"]
    assert kept["pull_force:peak"] == found["pull_force:peak"]


def test_tools_that_do_not_follow_the_thickness_are_told_once(tmp_path, monkeypatch, caplog):
    monkeypatch.chdir(tmp_path)
    write_template("air-bending", tmp_path / "deck.toml")
    changes = {"mesh.cells": [14, 1], "steps.0.to.stroke": 0.3, "steps.0.increments": 3}
    sweep("deck.toml", {"thickness": [1.8, 2.0]}, changes=changes)
    (said,) = [text for text in caplog.messages if "do not follow the thickness" in text]
    assert "at 1.8 and 2 the gap" in said and "that of die is 0.1 and " in said and "that of punch is 0.1" in said
    caplog.clear()
    follow = [
        {"thickness": t, "die.origin": [0, 0, -0.5 * t], "punch.origin": [0, 0, 0.5 * t], **changes} for t in (1.8, 2.0)
    ]
    sweep("deck.toml", jobs=follow)
    assert not [text for text in caplog.messages if "follow the thickness" in text]
