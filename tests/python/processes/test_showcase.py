import csv
import json
import os
import re
from base64 import b64decode
from dataclasses import replace
from pathlib import Path

import h5py
import pytest

from umform.analysis.run import Result, solve
from umform.analysis.steps import Move
from umform.errors import FileProblem, MeshError, NoConvergence, SolveError, UmformError
from umform.pool import run_all
from umform.processes import FreeBending, demo, free_bending
from umform.processes.bending import page, showcase
from umform.processes.bending.case import build
from umform.processes.bending.showcase import Selection

BASE = FreeBending(steps=20, mesh=(12, 1))
FILES = {
    "free_bending.csv",
    "free_bending.json",
    "free_bending.png",
    "free_bending.svg",
    "free_bending.vtkhdf",
    "free_bending.toml",
    "report.html",
}


def names(**selection):
    return [case.name for case in Selection(**selection).runs(FreeBending())]


def test_the_example_has_fourteen_runs():
    assert names() == [
        "ANS3DEAS 24x1 nodes",
        "ANS3DEAS 24x1 2x2",
        "ANS3DEAS 24x1 5x5",
        "ANS3DEAS 48x2 nodes",
        "ANS3DEAS 48x2 2x2",
        "ANS3DEAS 48x2 5x5",
        "ANS3DEAS 48x2 2x2 order 3 tied",
        "MI9K3DEAS 12x1 nodes",
        "MI9K3DEAS 12x1 3x3",
        "MI9K3DEAS 12x1 5x5",
        "MI9K3DEAS 24x2 nodes",
        "MI9K3DEAS 24x2 3x3",
        "MI9K3DEAS 24x2 5x5",
        "MI9K3DEAS 24x2 3x3 order 3 tied",
    ]


def test_selections():
    assert names(meshes=((24, 1),), elements=("ANS3DEAS",), contacts=(5,)) == ["ANS3DEAS 24x1 5x5"]
    assert names(meshes=((24, 1),), contacts=("nodes",)) == ["ANS3DEAS 24x1 nodes"]
    assert names(meshes=((24, 2),), contacts=(3,)) == [
        "MI9K3DEAS 24x2 3x3",
        "MI9K3DEAS 24x2 3x3 order 3 tied",
    ]
    assert names(meshes=((10, 1),), contacts=(4,)) == ["ANS3DEAS 10x1 4x4", "MI9K3DEAS 10x1 4x4"]
    assert names(elements=("DISP3D",), contacts=(2,)) == ["DISP3D 24x1 2x2", "DISP3D 48x2 2x2"]
    assert len(Selection(meshes=((48, 2),)).runs(FreeBending(), sharp=False)) == 3


@pytest.fixture(scope="module")
def outcome(tmp_path_factory):
    cases = Selection(meshes=((12, 1),), elements=("ANS3DEAS",), contacts=("nodes", 2)).runs(BASE)
    return demo(tmp_path_factory.mktemp("showcase") / "deep" / "out", cases, processes=2, progress=False)


def test_all_files_are_there_and_no_others(outcome):
    folder = outcome.files[0].parent
    assert {path.name for path in folder.iterdir()} == FILES
    assert {path.name for path in outcome.files} == FILES


def test_curves_as_csv(outcome):
    with next(path for path in outcome.files if path.suffix == ".csv").open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["run", "step", "u", "F"]
    assert {row["run"] for row in rows} == {"ANS3DEAS 12x1 nodes", "ANS3DEAS 12x1 2x2"}
    assert len(rows) == sum(len(run.u) for run in outcome.runs)
    assert {row["step"] for row in rows} == {"0", "1", "2"}


