"""What a series leaves behind when steps are refused, when a block or a process ends, when the disk is full."""

import shutil
import subprocess
import sys
import textwrap

import h5py
import numpy as np
import pytest
import pyvista as pv

from umform.errors import FileProblem, InvalidValue
from umform.io import VtkHdfSeries


def fields(sheet, time):
    return {"displacement": time * sheet.points}, {"eqps": time + np.arange(len(sheet.connectivity))}


def test_exception_keeps_the_steps_before_it(sheet, tmp_path, vtk):
    path = tmp_path / "a.vtkhdf"
    path.write_text("old")
    with (
        pytest.raises(ZeroDivisionError),
        VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity) as series,
    ):
        series.append(0.5, *fields(sheet, 0.5))
        assert path.read_text() == "old"
        raise ZeroDivisionError
    assert [p.name for p in tmp_path.iterdir()] == ["a.vtkhdf"]
    assert vtk.steps(path) == 1


def test_series_without_steps_leaves_the_old_file(sheet, tmp_path):
    path = tmp_path / "a.vtkhdf"
    path.write_text("old")
    with VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity):
        pass
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.vtkhdf"]


def test_unfinished_file_of_a_killed_process_is_readable(sheet, tmp_path, vtk):
    np.savez(tmp_path / "mesh.npz", points=sheet.points, connectivity=sheet.connectivity)
    script = f"""
        import os, numpy as np
        from umform.io import VtkHdfSeries
        mesh = np.load({str(tmp_path / "mesh.npz")!r})
        path = {str(tmp_path / "a.vtkhdf")!r}
        with VtkHdfSeries(path, mesh["points"], {sheet.cells!r}, mesh["connectivity"]) as series:
            series.append(1.0, {{"displacement": mesh["points"]}})
            series.append(2.0, {{"displacement": 2 * mesh["points"]}})
            os._exit(9)
    """
    ended = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], check=False)
    assert ended.returncode == 9
    (temporary,) = tmp_path.glob(".a.*.vtkhdf")
    shutil.move(temporary, tmp_path / "a.vtkhdf")
    grid = vtk.read(tmp_path / "a.vtkhdf", 1)
    np.testing.assert_array_equal(grid["displacement"][: len(sheet.points)], 2 * sheet.points)


def test_refused_steps_leave_the_file_as_it_was(sheet, tmp_path, vtk):
    path = tmp_path / "a.vtkhdf"
    n, m = len(sheet.points), len(sheet.connectivity)
    with VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity) as series:
        for point_data in (
            {"u": np.zeros(n + 1)},
            {"u": np.zeros((n, 3, 3))},
            {"a/b": np.zeros(n)},
            {"u": 0.0},
        ):
            with pytest.raises(InvalidValue, match="field"):
                series.append(0.0, point_data)
        series.append(0.0, {"u": np.zeros((n, 3))}, {"eqps": np.zeros(m)})
        for point_data, cell_data, different in (
            ({"u": np.zeros(n)}, {"eqps": np.zeros(m)}, "u"),
            ({"u": np.zeros((n, 3))}, {}, "eqps"),
            ({"u": np.zeros((n, 3)), "v": np.zeros(n)}, {"eqps": np.zeros(m)}, "v"),
        ):
            with pytest.raises(InvalidValue, match="differ from those of the first step") as info:
                series.append(1.0, point_data, cell_data)
            assert different in info.value.value
        for time in (0.0, -1.0, np.nan):
            with pytest.raises(InvalidValue, match="increase"):
                series.append(time, {"u": np.zeros((n, 3))}, {"eqps": np.zeros(m)})
        series.append(2.0, {"u": np.ones((n, 3))}, {"eqps": np.ones(m)})
    assert vtk.times(path) == (0.0, 2.0)
    assert np.all(vtk.read(path, 1)["u"] == 1)
    with pytest.raises(InvalidValue, match="not open"):
        series.append(3.0)


def test_interrupted_step_does_not_count(sheet, tmp_path, monkeypatch, vtk):
    path = tmp_path / "a.vtkhdf"
    u = {"u": sheet.points}
    with VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity) as series:
        series.append(0.0, u)
        with monkeypatch.context() as patch, pytest.raises(FileProblem, match="No space left"):
            patch.setattr("h5py.AttributeManager.__setitem__", _disk_full)
            series.append(1.0, u)
    assert vtk.steps(path) == 1
    np.testing.assert_array_equal(vtk.read(path, 0)["u"][: len(sheet.points)], sheet.points)


def _disk_full(*args):
    raise OSError(28, "No space left on device")


