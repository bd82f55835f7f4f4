"""Checkpoints that do not fit, are damaged, or cannot be written; and when they are written."""

from __future__ import annotations

import resource
import shutil
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

import umform
from umform import materials as mt
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import resume, solve
from umform.analysis.run.checkpoint import Checkpoints, read_note
from umform.analysis.run.fingerprint import text
from umform.analysis.steps import Move, Release
from umform.errors import FileProblem, InvalidValue
from umform.io.trees import read_tree, write_tree
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import UserSurface


def bending(build, stroke=-5.0, **changes):
    """A strip bent over a cylinder and released; its steps, and the options of its run."""
    bent = build.free_bending(**{"cells": (8, 1)} | changes)
    return bent.model, [Move(bent.punch, stroke, steps=10), Release(bent.punch)], {"solver": "banded", "frames": 4}


# Files that do not fit --------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def finished(tmp_path_factory, build):
    path = tmp_path_factory.mktemp("finished") / "run.h5"
    model, steps, options = bending(build)
    solve(model, steps, **options, checkpoint=path)
    return path


def test_a_checkpoint_takes_no_place_of_another_file(tmp_path, build):
    path = tmp_path / "notes.txt"
    path.write_text("of another kind")
    model, steps, options = bending(build)
    with pytest.raises(FileProblem, match="this file is no checkpoint"):
        solve(model, steps, **options, checkpoint=path)
    assert path.read_text() == "of another kind"


@pytest.mark.parametrize("size", [0, 10, 0.5, -1])
def test_a_file_that_was_cut_short_is_refused(size, finished, tmp_path, build):
    path = tmp_path / "run.h5"
    whole = finished.read_bytes()
    path.write_bytes(whole[: int(size * len(whole)) if isinstance(size, float) else size])
    model, steps, options = bending(build)
    with pytest.raises(FileProblem, match="damaged") as caught:
        resume(path, model, steps, **options)
    assert str(path) in str(caught.value)
    assert caught.value.remedy
    assert not model.u.any()


def test_a_file_with_another_bit_is_refused(finished, tmp_path, build):
    path = tmp_path / "run.h5"
    shutil.copy(finished, path)
    tree = read_tree(finished, "checkpoint of umform")
    content = bytearray(path.read_bytes())
    content[content.index(tree["model"]["u"].tobytes()) + 100] ^= 1
    path.write_bytes(content)
    model, steps, options = bending(build)
    with pytest.raises(FileProblem, match="checksum"):
        resume(path, model, steps, **options)


def test_a_tree_comes_back_to_the_last_bit(tmp_path):
    tree = {
        "numbers": [0.1, -0.0, np.nan, np.inf, 5e-324, 2**60, True, None],
        "arrays": {"empty": np.zeros((2, 0, 3)), "flags": np.array([True, False]), "x": np.array([np.nan, -0.0])},
        "text": ["", "a/b . \u20ac"],
        "a/b . \u20ac%": {"..": 1, ".": 2, "%2F": 3, "%": 4, "": {}, "none": None, "long": 100_000 * "x"},
        "rows": [[1, 0.5, None, "a"], [2, -0.0, None, "b"]],
        "lists": [[], [1, "a"], [[0.5], [True, False]], [np.zeros((2, 2)), np.array(3.0)]],
    }
    write_tree(tmp_path / "tree.h5", tree, "tree")
    back = read_tree(tmp_path / "tree.h5", "tree")
    assert repr(back) == repr(tree)
    with h5py.File(tmp_path / "tree.h5") as file:  # for any reader of HDF5
        assert np.isnan(file["tree/arrays/x"][0])
        assert file["tree/rows/1"][:].tolist() == [0.5, -0.0]
    for name, array in tree["arrays"].items():
        assert back["arrays"][name].dtype == array.dtype
        assert back["arrays"][name].tobytes() == array.tobytes()


def test_a_note_is_read_without_the_state(tmp_path, build):
    """An array that is damaged does not matter to it; the state is then refused, as above."""
    path = tmp_path / "run.h5"
    model, steps, options = bending(build)
    solve(model, steps, **options, checkpoint=path, note={"deck": "text"})
    content = bytearray(path.read_bytes())
    content[content.index(read_tree(path, "checkpoint of umform")["model"]["u"].tobytes()) + 100] ^= 1
    path.write_bytes(content)
    assert read_note(path) == {"deck": "text"}
    with pytest.raises(FileProblem, match="checksum"):
        read_tree(path, "checkpoint of umform")
    with pytest.raises(FileProblem, match="there is no checkpoint"):
        read_note(tmp_path / "other.h5")


def test_other_files_are_refused(tmp_path, build):
    model, steps, options = bending(build)
    with pytest.raises(FileProblem, match="there is no checkpoint"):
        resume(tmp_path / "run.h5", model, steps, **options)
    with h5py.File(tmp_path / "run.h5", "w") as file:
        file["x"] = 1.0
    with pytest.raises(FileProblem, match="not a checkpoint"):
        resume(tmp_path / "run.h5", model, steps, **options)


@pytest.mark.parametrize(
    ("part", "change"),
    [
        ("mesh, contacts", {"cells": (7, 1)}),
        ("material", {"material": mt.J2(kappa=175001.0, mu=80.77e3, hardening=mt.Linear(160.0, 500.0))}),
        ("contacts", {"penalty": 2e4}),
        ("tools", {"radius": 21.0}),
        ("steps", {"stroke": -3.5}),
    ],
)
def test_a_checkpoint_of_another_model_is_refused(part, change, finished, build):
    model, steps, options = bending(build, **change)
    with pytest.raises(FileProblem, match="another run") as caught:
        resume(finished, model, steps, **options)
    assert caught.value.value == f"different: {part}"
    assert caught.value.cause.startswith(f"{part.split(',')[0]}: ")
    assert not model.u.any()


