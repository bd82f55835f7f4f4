import csv
import json

import h5py
import pytest

from umform.errors import FileProblem, NoConvergence
from umform.processes import FreeBending, demo
from umform.processes.bending import showcase
from umform.processes.bending.case import build
from umform.processes.bending.showcase import Selection
from umform.steps import Move, solve

BASE = FreeBending(steps=20, mesh=(12, 1))
FILES = {
    "free_bending.csv",
    "free_bending.json",
    "free_bending.png",
    "free_bending.svg",
    "free_bending.vtkhdf",
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
    assert {"umform", "numpy", "scipy", "python", "platform"} <= record["versions"].keys()


def test_fields(outcome):
    with h5py.File(next(path for path in outcome.files if path.suffix == ".vtkhdf")) as file:
        points, cells = file["VTKHDF/PointData"], file["VTKHDF/CellData"]
        assert {"displacement", "thickness_change", "contact_pressure"} <= set(points)
        assert {"stress_cauchy", "plastic_strain_max"} <= set(cells)


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