def test_table_as_json(outcome):
    record = json.loads(next(path for path in outcome.files if path.suffix == ".json").read_text())
    assert "reconstruction" in record["note"]
    assert record["settings"]["steps"] == 20
    assert record["settings"]["tool_z"] == -20.5
    first = record["runs"][0]
    assert (first["mesh"], first["element"], first["contact"]) == ("12x1", "ANS3DEAS", "nodes")
    assert first["thickness_order"] == 1
    assert first["F_15"] > first["F_2"] > 0
    assert {"u_zero_force", "J", "roughness", "iterations", "seconds"} <= first.keys()
    assert first["balance"]["bending"]["force_imbalance"] < 1e-6
    assert first["contacts"]["bending"]["cylinder"]["kept"] in (True, False)
    assert {"umform", "numpy", "scipy", "python", "platform"} <= record["versions"].keys()


def test_fields(outcome):
    with h5py.File(next(path for path in outcome.files if path.suffix == ".vtkhdf")) as file:
        points, cells = file["VTKHDF/PointData"], file["VTKHDF/CellData"]
        assert {"displacement", "thickness_change", "contact_pressure"} <= set(points)
        assert {"stress_cauchy", "plastic_strain_max"} <= set(cells)


def test_the_page_moves_the_run_of_the_fields_and_no_other(outcome):
    text = next(path for path in outcome.files if path.suffix == ".html").read_text()
    last, other = outcome.runs[-1], outcome.runs[0]
    assert f"{last.case.name}, from increment to increment" in text
    assert all(f'id="{part}"' in text for part in ("shape-canvas", "curves-plot", "history-csv", "scene"))
    history = b64decode(re.search(r'id="history-csv"[^>]*base64,([^"]*)', text)[1]).decode().splitlines()
    assert len(history) == 1 + len(last.u)
    assert last.live is not None
    assert other.live is None


def test_parallel_and_serial_runs_agree_bit_by_bit(outcome, tmp_path):
    serial = demo(tmp_path, [run.case for run in outcome.runs], processes=1, progress=False)
    for mine, other in zip(serial.runs, outcome.runs, strict=True):
        assert mine.case == other.case
        assert (mine.F == other.F).all()
        assert (mine.u == other.u).all()


def test_a_run_that_ends_early_is_shown_as_far_as_it_went(tmp_path, monkeypatch):
    def no_release(case, **options):
        model, punch = build(case)
        error = NoConvergence("stopped on purpose", where="step 2")
        error.result = solve(model, [Move(punch, to=-5.0, steps=10)], progress=False)
        raise error

    monkeypatch.setattr(showcase, "free_bending", no_release)
    outcome = demo(tmp_path, [BASE], processes=1, progress=False)
    assert {path.name for path in tmp_path.iterdir()} == FILES
    assert "stopped on purpose" in outcome.runs[0].failure
    assert "stopped on purpose" in (tmp_path / "report.html").read_text()
    assert json.loads((tmp_path / "free_bending.json").read_text())["runs"][0]["F_15"] is None


def test_a_folder_that_is_a_file_is_refused_before_the_run(tmp_path):
    (tmp_path / "out").write_text("")
    with pytest.raises(FileProblem):
        demo(tmp_path / "out", [BASE], progress=False)


def fails_with(error, *, only="nodes"):
    def run(case, **options):
        if case.contact == only or only is None:
            raise error
        return free_bending(case, **options)

    return run


@pytest.mark.parametrize("error", [ZeroDivisionError("a bug"), MeshError("folded"), MemoryError(), SolveError("no")])
@pytest.mark.parametrize("contacts", [("nodes", 2), (2, "nodes")])
def test_a_run_that_fails_leaves_the_others_alone(error, contacts, tmp_path, monkeypatch):
    monkeypatch.setattr(showcase, "free_bending", fails_with(error))
    outcome = demo(tmp_path, [replace(BASE, contact=c) for c in contacts], processes=1, progress=False)
    by_contact = {run.case.contact: run for run in outcome.runs}
    assert by_contact[2].failure == ""
    assert by_contact[2].zero_force is not None
    assert str(error) in by_contact["nodes"].failure
    assert by_contact["nodes"].forces == [None] * 4
    assert by_contact["nodes"].jump is None
    pictured = contacts[-1] == 2  # without a special case the last run is the pictured one
    assert {path.name for path in tmp_path.iterdir()} == FILES - (set() if pictured else {"free_bending.vtkhdf"})
    assert {path.name for path in outcome.files} == {path.name for path in tmp_path.iterdir()}