@pytest.mark.parametrize(
    ("part", "change"),
    [("solver", {"solver": "superlu"}), ("frames", {"frames": 5}), ("options", {"options": NewtonOptions(1e-8)})],
)
def test_a_checkpoint_of_other_settings_is_refused(part, change, finished, build):
    model, steps, options = bending(build)
    with pytest.raises(FileProblem) as caught:
        resume(finished, model, steps, **options | change)
    assert caught.value.value == f"different: {part}"


def test_another_version_supports_and_element_are_refused(finished, monkeypatch, build):
    model, steps, options = bending(build)
    model.fix("x0_upper", "z")
    written = umform.__version__
    monkeypatch.setattr(umform, "__version__", "0.0.0")
    with pytest.raises(FileProblem) as caught:
        resume(finished, model, steps, **options)
    assert caught.value.value == "different: version of umform, supports and loads"
    assert f"{written} in the file, 0.0.0 here" in caught.value.cause
    assert caught.value.remedy.startswith(f"resume with umform {written}, which wrote it")


def test_a_pressure_on_other_faces_is_another_run(tmp_path):
    def blown(x):
        model = Model(strip(4.0, 1.0, 0.2, (4, 1)), material=mt.SVK(E=1e3, nu=0.3))
        model.fix("x0")
        upper = model.mesh.face_set("upper")
        faces = upper[model.mesh.points[model.mesh.connectivity[upper[:, 0], 0], 0] < x]
        return model, Move(model.pressure(faces), 0.01, steps=1)

    solve(*blown(2.5), checkpoint=tmp_path / "run.h5")
    with pytest.raises(FileProblem, match="another run") as caught:
        resume(tmp_path / "run.h5", *blown(1.5))
    assert caught.value.value == "different: supports and loads"
    assert len(resume(tmp_path / "run.h5", *blown(2.5))) == 2


def test_functions_are_told_apart_by_what_they_do():
    def line(slope):
        return lambda fraction: slope * fraction

    assert text(line(2.0)) == text(line(2.0))
    assert text(line(2.0)) != text(line(3.0))
    assert text(lambda x: x + 1.0) != text(lambda x: x + 2.0)
    assert text(np.sin) == text(np.sin) != text(np.cos)
    assert text(UserSurface(line(1.0))) == text(UserSurface(line(1.0))) != text(UserSurface(line(1.5)))
    assert text(np.float64(0.1)) == text(0.1)


# Files that cannot be written -------------------------------------------------------------------------------


def test_where_no_checkpoint_can_be_written_nothing_is_computed(tmp_path, build):
    model, steps, options = bending(build)
    with pytest.raises(FileProblem, match="does not exist"):
        solve(model, steps, **options, checkpoint=tmp_path / "nowhere" / "run.h5")
    assert not model.u.any()
    for every in (-1.0, "60"):
        with pytest.raises(InvalidValue, match="every so many seconds"):
            solve(model, steps, **options, checkpoint=tmp_path / "run.h5", every=every)


def test_on_a_full_disk_the_run_goes_on_with_a_warning_and_the_file_of_before(tmp_path, monkeypatch, build):
    path = tmp_path / "run.h5"
    write, done = Checkpoints.write, []

    def write_on_a_disk_that_fills_up(self, run):
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000 if len(done) >= 3 else limits[0], limits[1]))
        try:
            write(self, run)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        done.append(path.read_bytes())

    model, steps, options = bending(build)
    expected = solve(model, steps, **options)
    monkeypatch.setattr(Checkpoints, "write", write_on_a_disk_that_fills_up)
    again, steps, options = bending(build)
    result = solve(again, steps, **options, checkpoint=path, every=0)
    assert len(result.warnings) == 1
    assert "no checkpoint was written" in result.warnings[0]
    result.warnings.clear()
    for column in expected.columns():
        np.testing.assert_array_equal(result[column], expected[column])
    np.testing.assert_array_equal(again.u, model.u)
    assert len(done) > 4
    assert path.read_bytes() == done[2]
    assert [file.name for file in tmp_path.iterdir()] == ["run.h5"]


# When, and what is shown ------------------------------------------------------------------------------------


def test_checkpoints_come_so_many_seconds_after_each_other(tmp_path, monkeypatch):
    now, cost = [0.0], [1.0]

    def perf_counter():
        return now[0]

    def slow(*arguments):
        now[0] += cost[0]

    monkeypatch.setattr("umform.analysis.run.checkpoint.clock.perf_counter", perf_counter)
    monkeypatch.setattr("umform.analysis.run.checkpoint.write_tree", slow)
    monkeypatch.setattr("umform.analysis.run.checkpoint.memory_of", lambda run: {})
    checkpoints = Checkpoints(tmp_path / "run.h5", 60.0, {})
    times = []
    while now[0] < 1000.0:
        now[0] += 10.0
        if checkpoints.due():
            times.append(now[0])
            checkpoints.write(SimpleNamespace(follower=None))
            cost[0] = 15.0
    assert times[:2] == [60.0, 121.0]
    assert times[2] - times[1] >= 15.0 + 20 * 15.0  # not more than a twentieth of the time
    always = Checkpoints(tmp_path / "run.h5", 0.0, {})
    assert always.due()