@pytest.mark.skipif(sys.platform != "linux", reason="needs a limit on the size of files")
def test_full_disk_keeps_the_steps_before(tmp_path, vtk):
    script = f"""
        import resource, numpy as np
        from umform.errors import FileProblem, InvalidValue
        from umform.io import VtkHdfSeries
        points = np.random.default_rng(0).normal(size=(20_000, 3))
        resource.setrlimit(resource.RLIMIT_FSIZE, (2_500_000, 2_500_000))
        with VtkHdfSeries({str(tmp_path / "a.vtkhdf")!r}, points, "hex8", [range(8)]) as series:
            try:
                for step in range(20):
                    series.append(step, {{"u": points + step}})
            except FileProblem as problem:
                assert "too large" in problem.cause
            try:
                series.append(20, {{"u": points}})
            except InvalidValue as problem:
                assert "not open" in problem.what
            print(len(series.times))
    """
    ended = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], check=True, capture_output=True)
    assert [p.name for p in tmp_path.iterdir()] == ["a.vtkhdf"]
    steps = vtk.steps(tmp_path / "a.vtkhdf")
    assert steps == int(ended.stdout) > 1
    points = np.random.default_rng(0).normal(size=(20_000, 3))
    np.testing.assert_array_equal(vtk.read(tmp_path / "a.vtkhdf", steps - 1)["u"], points + (steps - 1))


def test_file_that_cannot_take_its_name_is_kept(sheet, tmp_path, vtk):
    path = tmp_path / "a.vtkhdf"
    with (
        pytest.raises(FileProblem, match="what was written is in"),
        VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity) as series,
    ):
        series.append(0.0)
        path.mkdir()
    (temporary,) = tmp_path.glob(".a.*.vtkhdf")
    assert vtk.steps(temporary) == 1


def test_series_of_mesh_alone_has_steps(sheet, tmp_path):
    path = tmp_path / "a.vtkhdf"
    with VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity) as series:
        series.append(0.0)
    assert pv.read(path).n_cells == len(sheet.connectivity)


@pytest.mark.parametrize("count", [1, 2, 7])
def test_steps_written_together_make_the_same_file(sheet, tmp_path, count):
    """One step at a time, some together with a rest at the end, and all of them at the end."""
    at_once = sum(np.asarray(a).nbytes for part in fields(sheet, 0.0) for a in part.values())
    contents = []
    for name, buffer in (("one", 0), ("some", 3 * at_once), ("all", 10**9)):
        path = tmp_path / f"{name}.vtkhdf"
        with VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity, buffer=buffer) as series:
            for time in range(count):
                series.append(time, *fields(sheet, time))
                assert series.times == tuple(range(time + 1))
        contents.append(content(path))
    assert contents[0]["VTKHDF/Steps"] == {"NSteps": [count]}
    assert contents[0] == contents[1] == contents[2]


def content(path):
    """Groups and data sets of a file with all that describes them."""
    found = {}

    def see(name, item):
        found[name] = {key: np.atleast_1d(value).tolist() for key, value in item.attrs.items()}
        if isinstance(item, h5py.Dataset):
            layout = (item.shape, item.maxshape, item.chunks, item.dtype, item.compression, item.shuffle)
            found[name] |= {"layout": layout, "values": item[()].tolist()}

    with h5py.File(path) as file:
        file.visititems(see)
    return found


def test_steps_that_wait_are_lost_with_the_write_that_fails(sheet, tmp_path, monkeypatch, vtk):
    path = tmp_path / "a.vtkhdf"
    u = {"u": sheet.points}
    full = sheet.points.nbytes * (3 if sheet.cells == "hex18" else 2) // 2  # with the nodes of the middle layer
    mesh = (sheet.points, sheet.cells, sheet.connectivity)
    with pytest.raises(FileProblem, match="No space left"), VtkHdfSeries(path, *mesh, buffer=2 * full) as series:
        for time in range(3):
            series.append(time, u)
        assert series.times == (0, 1, 2)
        monkeypatch.setattr("h5py.AttributeManager.__setitem__", _disk_full)
    assert series.times == (0, 1)
    assert [p.name for p in tmp_path.iterdir()] == ["a.vtkhdf"]
    assert vtk.steps(path) == 2


def test_exception_keeps_the_steps_that_wait(sheet, tmp_path, vtk):
    path = tmp_path / "a.vtkhdf"
    mesh = (sheet.points, sheet.cells, sheet.connectivity)
    with pytest.raises(ZeroDivisionError), VtkHdfSeries(path, *mesh, buffer=10**9) as series:
        series.append(0.5, *fields(sheet, 0.5))
        with pytest.raises(InvalidValue, match="increase"):
            series.append(0.5, *fields(sheet, 0.5))
        raise ZeroDivisionError
    assert vtk.steps(path) == 1
    np.testing.assert_array_equal(vtk.read(path, 0)["displacement"][: len(sheet.points)], 0.5 * sheet.points)


def test_missing_directory(sheet, tmp_path):
    with (
        pytest.raises(FileProblem, match="does not exist"),
        VtkHdfSeries(tmp_path / "no" / "a.vtkhdf", sheet.points, sheet.cells, sheet.connectivity),
    ):
        pass