def test_all_runs_fail_and_an_old_file_does_not_pass_for_a_new_one(tmp_path, monkeypatch):
    (tmp_path / "free_bending.vtkhdf").write_text("old")
    monkeypatch.setattr(showcase, "free_bending", fails_with(ZeroDivisionError("a bug"), only=None))
    outcome = demo(tmp_path, [BASE], processes=1, progress=False)
    assert {path.name for path in tmp_path.iterdir()} == FILES - {"free_bending.vtkhdf"}
    assert "a bug" in (tmp_path / "report.html").read_text()
    assert outcome.runs[0].zero_force is None


def test_nothing_is_left_when_the_demo_is_given_up(tmp_path, monkeypatch):
    monkeypatch.setattr(showcase, "free_bending", fails_with(KeyboardInterrupt()))
    with pytest.raises(KeyboardInterrupt):
        demo(tmp_path / "a" / "b", [BASE, replace(BASE, contact="nodes")], processes=1, progress=False)
    assert list(tmp_path.iterdir()) == []


def test_a_picture_that_fails_leaves_the_numbers(tmp_path, monkeypatch):
    def no_page(*arguments):
        raise ZeroDivisionError

    monkeypatch.setattr(page, "write_page", no_page)
    with pytest.raises(ZeroDivisionError):
        demo(tmp_path, [BASE], progress=False)
    assert {path.name for path in tmp_path.iterdir()} == {
        name for name in FILES if name.startswith("free_bending.")
    } - {
        "free_bending.png",
        "free_bending.svg",
    }


@pytest.mark.parametrize(
    "wrong", [{"element": "MI9K3DEAZ"}, {"element": "DISP3D", "thickness_order": 3}, {"tool_z": -15.0}, {"solver": "x"}]
)
def test_a_case_that_cannot_be_built_is_refused_before_the_first_run(wrong, tmp_path, monkeypatch):
    monkeypatch.setattr(showcase, "free_bending", fails_with(AssertionError(), only=None))
    with pytest.raises(UmformError):
        demo(tmp_path / "out", [BASE, replace(BASE, **wrong)], processes=1, progress=False)
    assert list(tmp_path.iterdir()) == []


def test_a_process_that_dies_is_the_failure_of_its_runs():
    assert run_all(die, [1, 2], [1.0, 1.0], on_failure=lambda task, error: (task, type(error)), processes=2) == [
        (1, SolveError),
        (2, SolveError),
    ]


def die(task):
    os._exit(1)


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="no such folder here")
@pytest.mark.parametrize("out", ["/proc/x", "/proc/x/y/z"])
def test_a_folder_of_the_system_is_refused(out):
    with pytest.raises(FileProblem) as caught:
        demo(out, [BASE], progress=False)
    assert "/proc" in caught.value.cause
    assert "not exist" not in caught.value.cause


@pytest.mark.parametrize("error", [FileProblem("the disk is full"), ZeroDivisionError("a bug")])
def test_fields_that_cannot_be_written_do_not_take_the_curve_along(error, tmp_path, monkeypatch):
    def no_fields(*arguments, **options):
        raise error

    monkeypatch.setattr(Result, "write", no_fields)
    outcome = demo(tmp_path, [BASE], progress=False)
    assert str(error) in outcome.runs[0].failure
    assert outcome.runs[0].forces[-1] is not None
    assert {path.name for path in tmp_path.iterdir()} == FILES - {"free_bending.vtkhdf"}
